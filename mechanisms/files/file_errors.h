#pragma once

#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace vmech {

/// One thing that is wrong with a file.
struct FileError {
  std::string file;     ///< as it was named
  int line = 0;         ///< from 1; 0 if the file as a whole is meant
  int column = 0;       ///< from 1
  std::string path;     ///< place in the document, as in "joints.main.start[1]"; may be empty
  std::string message;  ///< what is wrong and what to do
};

/// "file:line:column: path: message".
std::string ToString(const FileError& error);

/// Everything that is wrong with one or several files. what() has a line for each.
class FileErrors : public std::runtime_error {
 public:
  explicit FileErrors(std::vector<FileError> errors);               ///< at least one
  FileErrors(std::string file, std::string message);                ///< about the file as a whole
  const std::vector<FileError>& errors() const { return errors_; }  ///< in the order of what()

 private:
  std::vector<FileError> errors_;
};

/// The largest file that is read [bytes].
constexpr size_t kMaxFileBytes = size_t{8} << 20;

/// The whole of a text file. @throws FileErrors if it cannot be read or is larger than allowed.
std::string ReadTextFile(const std::filesystem::path& path, size_t max_bytes = kMaxFileBytes);

/// "; did you mean 'crank'?" if a candidate is near the word, else empty.
std::string DidYouMean(std::string_view word, std::span<const std::string> candidates);

/// A text from a file as it may be shown in a message: in quotes, short, without control
/// characters.
std::string Quoted(std::string_view text);

}  // namespace vmech
