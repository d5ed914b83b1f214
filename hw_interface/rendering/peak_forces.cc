#include "vmech/hw_interface/rendering/peak_forces.h"

#include <fmt/format.h>

#include <algorithm>

#include "vmech/hw_interface/rendering/tick.h"

namespace vmech {

PeakForces::PeakForces(const Mechanism& mechanism) : forces_(mechanism.joints.size(), 0.0) {
  for (const Joint& joint : mechanism.joints) names_.push_back(joint.name);
}

void PeakForces::AppendNames(std::vector<std::string>* names) const {
  for (const std::string& name : names_) {
    if (names->size() == kMaxChannels) return;
    names->push_back("force " + name);
  }
}

void PeakForces::Reset() noexcept {
  std::fill(forces_.begin(), forces_.end(), 0.0);
}

void PeakForces::Add(const std::vector<Wrenchd>& joints, std::span<double> channels) noexcept {
  for (size_t j = 0; j < forces_.size(); ++j) {
    const double force = joints[j].force.norm();
    forces_[j] = std::max(forces_[j], force);
    if (j < channels.size()) channels[j] = force;
  }
}

std::string PeakForces::Report() const {
  std::string lines;
  for (size_t j = 0; j < forces_.size(); ++j) {
    lines += fmt::format("  largest force at {:<16} {:>10.4g} N\n", names_[j], forces_[j]);
  }
  return lines;
}

}  // namespace vmech
