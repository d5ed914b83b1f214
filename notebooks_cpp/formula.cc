#include "formula.h"

#include <fmt/format.h>

#include <cctype>
#include <map>
#include <stdexcept>
#include <string>

namespace vmech {
namespace {

using html::Element;
using html::Markup;
using Symbols = std::map<std::string_view, std::string_view>;

const Symbols& Letters() {
  static const Symbols kLetters = {
      {"alpha", "α"},   {"beta", "β"},  {"gamma", "γ"},  {"delta", "δ"}, {"epsilon", "ε"},
      {"theta", "θ"},   {"kappa", "κ"}, {"lambda", "λ"}, {"mu", "μ"},    {"nu", "ν"},
      {"pi", "π"},      {"rho", "ρ"},   {"sigma", "σ"},  {"tau", "τ"},   {"phi", "φ"},
      {"psi", "ψ"},     {"omega", "ω"}, {"Gamma", "Γ"},  {"Delta", "Δ"}, {"Theta", "Θ"},
      {"Lambda", "Λ"},  {"Sigma", "Σ"}, {"Phi", "Φ"},    {"Omega", "Ω"}, {"infty", "∞"},
      {"partial", "∂"}, {"ell", "ℓ"},   {"eta", "η"},    {"zeta", "ζ"},  {"xi", "ξ"}};
  return kLetters;
}

const Symbols& Operators() {
  static const Symbols kOperators = {
      {"cdot", "·"},   {"times", "×"}, {"le", "≤"},    {"ge", "≥"},       {"ne", "≠"},
      {"approx", "≈"}, {"to", "→"},    {"in", "∈"},    {"sum", "∑"},      {"int", "∫"},
      {"pm", "±"},     {"ldots", "…"}, {"perp", "⊥"},  {"parallel", "∥"}, {"top", "⊤"},
      {"sim", "∼"},    {"nabla", "∇"}, {"oplus", "⊕"}, {"circ", "∘"},     {"Rightarrow", "⇒"}};
  return kOperators;
}

const Symbols& Accents() {
  static const Symbols kAccents = {{"dot", "˙"}, {"ddot", "¨"}, {"hat", "^"},
                                   {"bar", "¯"}, {"vec", "→"},  {"tilde", "~"}};
  return kAccents;
}

const Symbols& Spaces() {
  static const Symbols kSpaces = {
      {",", "0.17em"}, {";", "0.28em"}, {" ", "0.33em"}, {"quad", "1em"}, {"qquad", "2em"}};
  return kSpaces;
}

bool IsFunction(std::string_view name) {
  for (const std::string_view known : {"sin", "cos", "tan", "min", "max", "log", "ln", "exp",
                                       "rank", "det", "subject", "minimise"}) {
    if (name == known) return true;
  }
  return false;
}

Markup Upright(const Markup& text) {
  return Markup::Raw("<mi mathvariant=\"normal\">" + text.html() + "</mi>");
}

/// MathML trims ordinary spaces at the ends of a text.
std::string WithFirmSpaces(std::string_view text) {
  std::string firm;
  for (const char c : text) firm += c == ' ' ? std::string("\u00A0") : std::string(1, c);
  return firm;
}

/// A recursive-descent reader: sequence = { atom [scripts] }.
class FormulaReader {
 public:
  explicit FormulaReader(std::string_view tex) : tex_(tex) {}

  Markup ReadAll() {
    const Markup formula = Sequence();
    if (at_ < tex_.size()) Fail("an unexpected end of a group");
    return formula;
  }

 private:
  [[noreturn]] void Fail(std::string_view what) const {
    throw std::invalid_argument(
        fmt::format("formula '{}': {} at character {}", tex_, what, at_ + 1));
  }

  void SkipSpace() {
    while (at_ < tex_.size() && (tex_[at_] == ' ' || tex_[at_] == '\n')) ++at_;
  }

  bool Take(std::string_view token) {
    if (tex_.substr(at_, token.size()) != token) return false;
    at_ += token.size();
    return true;
  }

  bool AtEndOfSequence() {
    SkipSpace();
    return at_ >= tex_.size() || tex_[at_] == '}' || tex_[at_] == '&' ||
           tex_.substr(at_, 2) == "\\\\" || tex_.substr(at_, 6) == "\\right" ||
           tex_.substr(at_, 4) == "\\end";
  }

  Markup Sequence() {
    Markup row;
    while (!AtEndOfSequence()) row += WithScripts(Atom());
    return row;
  }

  Markup WithScripts(const Markup& base) {
    Markup below, above;
    for (;;) {
      SkipSpace();
      if (Take("_")) {
        below = Argument();
      } else if (Take("^")) {
        above += Argument();
      } else if (Take("''")) {
        above += Element("mo", "″");
      } else if (Take("'")) {
        above += Element("mo", "′");
      } else {
        break;
      }
    }
    if (below.empty() && above.empty()) return base;
    if (above.empty()) return Element("msub", base + below);
    if (below.empty()) return Element("msup", base + Element("mrow", above));
    return Element("msubsup", base + below + Element("mrow", above));
  }

