#include "vmech/comparison/random.h"

namespace vmech {

uint64_t PortableRandom::Next() {
  state_ += 0x9E3779B97F4A7C15u;
  uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

double PortableRandom::Uniform() {
  return static_cast<double>(Next() >> 11) * 0x1p-53;
}

double PortableRandom::Between(double a, double b) {
  return a + (b - a) * Uniform();
}

int PortableRandom::Below(int n) {
  return static_cast<int>(Uniform() * n);
}

double PortableRandom::Normal() {
  double sum = -6;
  for (int i = 0; i < 12; ++i) sum += Uniform();
  return sum;
}

VectorXd PortableRandom::NormalVector(Eigen::Index n) {
  VectorXd x(n);
  for (double& value : x) value = Normal();
  return x;
}

uint64_t SeedOf(uint64_t seed, std::initializer_list<uint64_t> indices) {
  uint64_t mixed = PortableRandom(seed).Next();
  for (const uint64_t index : indices) mixed = PortableRandom(mixed ^ (index + 1)).Next();
  return mixed;
}

}  // namespace vmech
