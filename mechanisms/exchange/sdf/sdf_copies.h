#pragma once

#include <filesystem>
#include <string>

#include "vmech/mechanisms/exchange/sdf/sdf_document.h"

namespace vmech {

/// The files of a document as libsdformat gets them, so that it finds the files that were checked
/// and no others: those that are included are copied to a folder of their own, and every uri is the
/// whole path of such a copy. All lines stay where they are.
class SdfCopies {
 public:
  /// Joints between the models of a world are passed over by libsdformat before version 13; if
  /// asked for, the contents of such a world are put into a model of its name.
  /// @throws FileErrors if there is no room for the copies.
  SdfCopies(const SdfDocument& document, bool join_worlds);
  ~SdfCopies();
  SdfCopies(const SdfCopies&) = delete;
  SdfCopies& operator=(const SdfCopies&) = delete;

  const std::string& main() const { return main_; }  ///< path of the copy of the first file
  /// The file behind a path that libsdformat tells; the main one for whatever is no copy.
  const std::filesystem::path& OriginalOf(const std::string& copy) const;

 private:
  std::filesystem::path CopyOf(int file) const;
  std::string Adapted(const SdfFile& file, bool join_worlds) const;

  const SdfDocument& document_;
  std::filesystem::path folder_;
  std::string main_;
};

}  // namespace vmech
