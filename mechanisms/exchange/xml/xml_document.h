#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vmech/mechanisms/files/document.h"

namespace vmech {

/// An element of an XML file, with its place.
struct XmlElement {
  std::string name;  ///< of its tag
  std::string text;  ///< between its tags, without that of its children
  std::vector<std::pair<std::string, std::string>> attributes;  ///< names and values as written
  std::vector<XmlElement> children;                             ///< in the order of the file
  int line = 0;                                                 ///< of its tag, from 1
  size_t tag_end = 0;   ///< bytes from the head of the file to the end of its first tag
  size_t text_end = 0;  ///< and to the head of its last tag; the same if it has but one

  /// The value of an attribute; null if there is none.
  const std::string* Attribute(std::string_view key) const;
};

constexpr int kMaxXmlElements = 500'000;   ///< in a file
constexpr size_t kMaxXmlAttributes = 100;  ///< of an element

/// The root of an XML 1.0 text in UTF-8. Comments and processing instructions are passed over.
/// Declarations (<!DOCTYPE>, <!ENTITY>) are refused: no format that is read here needs entities of
/// its own, which can make gigabytes of a line.
/// @throws FileErrors with the line if it is not well-formed, nested more than kMaxNesting deep or
///         has more than kMaxXmlElements; `file` stands for the text in messages.
XmlElement ParseXml(std::string_view text, const std::string& file);

/// Collects what is wrong with XML files, to tell it in one go.
class XmlErrors {
 public:
  explicit XmlErrors(std::string file) : file_(std::move(file)) {}  ///< as messages name it

  void Add(int line, std::string message);  ///< line from 1
  /// @throws FileErrors if there is anything to tell.
  void Throw() const;
  const std::string& file() const { return file_; }  ///< as messages name it
  size_t size() const { return errors_.size(); }     ///< messages so far
  /// There is as much as can be read at once; more is not kept.
  bool full() const { return errors_.size() >= kMost; }

  /// As many numbers as are asked for, from an attribute or the text of an element. `what` names
  /// the value in messages. Not finite, beyond kMaxNumber, not a number, too few or too many is
  /// told, and gives zeros.
  std::vector<double> Numbers(std::string_view text, size_t count, int line, std::string_view what);
  /// An attribute that is one number; the fallback if it is absent.
  double Number(const XmlElement& element, std::string_view key, double fallback,
                std::string_view what);

 private:
  static constexpr size_t kMost = 50;
  std::string file_;
  std::vector<FileError> errors_;
};

/// Counts what is left out of a file, so that nothing is lost in silence.
class LeftOut {
 public:
  void Add(const std::string& what) { ++counts_[what]; }  ///< one more of this description
  /// "3 <visual>", in the order of the alphabet; what is too much to read is summed up.
  std::vector<std::string> Texts() const;

 private:
  std::map<std::string, int> counts_;
};

/// The child of this name; null if there is none. Two are an error.
const XmlElement* OnlyChild(const XmlElement& element, std::string_view name, XmlErrors* errors);

}  // namespace vmech
