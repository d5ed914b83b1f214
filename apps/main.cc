// The vmech command: takes the command line apart and reports errors; no mathematics here.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "vmech/apps/commands.h"
#include "vmech/apps/common_options.h"
#include "vmech/apps/completion.h"
#include "vmech/apps/console/option_error.h"
#include "vmech/apps/console/printable_streams.h"
#include "vmech/apps/console/suggestion.h"
#include "vmech/apps/design/design_options.h"
#include "vmech/apps/haptic/device_options.h"
#include "vmech/apps/import_launcher.h"
#include "vmech/apps/version.h"
#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/mechanism.h"

namespace {

constexpr const char* kExitCodes =
    "Exit codes: 0 done; 1 command line; 2 a file is wrong; 3 the loops do not close or the "
    "motion\n"
    "cannot be followed; 4 done, but no bearing or design meets the requirements; 5 a defect of "
    "vmech.";

constexpr const char* kCheckHelp =
    "Says what vmech understands of a mechanism file: links, joints, loops and where they are "
    "cut,\n"
    "mobility, redundant equations, and how well the loops close. Everything that is wrong with "
    "the\n"
    "file is listed at once, as file:line:column.";

constexpr const char* kLoadsHelp =
    "Moves a mechanism as the study file says and writes the wrench at every joint, which of its\n"
    "components are certain, and the bearings that will carry it:\n"
    "  loads.csv      joint wrenches and drive forces at every pose\n"
    "  motion.csv     pose, velocity and acceleration of every link\n"
    "  joints.csv     coordinate, rate and acceleration of every freedom of every joint\n"
    "  certainty.csv  what statics determines and what it does not\n"
    "  bearings.csv   the bearing chosen at every position\n"
    "  summary.json   the figures that matter, for programs\n"
    "  report.html    the whole study as one page, to read and to pass on";

constexpr const char* kSimulateHelp =
    "Lets a mechanism move by its own dynamics, as the block `simulation` of a study says, with\n"
    "springs, friction, motors and limits, and writes what `vmech loads` writes, and:\n"
    "  energies.csv   where the energy is, what was supplied and dissipated, what is in error\n"
    "  events.csv     impacts at limits, contacts that stick and slip, coordinates reached\n"
    "Ctrl-C ends it with the results as far as it went, and exit code 3.";

constexpr const char* kCompareHelp =
    "Solves every problem of a suite by every solver, on all processors, and writes what came of "
    "it:\n"
    "  results.csv    one row per problem and solver\n"
    "  summary.json   shares of success and times, for programs\n"
    "  report.html    tables, performance profiles, accuracy, every failure with its reason\n"
    "  rows.jsonl     the rows as they came in. Stopped at any time, the same command goes on "
    "from\n"
    "                 here; with more solvers it adds theirs.\n"
    "mpirun -n 4 vmech compare ... gives the same rows.";

constexpr const char* kIkHelp =
    "Finds the pose of a mechanism that is nearest to that of a hand, with its loops closed and "
    "its\n"
    "limits kept, and says how good it is. Lengths and angles are in the units of the file.\n"
    "  vmech ik four-bar.yaml --target \"0.9 0.6 0\"\n"
    "  vmech ik arm.yaml --target \"300 0 450  0 90 0\" --grasp handle --start elbow=40";

/// The solvers in braces, as CLI11 shows choices.
std::string Solvers() {
  std::string names;
  for (const vmech::Backend backend : vmech::kAllBackends) {
    names += (names.empty() ? "{" : ",") + std::string(vmech::NameOf(backend));
  }
  return names + "}";
}

void AddIk(CLI::App* app, vmech::IkArguments* ik) {
  CLI::App* command = app->add_subcommand("ik", kIkHelp);
  vmech::IkQuestion& question = ik->question;
  command->add_option("MECHANISM", question.mechanism, "mechanism file, YAML or JSON")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("--target", question.target,
                   "pose of the hand in the world: \"x y z\", \"x y z rx ry rz\" (rotation "
                   "vector) or \"x y z qw qx qy qz\"; without a rotation that of the start; "
                   "REQUIRED")
      ->type_name("NUMBERS");
  command
      ->add_option("--grasp", question.grasp, "the grasp by which it is held (default: the first)")
      ->type_name("NAME");
  command->add_option("--solver", question.solver, "the solver: " + Solvers())
      ->type_name("NAME")
      ->capture_default_str();
  command
      ->add_option("--start", question.start,
                   "where a joint starts, which decides the branch; may be given several times")
      ->type_name("JOINT=VALUE");
  command
      ->add_option("--stiffness", question.stiffness,
                   "stiffness of the hand along and about x, y, z [N/m, N m/rad] (default: 1 "
                   "N/m and as much over the characteristic length)")
      ->type_name("NUMBERS");
  command->add_flag("--paper-rotation", question.paper_rotation,
                    "take the rotation error of the paper (sine) instead of the angle");
  command->add_flag("--no-limits", question.no_limits, "ignore the limits of joints");
  vmech::AddSet(command, &question.set);
  vmech::AddTolerance(command, &question.tolerance);
  command->add_flag("--json", ik->json, "print JSON instead of text");
}

constexpr const char* kExportHelp =
    "Writes a mechanism, YAML or JSON, for other programs, by the ending of the output:\n"
    "  .sdf          SDFormat 1.9 (Gazebo), loops and all\n"
    "  .xml, .mjcf   MuJoCo, loops as equality constraints\n"
    "  .yaml         vmech's own format\n"
    "and says what the other format cannot hold.";

void AddExport(CLI::App* app, vmech::ExportArguments* arguments) {
  CLI::App* command = app->add_subcommand("export", kExportHelp);
  command->add_option("MECHANISM", arguments->mechanism, "mechanism file, YAML or JSON")
      ->required()
      ->type_name("FILE");
  command->add_option("--out", arguments->out, "file to write")->required()->type_name("FILE");
  vmech::AddSet(command, &arguments->set);
  vmech::AddTolerance(command, &arguments->tolerance);
  command->add_flag("--dh-frames", arguments->dh_frames,
                    "draw every link in its Denavit-Hartenberg frame");
  command->add_flag("--si", arguments->si,
                    ".yaml in metres and radians instead of millimetres and degrees");
}

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

void AddHaptic(CLI::App* app, vmech::HapticArguments* haptic) {
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
  vmech::AddWorkspace(command, haptic);
  command->add_flag("--view", haptic->view,
                    "show the session in the browser, at an address that is printed");
  command
      ->add_option("--record", haptic->record,
                   "write every tick to this file while it runs: .mcap, else CSV")
      ->type_name("FILE");
  command->add_flag("--force", haptic->force, "write over an old recording");
  vmech::AddSet(command, &haptic->set);
  vmech::AddTolerance(command, &haptic->tolerance);
  command->add_flag("--free", haptic->free_running,
                    "in simulated time, as fast as the machine computes");
  command->add_flag("-q,--quiet", haptic->quiet, "print errors alone");
}

constexpr const char* kViewHelp =
    "Shows a mechanism in the browser: any link can be dragged with the mouse, joints have "
    "sliders,\n"
    "and the load of every joint is shown. The motion of a study or of a result folder is played,\n"
    "and a recording of `vmech haptic` runs again. The page is served on this machine alone\n"
    "(127.0.0.1), at an address with a random token.";

void AddView(CLI::App* app, vmech::ViewArguments* view) {
  CLI::App* command = app->add_subcommand("view", kViewHelp);
  command->add_option("FILE", view->file, "mechanism, study, result folder or recording")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("--meshes", view->meshes,
                   "folder with an STL file for every link, as `vmech import --meshes` writes it "
                   "(default: <mechanism>-meshes beside the file)")
      ->type_name("DIR");
  command->add_option("--port", view->port, "port of the page; 0: any free one")
      ->check(CLI::Range(0, 65535, "0..65535"))
      ->capture_default_str();
  vmech::AddSet(command, &view->set);
  vmech::AddTolerance(command, &view->tolerance);
}

constexpr const char* kReplayHelp =
    "Runs a recording of vmech haptic --record through the same loop again and prints the same\n"
    "report. With --audit nothing runs: energy, loops, wrenches and what the hand felt are "
    "computed\n"
    "from the recording alone. With --motion the hand becomes the table of a study:\n"
    "motion: {grasp: .., table: ..}";

void AddReplay(CLI::App* app, vmech::ReplayArguments* replay) {
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
  command->add_flag("-q,--quiet", replay->quiet, "print errors alone");
}

constexpr const char* kStrictHelp = "treat warnings as errors: exit code 2";

void AddCheck(CLI::App* app, vmech::CheckArguments* check) {
  CLI::App* command = app->add_subcommand("check", kCheckHelp);
  command->add_option("MECHANISM", check->mechanisms, "mechanism files, YAML or JSON")
      ->required()
      ->type_name("FILE");
  vmech::AddSet(command, &check->set);
  vmech::AddTolerance(command, &check->tolerance);
  command->add_flag("--dh", check->dh, "print the Denavit-Hartenberg rows as well");
  command
      ->add_option("--draw", check->draw,
                   "write a picture of the mechanism: FILE.svg, or FILE.html to turn "
                   "and zoom")
      ->type_name("FILE");
  command->add_flag("--strict", check->strict, kStrictHelp);
  command->add_flag("--json", check->json, "print JSON instead of text");
}

void AddStudyOptions(CLI::App* command, const char* results, vmech::LoadsArguments* loads) {
  command->add_option("STUDY", loads->study, "study file, YAML or JSON")
      ->required()
      ->type_name("FILE");
  command
      ->add_option(
          "--out", loads->out,
          fmt::format("folder for the results (default: <study>-{} in this folder)", results))
      ->type_name("DIR");
  command->add_option("--threads", loads->threads, "number of threads; 0: one per processor")
      ->check(CLI::Range(0, 64, "0..64"))
      ->capture_default_str();
  vmech::AddSet(command, &loads->set);
  vmech::AddTolerance(command, &loads->tolerance);
  command->add_flag("--strict", loads->strict, kStrictHelp);
  command->add_flag("-q,--quiet", loads->quiet, "print errors alone");
}

void AddLoads(CLI::App* app, vmech::LoadsArguments* loads) {
  CLI::App* command = app->add_subcommand("loads", kLoadsHelp);
  AddStudyOptions(command, "loads", loads);
  command
      ->add_option("--motion", loads->motion,
                   "result folder of vmech simulate or vmech loads, whose motion is taken in place "
                   "of the study's own")
      ->type_name("DIR");
}

constexpr const char* kModesHelp =
    "Finds where a mechanism rests under weight, springs, motors and loads, downhill from its\n"
    "start, and says whether it stays there, how fast it swings about it, how that is damped, and\n"
    "in which shapes. Dry friction and limits are left out.";

void AddModes(CLI::App* app, vmech::ModesArguments* modes) {
  CLI::App* command = app->add_subcommand("modes", kModesHelp);
  command->add_option("FILE", modes->file, "mechanism, or study with a block `simulation`")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("--out", modes->out,
                   "folder for modes.csv, and for a study of each mode, which vmech view plays")
      ->type_name("DIR");
  vmech::AddSet(command, &modes->set);
  vmech::AddTolerance(command, &modes->tolerance);
}

void AddCompare(CLI::App* app, vmech::CompareArguments* compare) {
  CLI::App* command = app->add_subcommand("compare", kCompareHelp);
  command->add_option("SUITE", compare->suite, "suite file, YAML or JSON")
      ->required()
      ->type_name("FILE");
  command->add_option("--solvers", compare->solvers, "names of solvers, by commas (default: all)")
      ->delimiter(',')
      ->type_name("NAMES");
  command
      ->add_option("--out", compare->out,
                   "folder for the results (default: <suite>-compare in this folder)")
      ->type_name("DIR");
  vmech::AddSet(command, &compare->set);
  command->add_option("--jobs", compare->jobs, "number of processes; 0: one per processor")
      ->check(CLI::Range(0, 256, "0..256"))
      ->capture_default_str();
  command->add_flag("-q,--quiet", compare->quiet, "print errors alone");
}

/// Everything that the command line can ask for.
struct Arguments {
  vmech::CheckArguments check;
  vmech::LoadsArguments loads, simulated;
  vmech::SensitivityArguments sensitivities;
  vmech::OptimiseArguments optimise;
  vmech::ModesArguments modes;
  vmech::CompareArguments compare;
  vmech::IkArguments ik;
  vmech::HapticArguments haptic;
  vmech::ReplayArguments replay;
  vmech::DeviceArguments device;
  vmech::ViewArguments view;
  vmech::ExportArguments exported;
  std::string shell;
};

constexpr const char* kCompletionHelp =
    "Prints what a shell needs to complete the words of vmech:\n"
    "  eval \"$(vmech completion bash)\"";

void AddCommands(CLI::App* app, Arguments* arguments) {
  AddCheck(app, &arguments->check);
  AddLoads(app, &arguments->loads);
  AddStudyOptions(app->add_subcommand("simulate", kSimulateHelp), "simulate",
                  &arguments->simulated);
  vmech::AddSensitivities(app, &arguments->sensitivities);
  vmech::AddOptimise(app, &arguments->optimise);
  AddModes(app, &arguments->modes);
  AddCompare(app, &arguments->compare);
  app->add_subcommand("import",
                      "Makes a mechanism file of a CAD assembly, SDFormat or URDF; see `vmech "
                      "import --help`");
  AddIk(app, &arguments->ik);
  AddHaptic(app, &arguments->haptic);
  AddReplay(app, &arguments->replay);
  vmech::AddDevice(app, &arguments->device);
  AddView(app, &arguments->view);
  AddExport(app, &arguments->exported);
  app->add_subcommand("completion", kCompletionHelp)
      ->add_option("SHELL", arguments->shell, "for which shell")
      ->required()
      ->check(CLI::IsMember({"bash"}));
  app->add_subcommand("help", "Says how a command is called: vmech help COMMAND");
}

int PrintCompletion() {
  fmt::print("{}", vmech::BashCompletion());
  return vmech::kSuccess;
}

int RunCommand(const CLI::App& app, const Arguments& arguments) {
  if (app.got_subcommand("check")) return RunCheck(arguments.check);
  if (app.got_subcommand("loads")) return RunLoads(arguments.loads);
  if (app.got_subcommand("simulate")) return RunSimulate(arguments.simulated);
  if (app.got_subcommand("sensitivities")) return RunSensitivities(arguments.sensitivities);
  if (app.got_subcommand("optimise")) return RunOptimise(arguments.optimise);
  if (app.got_subcommand("modes")) return RunModes(arguments.modes);
  if (app.got_subcommand("ik")) return RunIk(arguments.ik);
  if (app.got_subcommand("haptic")) return RunHaptic(arguments.haptic);
  if (app.got_subcommand("replay")) return RunReplay(arguments.replay);
  if (app.got_subcommand("device")) return RunDevice(arguments.device);
  if (app.got_subcommand("view")) return RunView(arguments.view);
  if (app.got_subcommand("export")) return RunExport(arguments.exported);
  if (app.got_subcommand("completion")) return PrintCompletion();
  return RunCompare(arguments.compare);
}

/// A refused command line, or help and version, which CLI11 reports in the same way.
int Refuse(const CLI::App& app, const CLI::ParseError& error,
           const std::vector<std::string>& words) {
  const bool asked = error.get_exit_code() == 0;
  const auto named = words.begin() + (asked ? std::min<ptrdiff_t>(1, words.size()) : words.size());
  const std::string suggestion = vmech::Suggestion(app, {words.begin(), named});
  if (suggestion.empty()) return app.exit(error) == 0 ? vmech::kSuccess : vmech::kBadUsage;
  fmt::print(stderr, "vmech: {}\nRun with --help for more information.\n", suggestion);
  return vmech::kBadUsage;
}

int Run(const std::vector<std::string>& words) {
  CLI::App app{"vmech: mechanisms, their motion, the loads on their joints, and bearings for them",
               "vmech"};
  app.set_version_flag("-V,--version", std::string(vmech::VersionText()));
  app.require_subcommand(1);
  app.footer(kExitCodes);
  Arguments arguments;
  AddCommands(&app, &arguments);
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::ParseError& error) {
    return Refuse(app, error, words);
  }
  const int code = RunCommand(app, arguments);
  if (std::fflush(stdout) != 0) throw vmech::FileErrors("standard output", "cannot be written");
  return code;
}

