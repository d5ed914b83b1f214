#include "vmech/apps/haptic/device_options.h"

#include <CLI/CLI.hpp>

#include "vmech/apps/console/number_within.h"

namespace vmech {
namespace {

constexpr const char* kDeviceHelp =
    "Says what a device states of itself and what it senses; MASTER as of vmech haptic. With\n"
    "--identify the device moves its handle, gently and with nobody holding it, and mass, "
    "damping,\n"
    "dry friction, delay and peak of the handle are fitted to what it did. With --serve it is the\n"
    "device of vmech haptic --master udp:HOST:PORT.";

}  // namespace

void AddWorkspace(CLI::App* command, HapticArguments* haptic) {
  command
      ->add_option("--motion-scale", haptic->motion_scale,
                   "motion of the mechanism over motion of the handle; forces go the other way, so "
                   "that power stays the same")
      ->check(NumberWithin(0.01, 100.0, "0.01..100"))
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
      ->check(NumberWithin(-100, 100, "-100..100"))
      ->type_name("X,Y,Z");
}

void AddDevice(CLI::App* app, DeviceArguments* device) {
  CLI::App* command = app->add_subcommand("device", kDeviceHelp);
  command->add_option("MASTER", device->master, "the device")->required()->type_name("MASTER");
  command->add_option("--rate", device->rate, "rate of the simulated device [Hz]")
      ->check(NumberWithin(10.0, 1e5, "10..1e5"))
      ->capture_default_str();
  CLI::Option* identify = command->add_flag(
      "--identify", device->identify,
      "move the handle gently, and find its mass, damping, dry friction and delay");
  command
      ->add_option("--force", device->force,
                   "largest force on the handle [N] (default: a quarter of the peak, at most 2)")
      ->check(NumberWithin(0.01, 100.0, "0.01..100"))
      ->needs(identify);
  command
      ->add_option("--peak-to", device->peak_to,
                   "find the peak by short blows that rise to this force [N]")
      ->check(NumberWithin(0.01, 1000.0, "0.01..1000"))
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
