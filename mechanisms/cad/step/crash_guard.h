#pragma once

#include <functional>

namespace vmech {

/// True if the work returns or throws, false if it brings its process down: it is done in a child
/// process, and nothing of it is kept. Open CASCADE 7.6 reads through null pointers in some damaged
/// files.
bool Survives(const std::function<void()>& work);

}  // namespace vmech
