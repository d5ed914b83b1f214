#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vmech/apps/ik/ik.h"

namespace CLI {
class App;
}

namespace vmech {

/// Of every command: what it can be asked for, its options on the command line, and what runs it
/// and returns an exit code.

/// What the vmech command returns to the shell.
enum ExitCode {
  kSuccess = 0,
  kBadUsage = 1,    ///< the command line
  kBadInput = 2,    ///< a file that cannot be read, or contradicts itself
  kNoSolution = 3,  ///< loops that do not close, motion that cannot be followed
  kNotMet = 4,      ///< done, but no bearings of the catalogue do at a joint what is asked of them
  kInternalError = 5  ///< a fault of vmech
};

struct CheckArguments {
  std::vector<std::filesystem::path> mechanisms;  ///< one or several
  std::optional<double> tolerance;                ///< instead of the mechanism's own
  bool json = false;
  bool dh = false;               ///< the Denavit-Hartenberg rows as well
  bool strict = false;           ///< warnings are errors
  std::filesystem::path draw;    ///< where a picture of the only mechanism goes; empty: nowhere
  std::vector<std::string> set;  ///< parameters, "crank=60"
};
void AddCheck(CLI::App* app, CheckArguments* check);
/// Checks every file; returns the greatest of their exit codes.
int RunCheck(const CheckArguments& arguments);

struct LoadsArguments {
  std::filesystem::path study;
  std::filesystem::path out;        ///< empty: "<study>-loads" in the current folder
  std::optional<double> tolerance;  ///< instead of the mechanism's own
  bool quiet = false;
  int threads = 0;               ///< 0: all processors
  bool strict = false;           ///< warnings are errors: nothing is written
  std::vector<std::string> set;  ///< parameters, "crank=60"
  std::filesystem::path motion;  ///< a result folder, whose motion is taken; empty: the study's own
};
void AddLoads(CLI::App* app, LoadsArguments* loads);
int RunLoads(const LoadsArguments& arguments);
/// Of a study with a simulation; the default folder is "<study>-simulate".
void AddSimulate(CLI::App* app, LoadsArguments* simulated);
int RunSimulate(const LoadsArguments& arguments);

struct SensitivityArguments {
  std::filesystem::path study;
  std::vector<std::string> by, of;  ///< parameters and figures by name; empty: all
  bool undetermined = false;
  std::filesystem::path out;  ///< empty: nothing is written
  int threads = 0;            ///< 0: all processors
  bool quiet = false;
  std::vector<std::string> set;  ///< parameters, "crank=60"
};
void AddSensitivities(CLI::App* app, SensitivityArguments* arguments);
int RunSensitivities(const SensitivityArguments& arguments);

struct OptimiseArguments {
  std::filesystem::path study;
  std::string minimise, maximise;  ///< a figure by name; one of them is empty
  std::vector<std::string> vary;   ///< "crank/pin.x=40..60"
  std::vector<std::string> keep;   ///< "pin.life>=10000"
  std::string method = "slsqp";    ///< or "mma", "ipopt"
  int starts = 1;
  bool undetermined = false;
  std::filesystem::path out;  ///< empty: nothing is written
  bool resume = false;        ///< goes on with the search in `out`
  int threads = 0;            ///< 0: all processors
  bool quiet = false;
  std::vector<std::string> set;  ///< parameters, "crank=60"
};
void AddOptimise(CLI::App* app, OptimiseArguments* arguments);
int RunOptimise(const OptimiseArguments& arguments);

struct ModesArguments {
  std::filesystem::path file;       ///< mechanism, or study with a simulation
  std::filesystem::path out;        ///< for tables and studies; empty: they are not written
  std::optional<double> tolerance;  ///< instead of the mechanism's own
  std::vector<std::string> set;     ///< parameters, "crank=60"
};
void AddModes(CLI::App* app, ModesArguments* modes);
int RunModes(const ModesArguments& arguments);

struct CompareArguments {
  std::filesystem::path suite;
  std::vector<std::string> solvers;  ///< by name; empty: all
  std::filesystem::path out;         ///< empty: "<suite>-compare" in the current folder
  bool quiet = false;
  int jobs = 0;                  ///< processes; 0: as many as there are processors
  std::vector<std::string> set;  ///< parameters, "crank=60"
};
void AddCompare(CLI::App* app, CompareArguments* compare);
int RunCompare(const CompareArguments& arguments);

struct IkArguments {
  IkQuestion question;
  bool json = false;
};
void AddIk(CLI::App* app, IkArguments* ik);
int RunIk(const IkArguments& arguments);

struct ExportArguments {
  std::filesystem::path mechanism, out;
  std::optional<double> tolerance;  ///< instead of the mechanism's own
  bool si = false;               ///< .yaml: metres and radians instead of millimetres and degrees
  bool dh_frames = false;        ///< links drawn in their Denavit-Hartenberg frames
  std::vector<std::string> set;  ///< parameters, "crank=60"
};
void AddExport(CLI::App* app, ExportArguments* arguments);
int RunExport(const ExportArguments& arguments);

struct HapticArguments {
  std::filesystem::path file;  ///< of a mechanism, or of a study with a hand
  // Of every hand. The first grasp may be left out: the study's, or the mechanism's first.
  std::vector<std::string> grasps;                ///< by name
  std::vector<std::string> masters{"simulated"};  ///< see MakeMaster
  std::vector<std::string> grips{"relaxed"};      ///< of the simulated operators, as many or one
  double rate = 1000;                             ///< of the simulated master [Hz]
  double seconds = 20;                            ///< 0: until interrupted
  std::string coupling = "virtual";               ///< or "paper"
  double scale = 0;                               ///< of all forces; 0: what the device allows
  double stiffness = 0;            ///< paper: of the constraint [N/m]; 0: what the device allows
  double inertia = 0;              ///< paper: share that is felt; 0: what the device allows
  std::string contact = "linear";  ///< paper: law of the constraint, see ParseContact
  std::string estimator = "observer";  ///< paper: of the motion, see ParseEstimator
  std::string wrench = "workless";     ///< paper: rule of w_d, see ParseWrench
  bool gripper = false;                ///< hold while the gripper is closed
  double motion_scale = 1;             ///< motion of the mechanism over that of the handle
  int clutch = 0;                      ///< the button that lets the handle move alone; 0: none
  std::vector<double> home;            ///< of the handle [m]; empty: where it is
  std::vector<std::string> handle;     ///< "mass=0.3", ..: what is known of it better
  bool view = false;                   ///< shown on a page
  bool varied = true;                  ///< on which its parameters can be moved
  std::filesystem::path record;        ///< CSV or MCAP; empty: no recording
  bool force = false;                  ///< write over an old recording
  bool free_running = false;           ///< as fast as it computes
  std::optional<double> tolerance;     ///< instead of the mechanism's own
  bool post_mortem = true;             ///< write the last ticks after a fault
  bool quiet = false;
  std::vector<std::string> set;  ///< parameters, "crank=60"
};
void AddHaptic(CLI::App* app, HapticArguments* haptic);
int RunHaptic(const HapticArguments& arguments);

struct DeviceArguments {
  std::string master;                ///< as HapticArguments::master
  double rate = 1000;                ///< of the simulated master [Hz]
  bool identify = false;             ///< move it and fit what it is
  double force = 0;                  ///< that it is moved with [N]; 0: GentleForce
  double peak_to = 0;                ///< of blows that seek its peak [N]; 0: none
  bool free_running = false;         ///< as fast as it computes
  std::optional<int> serve;          ///< the UDP port that it is served at; none: it is not
  std::string listen = "127.0.0.1";  ///< address of this machine to serve it at
};
void AddDevice(CLI::App* app, DeviceArguments* device);
int RunDevice(const DeviceArguments& arguments);

struct ViewArguments {
  std::filesystem::path file;       ///< mechanism, study, result folder or recording
  std::filesystem::path meshes;     ///< of the links; empty: "<mechanism>-meshes" beside the file
  std::optional<double> tolerance;  ///< instead of the mechanism's own
  int port = 0;                     ///< 0: any free one
  std::vector<std::string> set;     ///< parameters, "crank=60"
};
void AddView(CLI::App* app, ViewArguments* view);
int RunView(const ViewArguments& arguments);

struct ReplayArguments {
  std::filesystem::path recording;  ///< of vmech haptic
  std::filesystem::path file;       ///< mechanism or study; empty: that of the recording
  std::filesystem::path motion;     ///< where the hand's motion goes as a table; empty: nowhere
  std::filesystem::path record;     ///< the session as it is now; empty: no recording
  bool force = false;               ///< write over an old recording
  bool audit = false;               ///< look at its numbers instead
  bool view = false;                ///< shown on a page, at the speed of the recording
  bool quiet = false;
};
void AddReplay(CLI::App* app, ReplayArguments* replay);
int RunReplay(const ReplayArguments& replay);

}  // namespace vmech
