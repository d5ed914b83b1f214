#pragma once

#include <cstdint>
#include <initializer_list>

#include "vmech/base/pose.h"

namespace vmech {

/// Random numbers that are the same on every machine and with every standard library: SplitMix64
/// [Steele, Lea & Flood 2014], and nothing but sums and products of its outputs.
class PortableRandom {
 public:
  /// `seed` is any number; equal seeds give equal series.
  explicit PortableRandom(uint64_t seed) : state_(seed) {}

  uint64_t Next();                     ///< the next number, all of its 64 bits random
  double Uniform();                    ///< in [0, 1), 53 bits
  double Between(double a, double b);  ///< in [a, b)
  int Below(int n);                    ///< 0 .. n - 1
  double Normal();  ///< mean 0, variance 1: twelve uniforms (Irwin-Hall), |x| < 6
  VectorXd NormalVector(Eigen::Index n);  ///< [n] of Normal()

 private:
  uint64_t state_;
};

/// A seed of its own for every combination of indices below a common seed.
uint64_t SeedOf(uint64_t seed, std::initializer_list<uint64_t> indices);

}  // namespace vmech
