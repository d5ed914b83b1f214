#pragma once

namespace vmech {

/// Becomes the program `vmech-import`, which stands beside this one, with the arguments of
/// `vmech import`; arguments[0] is the word "import".
/// @throws FileErrors if it is not there.
[[noreturn]] void BecomeImport(char** arguments);

}  // namespace vmech
