#pragma once

#include <stdexcept>

namespace vmech {

/// A value of an option or an argument that means nothing: the command line is wrong, not a file.
/// The message names the option, the value and what would do.
class OptionError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

}  // namespace vmech
