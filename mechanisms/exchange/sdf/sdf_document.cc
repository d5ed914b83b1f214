#include "vmech/mechanisms/exchange/sdf/sdf_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <vector>

namespace vmech {
namespace {

namespace fs = std::filesystem;

constexpr const char* kVariables[] = {"SDF_PATH", "GZ_SIM_RESOURCE_PATH",
                                      "IGN_GAZEBO_RESOURCE_PATH", "GAZEBO_MODEL_PATH"};

bool IsOneOf(std::initializer_list<std::string_view> words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::string Trimmed(std::string_view text) {
  constexpr const char* kSpace = " \t\r\n";
  const size_t begin = std::min(text.find_first_not_of(kSpace), text.size());
  const size_t end = text.find_last_not_of(kSpace) + 1;
  return std::string(text.substr(begin, std::max(begin, end) - begin));
}

/// Whether an element says something about a mechanism, or about libsdformat only; all others are
/// left out.
bool IsTaken(const XmlElement& element, std::string_view parent) {
  constexpr std::string_view kTaken =
      " world model link joint frame include uri name pose static placement_frame inertial mass "
      "inertia ixx iyy izz ixy ixz iyz parent child axis axis2 xyz limit lower upper dynamics "
      "damping friction spring_reference spring_stiffness thread_pitch use_parent_model_frame "
      "description author ";
  if (element.name == "gravity") return parent == "world";
  return kTaken.find(" " + element.name + " ") != kTaken.npos;
}

/// "link 'arm'", the nearest element with a name around a value.
std::string Owner(const XmlElement& element, const std::string& outer) {
  const std::string* name = element.Attribute("name");
  return name == nullptr ? outer : fmt::format("{} {}", element.name, Quoted(*name));
}

void CheckPose(const XmlElement& pose, const std::string& what, XmlErrors* errors) {
  const std::string* format = pose.Attribute("rotation_format");
  const bool quaternion = format != nullptr && *format == "quat_xyzw";
  if (Trimmed(pose.text).empty()) return;  // the identity
  const auto numbers = errors->Numbers(pose.text, quaternion ? 7 : 6, pose.line, what);
  const bool turns = !quaternion || std::any_of(numbers.begin() + 3, numbers.end(),
                                                [](double q) { return q != 0; });
  if (!turns) errors->Add(pose.line, what + ": the quaternion has no length");
}

void CheckValue(const XmlElement& element, const std::string& owner, XmlErrors* errors) {
  if (!element.children.empty()) return;
  const std::string what = fmt::format("<{}> of {}", element.name, owner);
  const bool may_be_infinite = IsOneOf({"lower", "upper"}, element.name);
  if (element.name == "pose") {
    CheckPose(element, what, errors);
  } else if (element.name == "xyz" || element.name == "gravity") {
    errors->Numbers(element.text, 3, element.line, what);
  } else if (may_be_infinite && element.text.find("inf") != std::string::npos) {
    return;
  } else if (IsOneOf({"mass", "ixx", "iyy", "izz", "ixy", "ixz", "iyz", "lower", "upper", "damping",
                      "friction", "spring_reference", "spring_stiffness", "thread_pitch"},
                     element.name)) {
    const double value = errors->Numbers(element.text, 1, element.line, what)[0];
    if (value < 0 && IsOneOf({"mass", "damping", "friction", "spring_stiffness"}, element.name)) {
      errors->Add(element.line, fmt::format("{}, {}, must not be negative", what, value));
    }
  }
}

/// libsdformat before version 13 passes it over, and takes a pitch of its own.
void RefusePitch(const XmlElement& pitch, const std::string& owner, XmlErrors* errors) {
  const double metres = errors->Numbers(pitch.text, 1, pitch.line, "<screw_thread_pitch>")[0];
  errors->Add(pitch.line,
              fmt::format("{}: <screw_thread_pitch> is not read; give <thread_pitch>{:.17g}"
                          "</thread_pitch> [rad/m], which is -2 pi over it",
                          owner, -2 * std::numbers::pi / metres));
}

void CheckRoot(const XmlElement& root, XmlErrors* errors) {
  if (root.name != "sdf") {
    errors->Add(root.line, fmt::format("there is no <sdf> in it, but <{}>{}", root.name,
                                       root.name == "robot" ? ": name a URDF .urdf" : ""));
  }
  const XmlElement* first = nullptr;
  for (const XmlElement& child : root.children) {
    if (child.name != "model") continue;
    if (first != nullptr) {
      errors->Add(child.line, "a second <model> beside that of line " +
                                  std::to_string(first->line) +
                                  "; several models stand in a <world>");
    }
    first = &child;
  }
}

std::vector<fs::path> FoldersOf(const fs::path& file) {
  const fs::path here = fs::absolute(file).parent_path();
  std::vector<fs::path> folders{here, here.parent_path()};
  for (const char* variable : kVariables) {
    const char* value = std::getenv(variable);
    std::string_view rest = value == nullptr ? "" : value;
    while (!rest.empty()) {
      const size_t end = std::min(rest.find(':'), rest.size());
      if (end > 0) folders.emplace_back(rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  }
  return folders;
}

/// The file that a model.config names: the last of its <sdf>, which are ordered by version.
std::optional<fs::path> FileOfConfig(const fs::path& folder) {
  const fs::path config = folder / "model.config";
  std::error_code ignored;
  if (!fs::is_regular_file(config, ignored)) return {};
  const XmlElement root = ParseXml(ReadTextFile(config), config.string());
  std::optional<fs::path> file;
  for (const XmlElement& child : root.children) {
    if (child.name == "sdf") file = folder / Trimmed(child.text);
  }
  return file;
}

std::optional<fs::path> ModelFile(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_regular_file(path, ignored)) return path;
  if (!fs::is_directory(path, ignored)) return {};
  for (const std::optional<fs::path>& file :
       {FileOfConfig(path), std::optional(path / "model.sdf")}) {
    if (file && fs::is_regular_file(*file, ignored)) return file;
  }
  return {};
}

class Collector {
 public:
  explicit Collector(const fs::path& path) { Add(path); }

  SdfDocument Take() {
    document_.left_out = left_out_.Texts();
    return std::move(document_);
  }

 private:
  static constexpr int kMostIncludes = 10'000;

  /// Reads a file and those that it includes, and gives its index.
  int Add(const fs::path& path) {
    const int index = static_cast<int>(document_.files.size());
    document_.files.push_back({path, ReadTextFile(path), {}, {}});
    open_.push_back(index);
    const XmlElement root = ParseXml(document_.files[index].text, path.string());
    XmlErrors errors(path.string());
    CheckRoot(root, &errors);
    Check(root, "the file", path, &errors);
    errors.Throw();
    open_.pop_back();
    document_.files[index].root = root;
    return index;
  }

  void Check(const XmlElement& element, const std::string& outer, const fs::path& path,
             XmlErrors* errors) {
    const std::string owner = Owner(element, outer);
    for (const XmlElement& child : element.children) {
      if (child.name == "screw_thread_pitch") RefusePitch(child, owner, errors);
      if (!IsTaken(child, element.name)) {
        left_out_.Add(fmt::format("<{}>", child.name));
        continue;
      }
      CheckValue(child, owner, errors);
      if (child.name == "include") AddInclude(child, path, errors);
      Check(child, owner, path, errors);
    }
  }

  void AddInclude(const XmlElement& include, const fs::path& path, XmlErrors* errors) {
    const XmlElement* uri = OnlyChild(include, "uri", errors);
    if (uri == nullptr) return errors->Add(include.line, "<include> has no <uri>");
    const std::optional<fs::path> found = Find(*uri, path, errors);
    if (!found) return;
    const int file = Follow(*found, *uri, errors);
    if (file < 0) return;
    SdfFile& including = document_.files[open_.back()];
    including.includes.push_back({uri->tag_end, uri->text_end, file});
    including.expanded += document_.files[file].expanded;
    if (including.expanded <= kMostIncludes) return;
    throw FileErrors({{path.string(), uri->line, 1, "",
                       fmt::format("more than {} files are included in all", kMostIncludes)}});
  }

  std::optional<fs::path> Find(const XmlElement& uri, const fs::path& path, XmlErrors* errors) {
    const std::string whole = Trimmed(uri.text);
    const size_t scheme = whole.find("://");
    if (whole.starts_with("http")) {
      errors->Add(uri.line, fmt::format("{} is on the network, from which nothing is fetched: load "
                                        "it down and give its folder",
                                        Quoted(uri.text)));
      return {};
    }
    const std::string name = scheme == std::string::npos ? whole : whole.substr(scheme + 3);
    for (const fs::path& folder : name.empty() ? std::vector<fs::path>() : FoldersOf(path)) {
      if (const std::optional<fs::path> file = ModelFile(folder / name)) return file;
    }
    errors->Add(uri.line,
                fmt::format("{} is not found: neither a file nor a folder with a model.config or "
                            "model.sdf, beside this file or in the folders of {}",
                            Quoted(uri.text), fmt::join(kVariables, ", ")));
    return {};
  }

  /// The index of an included file, which is read but once, and not within itself.
  int Follow(const fs::path& path, const XmlElement& uri, XmlErrors* errors) {
    constexpr size_t kDeepest = 32;
    const auto is_it = [&](const SdfFile& file) {
      std::error_code ignored;
      return fs::equivalent(file.path, path, ignored);
    };
    const auto is_open = [&](int file) { return is_it(document_.files[file]); };
    const bool within_itself = std::any_of(open_.begin(), open_.end(), is_open);
    if (within_itself || open_.size() > kDeepest) {
      errors->Add(uri.line, within_itself
                                ? fmt::format("{} includes itself by {}",
                                              path.lexically_normal().string(), Quoted(uri.text))
                                : fmt::format("includes are more than {} deep", kDeepest));
      return -1;
    }
    const auto known = std::find_if(document_.files.begin(), document_.files.end(), is_it);
    if (known != document_.files.end()) return static_cast<int>(known - document_.files.begin());
    return Add(path.lexically_normal());
  }

  SdfDocument document_;
  std::vector<int> open_;  ///< the files around the one at hand, and that one
  LeftOut left_out_;
};

int CountElements(const XmlElement& element, std::string_view name, bool in_worlds) {
  int count = 0;
  for (const XmlElement& child : element.children) {
    if (!IsTaken(child, element.name)) continue;
    const bool counts = child.name == name && (in_worlds || element.name != "world");
    count += (counts ? 1 : 0) + CountElements(child, name, in_worlds);
  }
  return count;
}

}  // namespace

SdfDocument ReadSdfDocument(const fs::path& path) {
  return Collector(path).Take();
}

int CountElements(const SdfDocument& document, std::string_view name, bool in_worlds, int file) {
  const SdfFile& of = document.files[file];
  int count = CountElements(of.root, name, in_worlds);
  for (const SdfFile::Include& include : of.includes) {
    count += CountElements(document, name, in_worlds, include.file);
  }
  return count;
}

}  // namespace vmech
