#include "vmech/studies/read_simulation.h"

#include <fmt/format.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "vmech/mechanisms/freedoms.h"
#include "vmech/studies/read_motion.h"

namespace vmech {
namespace {

constexpr int kMostPoses = 10'000'000;

/// The factors of a freedom's figures.
struct FreedomUnits {
  FreedomUnits(const Units& units, const Mechanism& mechanism, const FreedomId& at)
      : rotates(IsRotation(mechanism.joints[at.joint].type, at.freedom)),
        position(rotates ? units.angle : units.length),
        force(rotates ? units.torque : units.force),
        stiffness(rotates ? units.rotational_stiffness : units.stiffness),
        damping(rotates ? units.rotational_damping : units.damping) {}

  bool rotates;
  Unit position, force, stiffness, damping;
};

/// The joint and the freedom that an entry names; no joint if there is none, which is reported.
FreedomId ReadFreedomId(const Node& node, const Mechanism& mechanism, bool balls = false) {
  JointDrive driven;
  if (!ReadDriven(node, mechanism, &driven, balls)) return {};
  return {driven.joint, driven.freedom};
}

TimeTable ReadForceTable(const Node& node, double unit, const Units& units,
                         const std::filesystem::path& folder) {
  TimeTable force;
  const CsvTable table = ReadTable(node, folder);
  if (table.rows() == 0 || !CheckColumns(node, table, {"t", "value"}, {})) return force;
  for (const double t : *table.Find("t")) force.at.push_back(units.time * t);
  for (const double value : *table.Find("value")) force.values.push_back(unit * value);
  for (size_t i = 1; i < force.at.size(); ++i) {
    if (force.at[i] > force.at[i - 1]) continue;
    ReportInTable(node, table, static_cast<int>(i), "the times must increase");
    return {};
  }
  return force;
}

/// The table repeats after a period, which it must neither exceed nor end with a jump.
void ReadForcePeriod(const Node& node, double span, const Units& units, TimeTable* force) {
  force->period = node.Positive(units.time);
  if (span > force->period * (1 + 1e-9)) {
    node.Error(fmt::format("the table takes longer, {:.6g} s", span));
  } else if (span >= force->period * (1 - 1e-9) && force->values.back() != force->values.front()) {
    node.Error("the last row of the table is one period after the first, but has another value");
  }
}

/// What a controller wants: a position to hold, or a speed.
MotionLaw ReadWanted(const Node& node, const FreedomUnits& unit, double start, const Units& units) {
  if (const Node hold = node["hold"]) {
    return MotionLaw::Uniform(hold.Number(unit.position), 0);
  }
  return MotionLaw::Uniform(start, ReadSpeed(node, unit.rotates, units));
}

void ReadController(const Node& node, const FreedomUnits& unit, double start, const Units& units,
                    JointMotor* motor) {
  motor->law = JointMotor::Law::kController;
  motor->wanted = ReadWanted(node, unit, start, units);
  motor->stiffness = node["stiffness"].NonNegative(unit.stiffness, 0);
  motor->damping = node["damping"].NonNegative(unit.damping, 0);
  if (motor->stiffness == 0 && motor->damping == 0) {
    node.KeyError("a controller needs 'stiffness', 'damping' or both");
  }
  if (node["hold"] && motor->stiffness == 0) node.KeyError("holding a position needs 'stiffness'");
}

JointMotor ReadMotor(const Node& node, const Units& units, const std::filesystem::path& folder,
                     const Mechanism& mechanism) {
  JointMotor motor;
  if (!node.CheckKeys({"joint"}, {"freedom", "force", "table", "hold", "speed", "rpm", "stiffness",
                                  "damping", "max_force", "period"})) {
    return motor;
  }
  motor.at = ReadFreedomId(node, mechanism);
  if (motor.at.joint < 0) return motor;
  const FreedomUnits unit(units, mechanism, motor.at);
  const bool turns = node["speed"] || node["rpm"], controls = node["hold"] || turns;
  if (!!node["force"] + !!node["table"] + !!node["hold"] + turns != 1) {
    node.KeyError(
        "a motor has one of 'force', 'table' (of forces), 'hold' (a position), 'speed' "
        "and 'rpm'");
    return motor;
  }
  if (const Node most = node["max_force"]) motor.max_force = most.Positive(unit.force);
  const Node period = node["period"];
  if (period && !node["table"]) period.KeyError("used with a table only");
  if (controls) {
    const double start = mechanism.joints[motor.at.joint].start[motor.at.freedom];
    ReadController(node, unit, start, units, &motor);
    return motor;
  }
  for (const char* key : {"stiffness", "damping"}) {
    if (const Node extra = node[key]) extra.KeyError("used with 'hold', 'speed' and 'rpm' only");
  }
  if (node["table"]) {
    motor.force = ReadForceTable(node["table"], unit.force, units, folder);
    if (period && !motor.force.at.empty()) {
      const double span = motor.force.at.back() - motor.force.at.front();
      ReadForcePeriod(period, span, units, &motor.force);
    }
  } else {
    motor.force = {{0}, {node["force"].Number(unit.force)}};
  }
  return motor;
}

StartRate ReadStartRate(const Node& node, const Units& units, const Mechanism& mechanism) {
  StartRate rate;
  if (!node.CheckKeys({"joint"}, {"freedom", "rpm", "speed"})) return rate;
  rate.at = ReadFreedomId(node, mechanism, true);
  if (rate.at.joint < 0) return rate;
  if (!node["rpm"] && !node["speed"]) node.KeyError("give 'rpm' or 'speed'");
  const FreedomUnits unit(units, mechanism, rate.at);
  rate.rate = ReadSpeed(node, unit.rotates, units);
  return rate;
}

LimitRebound ReadRebound(const Node& node, const Mechanism& mechanism) {
  LimitRebound rebound;
  if (!node.CheckKeys({"joint", "restitution"}, {"freedom"})) return rebound;
  rebound.at = ReadFreedomId(node, mechanism);
  rebound.restitution = node["restitution"].NonNegative(0);
  if (rebound.restitution > 1)
    node["restitution"].Error("must be at most 1: no impact adds energy");
  return rebound;
}

CoordinateWatch ReadWatch(const Node& node, const Units& units, const Mechanism& mechanism) {
  CoordinateWatch watch;
  if (!node.CheckKeys({"joint", "at"}, {"freedom", "ends"})) return watch;
  watch.at = ReadFreedomId(node, mechanism);
  if (watch.at.joint < 0) return watch;
  watch.value = node["at"].Number(FreedomUnits(units, mechanism, watch.at).position);
  watch.ends_run = node["ends"].Boolean(false);
  return watch;
}

Vector6d ReadSixGains(const Node& node, const Unit& linear, const Unit& angular) {
  Vector6d gains = Vector6d::Zero();
  const std::vector<double> numbers = node.Numbers(SixUnits(linear, angular));
  for (size_t i = 0; i < numbers.size(); ++i) {
    gains[static_cast<Eigen::Index>(i)] = numbers[i];
    if (!(numbers[i] >= 0)) node.Error("must not be negative");
  }
  return gains;
}

std::optional<GraspSpring> ReadHandSpring(const Node& node, const Units& units,
                                          const std::filesystem::path& folder,
                                          const Mechanism& mechanism) {
  if (!node.CheckKeys({"grasp", "table", "stiffness"}, {"damping"})) return std::nullopt;
  GraspSpring hand;
  hand.grasp = FindPart(node["grasp"], "grasp", mechanism.grasps);
  if (hand.grasp < 0) return std::nullopt;
  const std::optional<HandTable> table =
      ReadHandTable(node["table"], units, folder, mechanism.grasps[hand.grasp].kind);
  if (!table) return std::nullopt;
  hand.law = table->law;
  hand.coupling.stiffness =
      ReadSixGains(node["stiffness"], units.stiffness, units.rotational_stiffness);
  if (const Node damping = node["damping"]) {
    hand.coupling.damping = ReadSixGains(damping, units.damping, units.rotational_damping);
  }
  return hand;
}

SimulationOptions ReadOptions(const Node& node) {
  SimulationOptions options;
  options.method = node["method"].Word<SimulationMethod>(
      {{NameOf(SimulationMethod::kAutomatic), SimulationMethod::kAutomatic},
       {NameOf(SimulationMethod::kAdams), SimulationMethod::kAdams},
       {NameOf(SimulationMethod::kBdf), SimulationMethod::kBdf},
       {NameOf(SimulationMethod::kIdas), SimulationMethod::kIdas}},
      SimulationMethod::kAutomatic);
  if (const Node tolerance = node["tolerance"]) {
    options.relative_tolerance = options.absolute_tolerance =
        tolerance.Number(options.relative_tolerance);
    try {
      options.Validate();
    } catch (const std::invalid_argument& defect) {
      tolerance.Error(defect.what());
    }
  }
  return options;
}

/// Evenly from 0 to the duration.
std::vector<double> ReadTimes(const Node& node, const Units& units) {
  const double duration = node["duration"].Positive(units.time, 1);
  const int steps = node["steps"].Integer(400, 1, kMostPoses);
  std::vector<double> times;
  for (int i = 0; i <= steps; ++i) times.push_back(duration * i / steps);
  return times;
}

}  // namespace

void ReadSimulation(const Node& node, const Units& units, const std::filesystem::path& folder,
                    StudyFile* file) {
  if (!node.CheckKeys({"duration"}, {"steps", "start", "rates", "drives", "motors", "restitution",
                                     "watch", "hand", "method", "tolerance"})) {
    return;
  }
  const Mechanism& mechanism = file->study.mechanism;
  file->study.times = ReadTimes(node, units);
  SimulationRequest request;
  Simulation& simulation = request.simulation;
  simulation.start = node["start"].Word<SimulationStart>(
      {{"drawn", SimulationStart::kAsDrawn}, {"equilibrium", SimulationStart::kEquilibrium}},
      SimulationStart::kAsDrawn);
  for (const Node& entry : node["drives"].List()) {
    ReadFollowingDrive(entry, units, folder, &file->study);
  }
  for (const Node& entry : node["rates"].List()) {
    simulation.start_rates.push_back(ReadStartRate(entry, units, mechanism));
  }
  for (const Node& entry : node["motors"].List()) {
    simulation.motors.push_back(ReadMotor(entry, units, folder, mechanism));
  }
  for (const Node& entry : node["restitution"].List()) {
    simulation.rebounds.push_back(ReadRebound(entry, mechanism));
  }
  for (const Node& entry : node["watch"].List()) {
    simulation.watches.push_back(ReadWatch(entry, units, mechanism));
  }
  if (const Node hand = node["hand"]) {
    simulation.hand = ReadHandSpring(hand, units, folder, mechanism);
  }
  request.options = ReadOptions(node);
  file->simulation = std::move(request);
}

std::string SimulationInWords(const Node& node, const StudyFile& file) {
  std::string words = fmt::format("simulated for {:g} s", file.study.times.back());
  if (file.simulation->simulation.start == SimulationStart::kEquilibrium) {
    words += " from its equilibrium";
  }
  const size_t motors = file.simulation->simulation.motors.size();
  if (motors > 0) words += fmt::format(", {} motor{}", motors, motors > 1 ? "s" : "");
  if (node["hand"]) words += ", a hand at " + node["hand"]["grasp"].Text();
  return words;
}

}  // namespace vmech
