#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace vmech {

/// The 64-bit digest FNV-1a [Fowler, Noll & Vo] of a text, going on from that of another. It tells
/// whether something changed, not who changed it.
uint64_t DigestOf(std::string_view text, uint64_t before = 0xCBF29CE484222325u);

/// The digest of the program that runs: the same for the same build. 0 if it cannot be read.
uint64_t DigestOfThisProgram();

}  // namespace vmech
