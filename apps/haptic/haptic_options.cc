#include <CLI/CLI.hpp>

#include "vmech/apps/commands.h"
#include "vmech/apps/common_options.h"

namespace vmech {
namespace {

constexpr const char* kHapticHelp =
    "Runs a haptic simulation: a loop at the device's rate moves the mechanism with the handle "
    "and\n"
    "makes the device exert its weight, its inertia and the resistance of its joints to motions "
    "that\n"
    "they do not allow. MASTER is the device:\n"
    "  simulated       a seven-joint arm and an operator, who follows the study's hand or wanders\n"
    "  haply[:PORT]    an Inverse3 of Haply's behind their Inverse Service\n"
    "  replay:FILE     a recorded hand\n"
    "  udp:HOST:PORT   a device on another machine\n"
    "  spacenav        a 6-axis mouse behind spacenavd, without force\n"
    "  plugin:LIBRARY[:PARAMETERS]  a driver with the C entry point of hw_interface/plugin.h\n"
    "Ctrl-C ends it with the motors off. After a fault the last ticks are in <file>-fault.csv.";

constexpr const char* kReplayHelp =
    "Runs a recording of vmech haptic --record through the same loop again and prints the same\n"
    "report. With --audit nothing runs: energy, loops, wrenches and what the hand felt are "
    "computed\n"
    "from the recording alone. With --motion the hand becomes the table of a study:\n"
    "motion: {grasp: .., table: ..}";

constexpr const char* kDeviceHelp =
    "Says what a device states of itself and what it senses; MASTER as of vmech haptic. With\n"
    "--identify the device moves its handle, gently and with nobody holding it, and mass, "
    "damping,\n"
    "dry friction, delay and peak of the handle are fitted to what it did. With --serve it is the\n"
    "device of vmech haptic --master udp:HOST:PORT.";

/// How the handle moves the mechanism, and what is known of it.
void AddWorkspace(CLI::App* command, HapticArguments* haptic) {
  command
      ->add_option("--motion-scale", haptic->motion_scale,
                   "motion of the mechanism over motion of the handle; forces go the other way, so "
                   "that power stays the same")
      ->check(CLI::Range(0.01, 100.0, "0.01..100"))
      ->capture_default_str();
  command
      ->add_option("--clutch", haptic->clutch,
                   "number of the button that lets the handle move alone while it is pressed")
      ->check(CLI::Range(1, 32, "1..32"));
  command
      ->add_option("--handle", haptic->handle,
                   "mass=.. [kg], damping=.. [N s/m], coulomb=.. [N], resolution=.. [m], peak=.. "
                   "[N], max_speed=.. [m/s]: what is known of the handle better than by the device "
                   "(vmech device --identify)")
      ->delimiter(',')
      ->type_name("FIGURES");
  command
      ->add_option(
          "--home", haptic->home,
          "draw the handle to this place before it takes hold, in the axes of the device [m]")
      ->delimiter(',')
      ->expected(3)
      ->type_name("X,Y,Z");
}

}  // namespace

void AddHaptic(CLI::App* app, HapticArguments* haptic) {
  CLI::App* command = app->add_subcommand("haptic", kHapticHelp);
  command->add_option("FILE", haptic->file, "mechanism, or study with a hand")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("--grasp", haptic->grasps,
                   "the grasp by which it is held (default: the study's, or the first)")
      ->type_name("NAME")
      ->allow_extra_args(false);
  command
      ->add_option("--master", haptic->masters,
                   "the device; given twice, with two grasps: the mechanism is held in two hands")
      ->type_name("MASTER")
      ->allow_extra_args(false)
      ->default_str("simulated");
  command
      ->add_option(
          "--grip", haptic->grips,
          "grip of the simulated operator: absent, light, relaxed, firm; or of each of two")
      ->type_name("WORD")
      ->allow_extra_args(false)
      ->default_str("relaxed");
  command->add_option("--rate", haptic->rate, "rate of the simulated device [Hz]")
      ->check(CLI::Range(10.0, 1e5, "10..1e5"))
      ->capture_default_str();
  command->add_option("--seconds", haptic->seconds, "how long [s]; 0: until Ctrl-C")
      ->check(CLI::Range(0.0, 1e6, "0..1e6"))
      ->capture_default_str();
  command
      ->add_option("--coupling", haptic->coupling,
                   "virtual: the mechanism moves by itself, on a spring at the hand; paper: it "
                   "follows the hand, and inertia comes from measured accelerations")
      ->check(CLI::IsMember({"virtual", "paper"}))
      ->capture_default_str();
  command
      ->add_option(
          "--scale", haptic->scale,
          "force felt over the mechanism's own (default: 1, or what the device can render)")
      ->check(CLI::Range(1e-6, 1.0, "1e-6..1"));
  command
      ->add_option("--stiffness", haptic->stiffness,
                   "paper: stiffness of the constraint [N/m] (default, and at most: what the "
                   "device can render)")
      ->check(CLI::Range(0.0, 1e7, "0..1e7"));
  command
      ->add_option("--inertia", haptic->inertia,
                   "paper: share of the inertia that is felt (default: what the device can render)")
      ->check(CLI::Range(0.0, 1.0, "0..1"));
  command
      ->add_option("--contact", haptic->contact,
                   "paper: law of the constraint: linear, viscoelastic or hunt-crossley")
      ->check(CLI::IsMember({"linear", "viscoelastic", "hunt-crossley"}))
      ->capture_default_str();
  command
      ->add_option("--estimator", haptic->estimator,
                   "paper: source of velocities and accelerations: observer (knows the arm's own "
                   "force), kalman, parabola, window or differences (the paper's)")
      ->check(CLI::IsMember({"observer", "kalman", "parabola", "window", "differences"}))
      ->capture_default_str();
  command
      ->add_option("--wrench", haptic->wrench,
                   "paper: workless: the hand carries nothing that the joints could; paper: eq. "
                   "(14) as printed")
      ->check(CLI::IsMember({"workless", "paper"}))
      ->capture_default_str();
  command->add_flag("--gripper", haptic->gripper,
                    "hold only while the device's gripper is closed, by the nearest link; the "
                    "simulated operator lets go for a second now and then");
  AddWorkspace(command, haptic);
  command->add_flag("--view", haptic->view,
                    "show the session in the browser, at an address that is printed");
  command
      ->add_option("--record", haptic->record,
                   "write every tick to this file while it runs: .mcap, else CSV")
      ->type_name("FILE");
  command->add_flag("--force", haptic->force, "write over an old recording");
  AddSet(command, &haptic->set);
  AddTolerance(command, &haptic->tolerance);
  command->add_flag("--free", haptic->free_running,
                    "in simulated time, as fast as the machine computes");
  AddQuiet(command, &haptic->quiet);
}

void AddReplay(CLI::App* app, ReplayArguments* replay) {
  CLI::App* command = app->add_subcommand("replay", kReplayHelp);
  command->add_option("RECORDING", replay->recording, "a recording of vmech haptic")
      ->required()
      ->type_name("FILE");
  command->add_option("--file", replay->file, "mechanism or study (default: that of the recording)")
      ->type_name("FILE");
  command->add_option("--motion", replay->motion, "write the hand's motion as a table")
      ->type_name("FILE");
  command
      ->add_option("--record", replay->record,
                   "write the session anew, in the newest format: .mcap, else CSV")
      ->type_name("FILE");
  command->add_flag("--force", replay->force, "write over an old recording");
  command->add_flag("--audit", replay->audit,
                    "compute from the recording alone whether its numbers hold");
  command->add_flag("--view", replay->view,
                    "show it in the browser, at the speed of the recording");
  AddQuiet(command, &replay->quiet);
}

void AddDevice(CLI::App* app, DeviceArguments* device) {
  CLI::App* command = app->add_subcommand("device", kDeviceHelp);
  command->add_option("MASTER", device->master, "the device")->required()->type_name("MASTER");
  command->add_option("--rate", device->rate, "rate of the simulated device [Hz]")
      ->check(CLI::Range(10.0, 1e5, "10..1e5"))
      ->capture_default_str();
  CLI::Option* identify = command->add_flag(
      "--identify", device->identify,
      "move the handle gently, and find its mass, damping, dry friction and delay");
  command
      ->add_option("--force", device->force,
                   "largest force on the handle [N] (default: a quarter of the peak, at most 2)")
      ->check(CLI::Range(0.01, 100.0, "0.01..100"))
      ->needs(identify);
  command
      ->add_option("--peak-to", device->peak_to,
                   "find the peak by short blows that rise to this force [N]")
      ->check(CLI::Range(0.01, 1000.0, "0.01..1000"))
      ->needs(identify);
  CLI::Option* serve =
      command
          ->add_option("--serve", device->serve,
                       "serve it to vmech haptic --master udp:HOST:PORT on another machine; 0: "
                       "any free port")
          ->check(CLI::Range(0, 65535, "0..65535"))
          ->type_name("PORT")
          ->excludes(identify);
  command
      ->add_option("--listen", device->listen,
                   "address of this machine to serve it at: others in its network can move the "
                   "device, without a password")
      ->type_name("ADDRESS")
      ->capture_default_str()
      ->needs(serve);
  command->add_flag("--free", device->free_running,
                    "in simulated time, as fast as the machine computes: for simulated devices");
}

}  // namespace vmech
