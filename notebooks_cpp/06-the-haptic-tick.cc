//%% [markdown]
// # The haptic tick
//
// A mechanism in the hand: a thousand times a second the device says where its handle is, and has
// to be told what to push. This chapter holds the crank of the paper in two ways, with a simulated
// arm and a simulated operator in between, and asks the question that decides: does the hand feel
// the mechanism's weight and inertia, and nothing else?

//%%
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "notebook.h"
#include "vmech/hw_interface/loop/runner.h"
#include "vmech/hw_interface/masters/simulated_master.h"
#include "vmech/hw_interface/rendering/coupled_tick.h"
#include "vmech/hw_interface/rendering/coupling_choice.h"
#include "vmech/hw_interface/rendering/mechanism_tick.h"
#include "vmech/kinematics/loops/assembly.h"
#include "vmech/mechanisms/files/reader.h"

using namespace vmech;

//%% tags=["remove-cell"]
int main(int argc, char** argv) {
  Notebook notebook(argc, argv);

  //%% [markdown]
  // ## The hand at rest
  //
  // The crank is a bar of 0.8 kg on a pin, held at its tip 0.3 m from the pin, its centre of
  // gravity half way. A hand that keeps still at 40 degrees must carry
  //
  // $$
  // F = \frac{m g l_c \cos\varphi}{l}
  // $$
  //
  // across the crank. In the paper's tick the mechanism follows the hand (eq. 7), and the force
  // comes from its equations of motion (eq. 9):

  //%%
  const Mechanism crank = ReadMechanism("mechanisms/examples/crank.yaml");
  const KinematicTree tree = BuildKinematicTree(crank);
  VectorXd q = StartCoordinates(tree);
  notebook.Check("the crank has no loop to close", Assemble(tree, {}, &q).closed);
  const int tip = FindGrasp(crank, "tip");
  DeviceInfo fine;
  fine.period = 1e-3;

  MechanismTickOptions paper;
  paper.law.stiffness << 500, 500, 500, 1, 1, 1;
  MechanismTick by_hand(tree, tip, q, fine, paper);

  CoupledTickOptions coupled;
  coupled.coupling.stiffness << 2500, 2500, 2500, 1, 1, 1;
  coupled.coupling.damping << 30, 30, 30, 0.01, 0.01, 0.01;
  CoupledTick by_itself(tree, tip, q, fine.period, coupled);

  std::vector<double> channels(kMaxChannels);
  const auto rest = [&](Tick* tick) {
    TickInput input;
    input.X_WH = tick->GraspFrame();
    input.fresh = true;
    input.elapsed = fine.period;
    TickOutput out;
    for (int k = 0; k < 3000; ++k) out = tick->Step(input, channels);
    return out.F_Ho_W;
  };
  const double weight = 0.8 * 9.81 * 0.15 * std::cos(40 * std::numbers::pi / 180) / 0.3;
  notebook.CheckNear("paper's tick, force on a hand at rest [N]", rest(&by_hand).norm(), weight,
                     1e-6);
  notebook.CheckNear("virtual coupling, the same [N]", rest(&by_itself).norm(), weight, 0.02);

  //%% [markdown]
  // The virtual coupling is the second architecture: the mechanism moves by its own equations of
  // motion, and a spring and a damper tie it to the hand. It hangs on that spring, a millimetre
  // below the hand, where the weight's lever is a little longer: hence the wider tolerance.
  //
  // ## The hand that moves
  //
  // Now an arm with 16-bit encoders, an operator who shakes the handle by a few millimetres, and no
  // weight. The paper's tick needs the hand's acceleration. The virtual coupling needs none: the
  // spring accelerates the mechanism, and its pull is the inertia. What is felt of a mass $m$ on a
  // spring $K$ at the rate $\omega$ is
  //
  // $$
  // \frac{m}{1 - \omega^2 m / K}
  // $$

  //%%
  Mechanism weightless = crank;
  weightless.gravity_W.setZero();
  const KinematicTree floating = BuildKinematicTree(weightless);
  const auto felt = [&](double hertz) {
    SimulatedMasterOptions arm;
    arm.hand = ImpedanceOf(Grip::kFirm);
    const Posed X_DH = ArmModel(std::make_shared<const ArmDescription>(SarcosMasterArm())).X_DH();
    const Vector3d radius(std::cos(q[0]), std::sin(q[0]), 0);
    const Vector3d across(-radius.y(), radius.x(), 0);
    const double rate = 2 * std::numbers::pi * hertz;
    arm.motion = [=](double t) {
      HandTargetMotion target{X_DH, Vector6d::Zero()};
      target.X_DT.p += 2e-3 * std::sin(rate * t) * across;
      target.V_DT.head<3>() = 2e-3 * rate * std::cos(rate * t) * across;
      return target;
    };
    SimulatedMaster master(arm);
    master.Configure();
    const CouplingChoice choice =
        ChooseCoupling(floating, GraspFrameOf(floating, tip), q, master.info(), 2e-3);
    CoupledTickOptions options;
    options.coupling = choice.coupling;
    CoupledTick tick(floating, tip, q, 1e-3, options);
    RunnerOptions run;
    run.seconds = 6;
    run.record = true;
    run.realtime.reset();
    run.safety = choice.Safety();
    FreeRunningClock clock;
    Runner runner(run, &master, &tick, &clock);
    notebook.Check(fmt::format("the session at {:.1f} Hz ends without a fault", hertz),
                   runner.Run().status == RunStatus::kFinished);
    double along = 0, size = 0;
    for (int phase = 0; phase < 2; ++phase) {
      double x = 0, f = 0;
      const Recording kept = runner.Kept();
      for (int k = 2000; k < 6000; ++k) {
        const double wave = phase == 0 ? std::sin(rate * k * 1e-3) : std::cos(rate * k * 1e-3);
        x += wave * across.dot(kept.ticks[k].state.X_DH.p - X_DH.p);
        f += wave * across.dot(kept.ticks[k].sent_F_Ho_D.head<3>());
      }
      along += f * x;
      size += rate * rate * x * x;
    }
    return along / size;
  };
  const double mass = (0.006 + 0.8 * 0.15 * 0.15) / (0.3 * 0.3);  // I / l^2
  plot::LinePlot inertia;
  inertia.title = "Inertia that is felt at the tip";
  inertia.x = {"frequency", "Hz"};
  inertia.y = {"felt over true", ""};
  inertia.series = {{"measured", {}, {}, plot::LineStyle::kSolid, plot::Marker::kCircle},
                    {"mass on a spring", {}, {}, plot::LineStyle::kDashed}};
  double worst = 0;
  for (const double hertz : {0.5, 1.0, 1.5, 2.0, 2.5, 3.0}) {
    const double ratio = felt(hertz) / mass;
    const double rate = 2 * std::numbers::pi * hertz;
    for (plot::Series& series : inertia.series) series.x.push_back(hertz);
    inertia.series[0].y.push_back(ratio);
    inertia.series[1].y.push_back(1 / (1 - rate * rate / (120 * 120)));  // K = m (120/s)^2
    if (hertz < 3) worst = std::max(worst, std::abs(ratio - 1));
  }
  notebook.Show(inertia);
  notebook.CheckNear("largest error of the felt inertia below 3 Hz", worst, 0, 0.05);

  //%% tags=["remove-cell"]
  return notebook.ExitCode();
}
