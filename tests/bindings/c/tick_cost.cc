// What a tick costs more through C: `c_tick_cost MECHANISM` prints nanoseconds, both ways in turn.

#include <vmech.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

#include "vmech/dynamics/in_hand/passive_joints.h"
#include "vmech/hw_interface/rendering/coupled_tick.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"
#include "vmech/mechanisms/files/reader.h"

namespace {

constexpr double kPeriod = 1e-3;
constexpr int kBlocks = 400, kTicks = 500;

/// Nanoseconds of a tick, on average over a block.
template <typename Tick>
double Time(Tick tick) {
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < kTicks; ++i) tick();
  const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - start;
  return took.count() / kTicks;
}

double Median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 2) return 1;
  vmech_mechanism* mechanism = vmech_mechanism_open(arguments[1]);
  vmech_tick_options options{};
  options.struct_size = sizeof options;
  options.period = kPeriod;
  std::fill_n(options.stiffness, 3, 2000);
  std::fill_n(options.damping, 3, 20);
  vmech_tick* in_c = vmech_tick_new(mechanism, &options);
  vmech_pose hand;
  if (vmech_tick_grasp(in_c, &hand) != VMECH_OK) return 1;

  const vmech::Mechanism read = vmech::ReadMechanism(arguments[1]);
  const vmech::KinematicTree tree = vmech::BuildKinematicTree(
      vmech::RequireAssembled(read).mechanism, vmech::KeepPassiveJoints(read));
  vmech::CoupledTickOptions coupled;
  coupled.coupling.stiffness.head<3>().setConstant(2000);
  coupled.coupling.damping.head<3>().setConstant(20);
  coupled.smoothing = 2 * kPeriod;
  vmech::CoupledTick in_cpp(tree, 0, vmech::StartCoordinates(tree), kPeriod, coupled);
  std::vector<double> channels(in_cpp.ChannelNames().size());
  vmech::TickInput input;
  input.X_WH = in_cpp.GraspFrame();
  input.fresh = true;
  input.elapsed = kPeriod;

  double wrench[6], sum = 0;
  std::vector<double> c, cpp;
  for (int block = 0; block < kBlocks; ++block) {
    c.push_back(Time([&] { sum += vmech_tick_step(in_c, &hand, wrench); }));
    cpp.push_back(Time([&] { sum += in_cpp.Step(input, channels).F_Ho_W[0]; }));
  }
  std::printf("a tick: %.0f ns in C++, %.0f ns through C (%g)\n", Median(cpp), Median(c), sum);
  vmech_tick_free(in_c);
  vmech_mechanism_free(mechanism);
}