/// `vmech help COMMAND` is `vmech COMMAND --help`.
std::vector<std::string> WithoutHelpCommand(std::vector<std::string> words) {
  if (words.empty() || words[0] != "help") return words;
  if (words.size() == 1) return {"--help"};
  if (words[1] == "help" || words[1][0] == '-') return {"--help"};
  return {words[1], "--help"};
}

/// Becomes vmech-import, whose words these are.
[[noreturn]] void Import(std::vector<std::string> words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  vmech::BecomeImport(pointers.data());
}

}  // namespace

int main(int argc, char** argv) {
  vmech::PrintOnlyPrintableText();
  try {
    const std::vector<std::string> words = WithoutHelpCommand({argv + 1, argv + argc});
    if (!words.empty() && words[0] == "import") Import(words);
    return Run(words);
  } catch (const vmech::FileErrors& error) {
    fmt::print(stderr, "{}\n", error.what());
    return vmech::kBadInput;
  } catch (const vmech::OptionError& error) {
    fmt::print(stderr, "vmech: {}\nRun with --help for more information.\n", error.what());
    return vmech::kBadUsage;
  } catch (const std::invalid_argument& error) {
    fmt::print(stderr, "vmech: {}\n", error.what());
    return vmech::kBadInput;
  } catch (const std::system_error& error) {
    fmt::print(stderr, "vmech: {}\n", error.what());
    return vmech::kBadInput;
  } catch (const std::runtime_error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return vmech::kNoSolution;
  } catch (const std::exception& error) {
    fmt::print(stderr, "vmech: internal error: {}\n", error.what());
    return vmech::kInternalError;
  }
}
