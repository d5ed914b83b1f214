#include "vmech/studies/sha256.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>

namespace vmech {
namespace {

constexpr size_t kBlock = 64;  // bytes
constexpr std::array<uint32_t, 64> kRound = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

using State = std::array<uint32_t, 8>;

uint32_t RotateRight(uint32_t x, int bits) {
  return x >> bits | x << (32 - bits);
}

/// FIPS 180-4, 6.2.2, step 1: the message schedule of a block.
std::array<uint32_t, 64> ScheduleOf(std::string_view block) {
  std::array<uint32_t, 64> w{};
  for (size_t i = 0; i < kBlock; ++i) {
    w[i / 4] = w[i / 4] << 8 | static_cast<unsigned char>(block[i]);
  }
  for (size_t t = 16; t < w.size(); ++t) {
    const uint32_t a = w[t - 15], b = w[t - 2];
    w[t] = (RotateRight(b, 17) ^ RotateRight(b, 19) ^ b >> 10) + w[t - 7] +
           (RotateRight(a, 7) ^ RotateRight(a, 18) ^ a >> 3) + w[t - 16];
  }
  return w;
}

/// Steps 2 to 4.
void Absorb(std::string_view block, State* hash) {
  const std::array<uint32_t, 64> w = ScheduleOf(block);
  auto [a, b, c, d, e, f, g, h] = *hash;
  for (size_t t = 0; t < w.size(); ++t) {
    const uint32_t t1 = h + (RotateRight(e, 6) ^ RotateRight(e, 11) ^ RotateRight(e, 25)) +
                        ((e & f) ^ (~e & g)) + kRound[t] + w[t];
    const uint32_t t2 = (RotateRight(a, 2) ^ RotateRight(a, 13) ^ RotateRight(a, 22)) +
                        ((a & b) ^ (a & c) ^ (b & c));
    h = g, g = f, f = e, e = d + t1, d = c, c = b, b = a, a = t1 + t2;
  }
  const State mixed = {a, b, c, d, e, f, g, h};
  for (size_t i = 0; i < mixed.size(); ++i) (*hash)[i] += mixed[i];
}

/// 5.1.1: what is behind the last whole block, a one, zeros, and the length in bits.
std::string PaddedEnd(std::string_view bytes) {
  std::string end(bytes.substr(bytes.size() / kBlock * kBlock));
  end += '\x80';
  while (end.size() % kBlock != kBlock - 8) end += '\0';
  const uint64_t bits = uint64_t{bytes.size()} * 8;
  for (int shift = 56; shift >= 0; shift -= 8) end += static_cast<char>(bits >> shift & 0xff);
  return end;
}

}  // namespace

std::string Sha256(std::string_view bytes) {
  State hash = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  size_t at = 0;
  for (; at + kBlock <= bytes.size(); at += kBlock) Absorb(bytes.substr(at, kBlock), &hash);
  const std::string end = PaddedEnd(bytes);
  for (at = 0; at < end.size(); at += kBlock) {
    Absorb(std::string_view(end).substr(at, kBlock), &hash);
  }
  std::string digits;
  for (const uint32_t word : hash) digits += fmt::format("{:08x}", word);
  return digits;
}

}  // namespace vmech
