#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "vmech/mechanisms/exchange/xml/xml_document.h"

namespace vmech {

/// An SDFormat file before libsdformat sees it, which passes over much of what is wrong: everything
/// that ends up in a mechanism must be there as finite numbers, and every file that is included
/// must be found.
struct SdfFile {
  /// A uri of the text that names another file.
  struct Include {
    size_t begin = 0, end = 0;  ///< bytes of the uri in the text
    int file = -1;              ///< what it names, by index
  };
  std::filesystem::path path;     ///< absolute
  std::string text;               ///< the bytes of the file
  XmlElement root;                ///< its outermost element
  std::vector<Include> includes;  ///< in the order of the text
  int expanded = 1;               ///< files that come of it, counted as often as they are included
};

/// A file, the first, and those that it includes, each once.
struct SdfDocument {
  std::vector<SdfFile> files;  ///< the first is the one that was asked for
  /// Elements of which nothing is taken, "3 <visual>", in all files.
  std::vector<std::string> left_out;

  const SdfFile& main() const { return files[0]; }  ///< the file that was asked for
};

/// How many elements of a name ("link", "joint") a file has, with those of what it includes, as
/// often as it does. Of a world itself they are counted if asked for.
int CountElements(const SdfDocument& document, std::string_view name, bool in_worlds, int file = 0);

/// A uri "model://arm", "file://arm/model.sdf" or a path is looked for beside the file that
/// includes it, beside the folder of that file, and in the folders of the variables SDF_PATH,
/// GZ_SIM_RESOURCE_PATH, IGN_GAZEBO_RESOURCE_PATH and GAZEBO_MODEL_PATH; it leads to a file, or to
/// a folder with a model.config or a model.sdf.
/// @throws FileErrors with the lines: no SDF, numbers, files that are not found or include
///         themselves.
SdfDocument ReadSdfDocument(const std::filesystem::path& path);

}  // namespace vmech