  Markup Argument() {
    SkipSpace();
    if (at_ >= tex_.size()) Fail("an argument is missing");
    return Atom();
  }

  Markup Group() {  // the opening brace is taken
    const Markup content = Element("mrow", Sequence());
    if (!Take("}")) Fail("a closing brace is missing");
    return content;
  }

  Markup Atom() {
    const char c = tex_[at_];
    if (Take("{")) return Group();
    if (Take("\\")) return Command();
    if (std::isdigit(static_cast<unsigned char>(c))) return Number();
    ++at_;
    if (std::isalpha(static_cast<unsigned char>(c))) return Element("mi", std::string(1, c));
    if (c == '-') return Element("mo", "−");
    if (std::string_view("+=<>()[],/|;:*!.").find(c) == std::string_view::npos) {
      --at_;
      Fail(fmt::format("'{}' is not known", c));
    }
    return Markup::Raw("<mo stretchy=\"false\">") + Markup(std::string(1, c)) +
           Markup::Raw("</mo>");
  }

  Markup Number() {
    const std::size_t begin = at_;
    while (at_ < tex_.size() && (std::isdigit(static_cast<unsigned char>(tex_[at_])) ||
                                 (tex_[at_] == '.' && at_ + 1 < tex_.size() &&
                                  std::isdigit(static_cast<unsigned char>(tex_[at_ + 1]))))) {
      ++at_;
    }
    return Element("mn", tex_.substr(begin, at_ - begin));
  }

  std::string_view CommandName() {
    const std::size_t begin = at_;
    while (at_ < tex_.size() && std::isalpha(static_cast<unsigned char>(tex_[at_]))) ++at_;
    if (at_ == begin && at_ < tex_.size()) ++at_;
    return tex_.substr(begin, at_ - begin);
  }

  Markup Command() {  // the backslash is taken
    const std::string_view name = CommandName();
    if (const auto it = Letters().find(name); it != Letters().end()) {
      return Element("mi", it->second);
    }
    if (const auto it = Operators().find(name); it != Operators().end()) {
      return Element("mo", it->second);
    }
    if (const auto it = Spaces().find(name); it != Spaces().end()) {
      return Markup::Raw(fmt::format("<mspace width=\"{}\"/>", it->second));
    }
    if (const auto it = Accents().find(name); it != Accents().end()) {
      const Markup base = Argument();
      return Markup::Raw("<mover accent=\"true\">") + base +
             Markup::Raw(fmt::format("<mo stretchy=\"false\">{}</mo></mover>", it->second));
    }
    if (IsFunction(name)) return Upright(name) + Markup::Raw("<mspace width=\"0.17em\"/>");
    return Structure(name);
  }

  Markup Structure(std::string_view name) {
    if (name == "frac") {
      const Markup above = Argument();
      return Element("mfrac", above + Argument());
    }
    if (name == "sqrt") return Element("msqrt", Argument());
    if (name == "mathbf") return Element("mi", Verbatim(), "bold");
    if (name == "mathrm") return Upright(Verbatim());
    if (name == "text") return Element("mtext", WithFirmSpaces(Verbatim()));
    if (name == "left") return Fenced();
    if (name == "begin") return Matrix();
    if (name == "{" || name == "}") return Element("mo", name);
    Fail(fmt::format("'\\{}' is not known", name));
  }

  std::string_view Verbatim() {
    SkipSpace();
    const std::size_t end = tex_.find('}', at_);
    if (!Take("{") || end == std::string_view::npos) Fail("a group in braces is missing");
    const std::string_view content = tex_.substr(at_, end - at_);
    at_ = end + 1;
    return content;
  }

  Markup Fence() {
    Take("\\");
    if (at_ >= tex_.size()) Fail("a bracket is missing");
    const std::string_view bracket = tex_.substr(at_++, 1);
    return Element("mo", bracket == "." ? "" : bracket);
  }

  Markup Fenced() {
    const Markup open = Fence();
    const Markup content = Sequence();
    if (!Take("\\right")) Fail("'\\right' is missing");
    return Element("mrow", open + content + Fence());
  }

  Markup Matrix() {
    if (!Take("{bmatrix}")) Fail("of the environments only bmatrix is known");
    Markup rows, row;
    for (;;) {
      row += Element("mtd", Sequence());
      if (Take("&")) continue;
      rows += Element("mtr", row);
      row = Markup();
      if (!Take("\\\\")) break;
    }
    if (!Take("\\end{bmatrix}")) Fail("'\\end{bmatrix}' is missing");
    return Element("mrow", Element("mo", "[") + Element("mtable", rows) + Element("mo", "]"));
  }

  std::string_view tex_;
  std::size_t at_ = 0;
};

}  // namespace

Markup RenderFormula(std::string_view tex, FormulaStyle style) {
  const Markup row = Element("mrow", FormulaReader(tex).ReadAll());
  return Markup::Raw(style == FormulaStyle::kDisplay ? "<math display=\"block\">" : "<math>") +
         row + Markup::Raw("</math>");
}

}  // namespace vmech
