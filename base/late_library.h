#pragma once

#include <filesystem>
#include <string>

namespace vmech {

/// A shared library that is loaded when it is asked for, and stays loaded: what few runs of a
/// program need costs the others nothing.
class LateLibrary {
 public:
  /// `name` stands for the file libvmech_<name>.so. It is looked for where the program, or the
  /// shared library that holds this function, looks for libraries: in the folders that it was
  /// linked with (RUNPATH), in LD_LIBRARY_PATH, and in those of the system.
  explicit LateLibrary(const std::string& name);

  bool loaded() const { return handle_ != nullptr; }  ///< else error() says why not
  /// What is missing, if it is not loaded: the file itself, or a library that it needs.
  const std::string& error() const { return error_; }
  /// Where it was found; empty if it is not loaded.
  std::filesystem::path path() const;

  /// Its variable of that name. @throws std::logic_error if it is not loaded or holds none.
  template <typename T>
  const T& Variable(const char* name) const {
    return *static_cast<const T*>(Find(name));
  }

 private:
  const void* Find(const char* name) const;

  void* handle_ = nullptr;
  std::string error_;
};

}  // namespace vmech
