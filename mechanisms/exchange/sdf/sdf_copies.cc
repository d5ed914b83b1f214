#include "vmech/mechanisms/exchange/sdf/sdf_copies.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <fstream>
#include <vector>

#include "vmech/mechanisms/exchange/xml/xml_text.h"

namespace vmech {
namespace {

namespace fs = std::filesystem;

/// Bytes of a text that become others.
struct Edit {
  size_t begin = 0, end = 0;
  std::string text;
};

std::string Edited(std::string text, std::vector<Edit> edits) {
  std::stable_sort(edits.begin(), edits.end(),
                   [](const Edit& a, const Edit& b) { return a.begin > b.begin; });
  for (const Edit& edit : edits) text.replace(edit.begin, edit.end - edit.begin, edit.text);
  return text;
}

bool HasJoints(const XmlElement& world) {
  return std::any_of(world.children.begin(), world.children.end(),
                     [](const XmlElement& child) { return child.name == "joint"; });
}

void AddJoinedWorlds(const XmlElement& root, std::vector<Edit>* edits) {
  for (const XmlElement& world : root.children) {
    if (world.name != "world" || !HasJoints(world)) continue;
    const std::string* name = world.Attribute("name");
    const std::string model = XmlEscaped(name == nullptr ? "world" : *name);
    edits->push_back({world.tag_end, world.tag_end, fmt::format("<model name=\"{}\">", model)});
    edits->push_back({world.text_end, world.text_end, "</model>"});
  }
}

fs::path NewFolder() {
  std::string name = fs::temp_directory_path() / "vmech-sdf-XXXXXX";
  if (mkdtemp(name.data()) == nullptr) {
    throw FileErrors(name, "cannot be made, where included files are copied to (TMPDIR)");
  }
  return name;
}

}  // namespace

SdfCopies::SdfCopies(const SdfDocument& document, bool join_worlds) : document_(document) {
  if (document.files.size() > 1) folder_ = NewFolder();
  main_ = Adapted(document.main(), join_worlds);
  for (size_t i = 1; i < document.files.size(); ++i) {
    std::ofstream copy(CopyOf(static_cast<int>(i)), std::ios::binary);
    copy << Adapted(document.files[i], false);
    copy.close();
    if (!copy) throw FileErrors(CopyOf(static_cast<int>(i)).string(), "cannot be written");
  }
}

SdfCopies::~SdfCopies() {
  std::error_code ignored;
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

fs::path SdfCopies::CopyOf(int file) const {
  return folder_ / fmt::format("{}.sdf", file);
}

std::string SdfCopies::Adapted(const SdfFile& file, bool join_worlds) const {
  std::vector<Edit> edits;
  for (const SdfFile::Include& include : file.includes) {
    edits.push_back({include.begin, include.end, CopyOf(include.file).string()});
  }
  if (join_worlds) AddJoinedWorlds(file.root, &edits);
  return Edited(file.text, std::move(edits));
}

const fs::path& SdfCopies::OriginalOf(const std::string& copy) const {
  for (size_t i = 1; i < document_.files.size(); ++i) {
    if (copy == CopyOf(static_cast<int>(i))) return document_.files[i].path;
  }
  return document_.main().path;
}

}  // namespace vmech
