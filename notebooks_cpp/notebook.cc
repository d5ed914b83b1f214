#include "notebook.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "vmech/apps/plot/style.h"

namespace vmech {

Notebook::Notebook(int argc, char** argv) {
  if (argc < 2) return;
  results_ = argv[1];
  unfinished_ = results_ + ".part";
  std::remove(results_.c_str());
  file_.reset(std::fopen(unfinished_.c_str(), "wb"));
  if (!file_) throw std::runtime_error(fmt::format("cannot write the results to '{}'", results_));
}

Notebook::~Notebook() {
  if (!file_) return;
  file_.reset();
  std::rename(unfinished_.c_str(), results_.c_str());
}

void Notebook::Print(std::string_view text, Where where) {
  Write("text", text, where);
}

void Notebook::Show(const html::Table& table, Where where) {
  Write("html", html::RenderTable(table).html(), where);
}

void Notebook::Show(const plot::LinePlot& plot, Where where) {
  Write("svg", plot::StandaloneSvg(plot::Draw(plot)), where);
}

void Notebook::Show(const plot::PolarPlot& plot, Where where) {
  Write("svg", plot::StandaloneSvg(plot::Draw(plot)), where);
}

void Notebook::Check(std::string_view claim, bool holds, Where where) {
  if (!holds) {
    ++failures_;
    fmt::print(stderr, "{}:{}: the claim does not hold: {}\n", where.file_name(), where.line(),
               claim);
  }
  Write(holds ? "holds" : "fails", claim, where);
}

void Notebook::CheckNear(std::string_view claim, double value, double expected, double tolerance,
                         Where where) {
  const std::string figures =
      expected == 0
          ? fmt::format("{:.1e}, at most {:.0e}", value, tolerance)
          : fmt::format("{:.10g}, expected {:.10g} within {:.0e}", value, expected, tolerance);
  Check(fmt::format("{}: {}", claim, figures), std::abs(value - expected) <= tolerance, where);
}

void Notebook::Write(std::string_view kind, std::string_view content, const Where& where) {
  if (file_) {
    fmt::print(file_.get(), "{} {} {}\n{}\n", where.line(), kind, content.size(), content);
  } else if (kind != "html" && kind != "svg") {
    fmt::print("{}{}\n", kind == "text" ? "" : fmt::format("{}: ", kind), content);
  }
}

}  // namespace vmech
