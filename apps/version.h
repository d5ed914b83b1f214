#pragma once

namespace vmech {

/// What `vmech --version` prints: version, commit, compiler, and the packages that this build has
/// and lacks. Put here by CMake, so that nothing has to be loaded to know it.
const char* VersionText();

}  // namespace vmech
