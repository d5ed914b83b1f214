#include "vmech/apps/haptic/haptic_session.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <stdexcept>
#include <utility>

#include "vmech/apps/console/option_error.h"
#include "vmech/apps/files/file_kind.h"
#include "vmech/apps/files/parameter_options.h"
#include "vmech/hw_interface/haply/haply_master.h"
#include "vmech/hw_interface/loop/replay_master.h"
#include "vmech/hw_interface/masters/plugin_master.h"
#include "vmech/hw_interface/masters/spacenav_master.h"
#include "vmech/hw_interface/recording/recording_file.h"
#include "vmech/hw_interface/remote/udp_master.h"
#include "vmech/hw_interface/remote/udp_socket.h"
#include "vmech/hw_interface/rendering/coupling_choice.h"
#include "vmech/hw_interface/rendering/hand_motion.h"
#include "vmech/hw_interface/rendering/paper_choice.h"
#include "vmech/hw_interface/rendering/registration.h"
#include "vmech/kinematics/tree/grasp_rows.h"
#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/files/reader.h"
#include "vmech/studies/study_reader.h"

namespace vmech {
namespace {

HapticSubject ReadHeldStudy(const std::filesystem::path& file,
                            std::span<const ParameterSetting> settings) {
  StudyFile study = ReadStudy(file, settings);
  if (!study.study.hand) {
    throw FileErrors(file.string(),
                     "no hand moves this study; give `motion` a grasp, or name the mechanism");
  }
  if (!study.study.external.empty()) {
    throw FileErrors(file.string(), "external loads are not rendered to a hand; leave them out");
  }
  return {std::move(study.study.mechanism),
          {study.study.hand->grasp},
          study.study.hand->law,
          study.study.times.back()};
}

/// The part of a word behind the mark of its kind: "FILE" of "replay:FILE".
std::optional<std::string> AfterMark(const std::string& word, std::string_view mark) {
  if (word.rfind(mark, 0) != 0) return std::nullopt;
  return word.substr(mark.size());
}

/// Moment on the gripper [N m]: closes after half a second, opens for a second every four.
double SqueezeWithPauses(double time) {
  constexpr double kFirm = 0.4;
  const bool closes = time > 0.5 && std::fmod(time, 4.0) < 3;
  return closes ? kFirm : -kFirm;
}

std::unique_ptr<Master> MakeSimulated(const MasterRequest& request) {
  constexpr double kReach = 0.05;  // [m] of a wandering hand
  constexpr double kTurn = 0.2;    // [rad]
  SimulatedMasterOptions options;
  options.period = 1 / request.rate;
  options.hand = ImpedanceOf(request.grip);
  const Posed X_DH = ArmModel(std::make_shared<const ArmDescription>(SarcosMasterArm())).X_DH();
  options.motion = request.law ? HandMotionOf(*request.law, request.end,
                                              GraspedAt(request.R_WD, X_DH, request.X_WG))
                               : Wander(X_DH, kReach, kTurn, request.seed);
  if (request.gripper) options.squeeze = SqueezeWithPauses;
  return std::make_unique<SimulatedMaster>(options);
}

/// A whole number, all of the text. @throws OptionError saying what is meant instead.
int PortOf(std::string_view text, std::string_view meant, std::string_view word) {
  int port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  if (error == std::errc{} && end == text.data() + text.size()) return port;
  throw OptionError(fmt::format("--master: {} is meant, not {}", meant, Quoted(word)));
}

std::unique_ptr<Master> MakeUdp(const std::string& address) {
  const std::size_t colon = address.rfind(':');
  UdpMasterOptions options;
  options.local.host = "0.0.0.0";
  options.device.host = address.substr(0, colon);
  const std::string port = colon == std::string::npos ? "" : address.substr(colon + 1);
  options.device.port = PortOf(port, "udp:HOST:PORT", "udp:" + address);
  try {
    ToSockaddr(options.device);
  } catch (const std::invalid_argument& error) {
    throw OptionError(fmt::format("--master: {}", error.what()));
  }
  return std::make_unique<UdpMaster>(options);
}

/// "LIBRARY[:PARAMETERS]"; a file in this folder needs no "./" before it.
std::unique_ptr<Master> MakePlugin(const std::string& word) {
  const std::size_t colon = word.find(':');
  const std::string parameters = colon == std::string::npos ? "" : word.substr(colon + 1);
  std::filesystem::path library = word.substr(0, colon);
  if (library.empty()) {
    throw OptionError(fmt::format("--master: plugin:LIBRARY[:PARAMETERS] is meant, not {}",
                                  Quoted("plugin:" + word)));
  }
  if (std::filesystem::exists(library)) library = std::filesystem::absolute(library);
  return UsingFile("--master", [&] { return std::make_unique<PluginMaster>(library, parameters); });
}

std::string ScaleReport(double scale, double wanted) {
  if (scale == 1) return {};
  return fmt::format("forces are felt at {:.3g} % of the mechanism's{}\n", 100 * scale,
                     wanted > 0 ? "" : ": what this device can render (--scale)");
}

std::unique_ptr<Master> MakeHaply(const std::string& port) {
  HaplyOptions options;
  if (!port.empty()) options.port = PortOf(port, "haply:PORT", "haply:" + port);
  return std::make_unique<HaplyMaster>(options);
}

std::string CouplingReport(const CouplingChoice& choice) {
  const Vector6d& K = choice.coupling.stiffness;
  return fmt::format(
      "virtual coupling: {:.4g} N/m, {:.4g} N m/rad; inertia {:.3g} times the handle's, "
      "weight at the hand {:.3g} N\n",
      K[0], K[3], choice.inertia_ratio, choice.weight);
}

Rendering MakeCoupled(const RenderingRequest& request, const KinematicTree& tree,
                      std::vector<RenderedHand> hands, const VectorXd& q) {
  CoupledTickOptions options;
  const double period = hands.front().device->period;
  options.smoothing = 2 * period;
  const auto choose = [&](const RenderedHand& hand, double scale) {
    return ChooseCoupling(tree, GraspFrameOf(tree, hand.grasp), q, *hand.device, options.smoothing,
                          scale);
  };
  options.scale = request.scale;
  if (request.scale == 0) {
    options.scale = 1;
    for (const RenderedHand& hand : hands) {
      options.scale = std::min(options.scale, choose(hand, 0).scale);
    }
  }
  std::vector<CoupledHand> coupled;
  std::string report;
  for (RenderedHand& hand : hands) {
    const CouplingChoice choice = choose(hand, options.scale);
    coupled.push_back({hand.grasp, choice.coupling});
    hand.safety = choice.Safety();
    report += CouplingReport(choice);
  }
  report += ScaleReport(options.scale, request.scale);
  for (size_t i = 0; i < hands.size(); ++i) {
    hands[i].promise = {true, false, options.scale, 1,
                        AtTheMechanism(coupled[i].coupling, options.scale)};
  }
  auto tick = std::make_unique<CoupledTick>(tree, coupled, q, period, options);
  return {std::move(tick), std::move(hands), std::move(report)};
}

ContactKind ParseContact(const std::string& word) {
  if (word == "linear") return ContactKind::kLinear;
  if (word == "viscoelastic") return ContactKind::kViscoelastic;
  if (word == "hunt-crossley") return ContactKind::kHuntCrossley;
  throw OptionError(
      fmt::format("--contact: {} is not one of linear, viscoelastic, hunt-crossley", Quoted(word)));
}

EstimatorKind ParseEstimator(const std::string& word) {
  if (word == "observer") return EstimatorKind::kObserver;
  if (word == "kalman") return EstimatorKind::kKalman;
  if (word == "parabola") return EstimatorKind::kQuadraticFit;
  if (word == "window") return EstimatorKind::kAdaptiveWindow;
  if (word == "differences") return EstimatorKind::kFiniteDifferences;
  throw OptionError(
      fmt::format("--estimator: {} is not one of observer, kalman, parabola, window, differences",
                  Quoted(word)));
}

WrenchRule ParseWrench(const std::string& word) {
  if (word == "workless") return WrenchRule::kWorkless;
  if (word == "paper") return WrenchRule::kPaper;
  throw OptionError(fmt::format("--wrench: {} is not one of workless, paper", Quoted(word)));
}

Rendering MakePaper(const RenderingRequest& request, const KinematicTree& tree,
                    std::vector<RenderedHand> hands, const VectorXd& q) {
  if (hands.size() > 1) {
    throw OptionError(
        "--coupling paper: answers the acceleration of one hand; hold in two hands with "
        "--coupling virtual");
  }
  RenderedHand& hand = hands.front();
  const DeviceInfo& device = *hand.device;
  const int grasp = hand.grasp;
  const PaperChoice choice =
      ChoosePaper({request.scale, request.stiffness, request.inertia, ParseContact(request.contact),
                   ParseEstimator(request.estimator), ParseWrench(request.wrench)},
                  tree, grasp, q, device);
  const MechanismTickOptions& options = choice.tick;
  std::string report = fmt::format(
      "the paper's way: constraint {:.4g} N/m, {:.4g} N m/rad; inertia {:.3g} times the handle's "
      "here, ",
      options.law.stiffness[0], options.law.stiffness[3], choice.inertia_ratio);
  report += request.inertia > 0 ? fmt::format("{:.3g} % of it felt", 100 * request.inertia)
                                : fmt::format("felt up to {:.3g}", options.inertia_ratio);
  report += fmt::format("; weight at the hand {:.3g} N\n", choice.weight.head<3>().norm());
  report += ScaleReport(options.scale, request.scale);
  SessionPromise promise{true, true, options.scale, 1, {}};
  const GraspKind kind = tree.mechanism.grasps[grasp].kind;
  promise.coupling.stiffness = RowsThatCount(options.law.stiffness / options.scale, kind);
  promise.coupling.damping = RowsThatCount(options.law.damping / options.scale, kind);
  promise.roll_off = options.LagOfInertia();
  hand.safety = choice.safety;
  hand.observer = choice.observer;
  hand.promise = promise;
  auto tick = std::make_unique<MechanismTick>(tree, grasp, q, device, options);
  return {std::move(tick), std::move(hands), std::move(report)};
}

/// @throws OptionError naming those that there are.
int NamedGrasp(const Mechanism& mechanism, const std::string& grasp) {
  const int index = FindGrasp(mechanism, grasp);
  if (index >= 0) return index;
  std::vector<std::string> names;
  for (const Grasp& g : mechanism.grasps) names.push_back(g.name);
  throw OptionError(fmt::format("--grasp: there is no grasp {}{}; there are {}", Quoted(grasp),
                                DidYouMean(grasp, names), fmt::join(names, ", ")));
}

}  // namespace

Rendering MakeRendering(const RenderingRequest& request, const KinematicTree& tree,
                        std::vector<RenderedHand> hands, const VectorXd& q) {
  const bool paper = request.coupling == "paper";
  return (paper ? MakePaper : MakeCoupled)(request, tree, std::move(hands), q);
}

HapticSubject ReadSubject(const std::filesystem::path& file, const std::vector<std::string>& grasps,
                          const std::vector<std::string>& set) {
  HapticSubject subject = ReadWithSettings(set, [&](auto settings) {
    if (KindOfFile(file) == FileKind::kStudy) return ReadHeldStudy(file, settings);
    const Taken taken{"haptic", {FileKind::kMechanism, FileKind::kStudy}};
    return HapticSubject{
        ReadAs(taken, file, [&](const auto& path) { return ReadMechanism(path, settings); }),
        {0},
        {}};
  });
  if (subject.mechanism.grasps.empty()) {
    throw FileErrors(file.string(), "no grasps: give the mechanism one (docs/file-format.md)");
  }
  if (!grasps.empty()) subject.grasps.clear();
  for (const std::string& grasp : grasps) {
    const int index = NamedGrasp(subject.mechanism, grasp);
    const std::vector<int>& taken = subject.grasps;
    if (std::find(taken.begin(), taken.end(), index) != taken.end()) {
      throw OptionError(fmt::format("--grasp: {} is held by another hand already; name two grasps",
                                    Quoted(grasp)));
    }
    subject.grasps.push_back(index);
  }
  return subject;
}

Matrix3d DeviceAxes(const Mechanism& mechanism) {
  const Vector3d& g = mechanism.gravity_W;
  const Vector3d up = g.norm() > 0 ? Vector3d(-g.normalized()) : Vector3d::UnitZ();
  const bool along_x = std::abs(up.x()) > 0.9;
  return AxesFromZX(up, along_x ? Vector3d::UnitY() : Vector3d::UnitX());
}

Grip ParseGrip(const std::string& word) {
  if (word == "absent") return Grip::kAbsent;
  if (word == "light") return Grip::kLight;
  if (word == "relaxed") return Grip::kRelaxed;
  if (word == "firm") return Grip::kFirm;
  throw OptionError(
      fmt::format("--grip: {} is not one of absent, light, relaxed, firm", Quoted(word)));
}

bool ForcesAlone(const DeviceInfo& device) {
  return device.takes_wrench && device.linear.peak > 0 && device.angular.peak == 0;
}

std::unique_ptr<Master> MakeMaster(const MasterRequest& request) {
  const std::string& word = request.word;
  if (word == "simulated") return MakeSimulated(request);
  if (word == "haply") return MakeHaply("");
  if (const auto port = AfterMark(word, "haply:")) return MakeHaply(*port);
  if (word == "spacenav") return std::make_unique<SpacenavMaster>();
  if (const auto file = AfterMark(word, "replay:")) {
    return std::make_unique<ReplayMaster>(
        UsingFile("--master", [&] { return ReadRecording(*file); }));
  }
  if (const auto address = AfterMark(word, "udp:")) return MakeUdp(*address);
  if (const auto plugin = AfterMark(word, "plugin:")) return MakePlugin(*plugin);
  throw OptionError(
      fmt::format("--master: {} is not one of simulated, haply[:PORT], spacenav, replay:FILE, "
                  "udp:HOST:PORT, plugin:LIBRARY[:PARAMETERS]",
                  Quoted(word)));
}

HandlePhysics ParseHandle(const std::vector<std::string>& words) {
  HandlePhysics handle;
  const std::map<std::string, double HandlePhysics::*, std::less<>> figures{
      {"mass", &HandlePhysics::mass},       {"damping", &HandlePhysics::damping},
      {"coulomb", &HandlePhysics::coulomb}, {"resolution", &HandlePhysics::resolution},
      {"peak", &HandlePhysics::peak},       {"max_speed", &HandlePhysics::max_speed}};
  for (const std::string& word : words) {
    const std::size_t equals = word.find('=');
    const auto figure = figures.find(word.substr(0, equals));
    const std::string value = equals == std::string::npos ? "" : word.substr(equals + 1);
    char* end = nullptr;
    const double number = std::strtod(value.c_str(), &end);
    if (figure == figures.end() || value.empty() || *end != 0 || !(number > 0 && number < 1e6)) {
      throw OptionError(fmt::format(
          "--handle: mass=.., damping=.., coulomb=.., resolution=.., peak=.., max_speed=.. above "
          "zero are meant, not {}",
          Quoted(word)));
    }
    handle.*(figure->second) = number;
  }
  return handle;
}

std::unique_ptr<Master> InWorkspace(const WorkspaceOptions& workspace,
                                    std::unique_ptr<Master> master) {
  if (workspace.AsItIs()) return master;
  auto placed = std::make_unique<WorkspaceMaster>(workspace, std::move(master));
  placed->Configure();
  return placed;
}

void WriteHandMotion(const std::filesystem::path& file, const Recording& recording,
                     const Matrix3d& R_WD, const Posed& X_WG) {
  std::ofstream out(file);
  out << "t,x,y,z,qw,qx,qy,qz\n";
  std::optional<Registration> registration;
  std::uint64_t first = 0, last = 0;
  for (const TickRecord& tick : recording.ticks) {
    const MasterState& state = tick.state;
    if (tick.io != IoStatus::kOk || (registration && state.sequence <= last)) continue;
    if (!registration) {
      registration = GraspedAt(R_WD, state.X_DH, X_WG);
      first = state.sequence;
    }
    last = state.sequence;
    const Posed X_WH = registration->HandInWorld(state.X_DH);
    const Eigen::Quaterniond turn(X_WH.R);
    out << fmt::format("{},{},{},{},{},{},{},{}\n",
                       static_cast<double>(last - first) * recording.period, X_WH.p.x(), X_WH.p.y(),
                       X_WH.p.z(), turn.w(), turn.x(), turn.y(), turn.z());
  }
  if (!out.flush()) {
    throw FileErrors(file.string(), "cannot be written; give another place with --motion");
  }
}

}  // namespace vmech
