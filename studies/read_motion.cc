#include "vmech/studies/read_motion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "vmech/mechanisms/freedoms.h"
#include "vmech/studies/repeated_rows.h"
#include "vmech/studies/sha256.h"

namespace vmech {
namespace {

constexpr int kMaxSteps = 10'000'000;
constexpr Unit kRpm{2 * std::numbers::pi / 60, {0, 0, -1, 1}};

/// When the poses of a study are.
struct PoseTimes {
  std::vector<double> times;
  double cycle = 0;
};

/// `steps` equal steps from begin to end. Of a motion that repeats, the end is the next beginning.
std::vector<double> EqualSteps(double begin, double end, int steps, bool repeats) {
  std::vector<double> times;
  for (int i = 0; i < steps + (repeats ? 0 : 1); ++i) {
    times.push_back(begin + (end - begin) * i / steps);
  }
  return times;
}

/// Earlier studies counted freedoms from 0; -1 if there is none of this number.
int FreedomOfNumber(const Node& freedom, size_t count) {
  const double number = freedom.Number();
  for (size_t k = 0; k < count; ++k) {
    if (number == static_cast<double>(k)) return static_cast<int>(k);
  }
  return -1;
}

/// The freedom that a drive names; the only one where it names none.
int ReadFreedom(const Node& node, JointType type) {
  const std::vector<std::string> names = NamesOfFreedoms(type);
  const std::string has = fmt::format("a {} joint has {}", NameOf(type), fmt::join(names, ", "));
  const Node freedom = node["freedom"];
  if (!freedom) {
    if (names.size() > 1) node.KeyError("the key 'freedom' is missing: " + has);
    return 0;
  }
  if (freedom.IsNumber()) {
    const int numbered = FreedomOfNumber(freedom, names.size());
    if (numbered < 0) freedom.Error("freedoms have names: " + has);
    return std::max(numbered, 0);
  }
  const std::string name = freedom.Text();
  const int found = FindFreedom(type, name);
  if (found >= 0) return found;
  if (freedom.kind() == Node::Kind::kScalar) {
    freedom.Error(fmt::format("there is no freedom {}: {}", Quoted(name), has));
  }
  return 0;
}

/// How long a drive at constant speed runs: so many turns, or a duration.
PoseTimes ReadRun(const Node& node, bool rotates, double speed, const Units& units) {
  const Node turns = node["turns"], duration = node["duration"], steps = node["steps"];
  if (!turns == !duration) node.KeyError("give either 'turns' or 'duration'");
  if (!steps) node.KeyError("the key 'steps' is missing: the number of steps from pose to pose");
  double time = duration.Positive(units.time, 1);
  bool repeats = false;
  if (turns) {
    if (!rotates) turns.KeyError("this freedom is a translation; give the 'duration'");
    if (speed == 0) turns.KeyError("a drive that stands still makes no turns; give the 'duration'");
    const double count = turns.Positive(1);
    repeats = count == std::floor(count);
    if (speed != 0) time = count * 2 * std::numbers::pi / std::abs(speed);
  }
  const int count = steps.Integer(1, 1, kMaxSteps);
  return {EqualSteps(0, time, count, repeats), repeats ? time : 0};
}

/// The poses of a table: its rows, or `steps` equal steps over it. It repeats if it is said to.
PoseTimes ReadTableRun(const Node& node, const std::vector<double>& times, bool closed) {
  const Node steps = node["steps"];
  const bool repeats = node["repeats"].Boolean(false);
  if (repeats && (!closed || times.size() < 2)) {
    node["repeats"].Error("the table does not end where it began, so that it cannot repeat");
  }
  PoseTimes poses{times, repeats ? times.back() - times.front() : 0};
  if (steps) {
    const int count = steps.Integer(1, 1, kMaxSteps);
    poses.times = EqualSteps(times.front(), times.back(), count, repeats);
  } else if (repeats) {
    poses.times.pop_back();
  }
  return poses;
}

std::vector<double> Scaled(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

/// Are the values equal, as figures of a table are that are meant to be?
bool SameFigure(double a, double b) {
  constexpr double kFigures = 1e-6;  // relative; tables are often printed with six digits
  return std::abs(a - b) <= kFigures * std::max({1e-3, std::abs(a), std::abs(b)});
}

/// Is a table the same again after each cycle of the study?
bool FillsCycle(const std::vector<double>& times, bool closed, double cycle) {
  return closed && cycle > 0 && SameFigure(times.back() - times.front(), cycle);
}

/// A drive from a table with the columns t, value. `cycle` is that of the study, if a drive before
/// this one has set it, else 0.
void ReadTableDrive(const Node& node, double unit, const Units& units,
                    const std::filesystem::path& folder, double cycle, JointDrive* drive,
                    PoseTimes* poses) {
  for (const char* key : {"turns", "duration"}) {
    if (const Node extra = node[key]) extra.KeyError("not used with a table, which has its times");
  }
  const CsvTable table = ReadTable(node["table"], folder);
  if (table.rows() == 0 || !CheckColumns(node["table"], table, {"t", "value"}, {})) return;
  const std::vector<double> times = Scaled(*table.Find("t"), units.time);
  const std::vector<double> values = Scaled(*table.Find("value"), unit);
  try {
    drive->law = MotionLaw::Table(times, values);
  } catch (const std::invalid_argument& defect) {
    ReportInTable(node["table"], table, -1, defect.what());
    return;
  }
  const bool closed = SameFigure(values.front(), values.back());
  *poses = ReadTableRun(node, times, closed);
  if (!FillsCycle(times, closed, cycle > 0 ? cycle : poses->cycle)) return;
  const TimedRows<double> table_of_cycles = WithCyclesAround<double>({times, values});
  drive->law = MotionLaw::Table(table_of_cycles.times, table_of_cycles.rows);
}

/// One motor. `leads` is true for the first, which sets the poses.
void ReadJointDrive(const Node& node, const Units& units, const std::filesystem::path& folder,
                    bool leads, LoadStudy* study) {
  if (!node.CheckKeys({"joint"}, {"freedom", "rpm", "speed", "turns", "duration", "steps", "table",
                                  "repeats"})) {
    return;
  }
  JointDrive drive;
  if (!ReadDriven(node, study->mechanism, &drive)) return;
  const Joint& joint = study->mechanism.joints[drive.joint];
  const bool rotates = IsRotation(joint.type, drive.freedom);
  if (!!node["table"] + (node["rpm"] || node["speed"]) != 1) {
    node.KeyError("a drive needs one of 'rpm', 'speed' and 'table'");
    return;
  }
  PoseTimes poses;
  if (node["table"]) {
    const double unit = rotates ? units.angle : units.length;
    ReadTableDrive(node, unit, units, folder, study->cycle, &drive, &poses);
  } else {
    if (const Node extra = node["repeats"]) extra.KeyError("used with a table only");
    const double speed = ReadSpeed(node, rotates, units);
    drive.law = MotionLaw::Uniform(joint.start[drive.freedom], speed);
    if (leads) poses = ReadRun(node, rotates, speed, units);
  }
  study->drives.push_back(drive);
  if (!leads) {
    for (const char* key : {"turns", "duration", "steps", "repeats"}) {
      if (const Node extra = node[key])
        extra.KeyError("stated by the first drive, for all of them");
    }
    return;
  }
  study->times = std::move(poses.times);
  study->cycle = poses.cycle;
}

/// The pose in a row of a table of the hand.
Posed HandPose(const Node& node, const CsvTable& table, const Units& units, size_t row) {
  const auto value = [&](const char* name) {
    const std::vector<double>* column = table.Find(name);
    return column ? (*column)[row] : 0;
  };
  Posed X_WH;
  X_WH.p = units.length.factor * Vector3d(value("x"), value("y"), value("z"));
  if (!table.Find("qw")) return X_WH;
  const Eigen::Quaterniond q(value("qw"), value("qx"), value("qy"), value("qz"));
  if (std::abs(q.norm() - 1) > 1e-3) {
    ReportInTable(node, table, static_cast<int>(row),
                  fmt::format("a quaternion qw, qx, qy, qz has length 1, not {:.6g}", q.norm()));
  } else {
    X_WH.R = q.normalized().toRotationMatrix();
  }
  return X_WH;
}

/// A hand that leads a grasp through a table of poses.
void ReadHandDrive(const Node& node, const Units& units, const std::filesystem::path& folder,
                   LoadStudy* study) {
  if (!node.CheckKeys({"grasp", "table"}, {"steps", "repeats", "stiffness"})) return;
  HandDrive hand;
  hand.grasp = FindPart(node["grasp"], "grasp", study->mechanism.grasps);
  const std::vector<double> stiffness =
      node["stiffness"].Numbers(SixUnits(units.stiffness, units.rotational_stiffness));
  for (size_t i = 0; i < stiffness.size(); ++i) {
    hand.stiffness[i] = stiffness[i];
    if (!(stiffness[i] > 0)) node["stiffness"].Error("must be greater than zero");
  }
  if (hand.grasp < 0) return;
  const std::optional<HandTable> table =
      ReadHandTable(node["table"], units, folder, study->mechanism.grasps[hand.grasp].kind);
  if (!table) return;
  hand.law = table->law;
  PoseTimes run = ReadTableRun(node, table->times, table->closed);
  study->times = std::move(run.times);
  study->cycle = run.cycle;
  if (FillsCycle(table->times, table->closed, run.cycle)) {
    const TimedRows<Posed> cycles = WithCyclesAround<Posed>({table->times, table->poses});
    hand.law = HandLaw::Table(cycles.times, cycles.rows);
  }
  study->hand = std::move(hand);
}

}  // namespace

CsvTable ReadTable(const Node& node, const std::filesystem::path& folder) {
  const std::string name = node.Text();
  if (node.kind() != Node::Kind::kScalar) return {};
  try {
    const std::string text = ReadTextFile(folder / name, kMaxTableBytes);
    node.document().NoteNamedFile({folder / name, Sha256(text)});
    return ParseCsvTable(text, (folder / name).string());
  } catch (const FileErrors& errors) {
    for (const FileError& error : errors.errors()) node.document().Report(error);
  }
  return {};
}

void ReportInTable(const Node& node, const CsvTable& table, int row, std::string message) {
  const int line = row < 0 ? table.names_line : table.lines[row];
  node.document().Report({table.file, line, 1, "", std::move(message)});
}

bool CheckColumns(const Node& node, const CsvTable& table, const std::vector<std::string>& required,
                  const std::vector<std::string>& optional) {
  bool ok = true;
  std::vector<std::string> known = required;
  known.insert(known.end(), optional.begin(), optional.end());
  for (const std::string& name : required) {
    if (table.Find(name)) continue;
    ReportInTable(node, table, -1, fmt::format("the column '{}' is missing", name));
    ok = false;
  }
  for (const std::string& name : table.names) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    std::string hint = DidYouMean(name, known);
    if (hint.empty()) hint = fmt::format("; known here: {}", fmt::join(known, ", "));
    ReportInTable(node, table, -1, "unknown column " + Quoted(name) + hint);
    ok = false;
  }
  return ok;
}

namespace {

std::vector<Node> DrivesOf(const Node& motion) {
  if (motion.kind() == Node::Kind::kList) return motion.List();
  return {motion};
}

}  // namespace

bool ReadDriven(const Node& node, const Mechanism& mechanism, JointDrive* drive, bool balls) {
  drive->joint = FindPart(node["joint"], "joint", mechanism.joints);
  if (drive->joint < 0) return false;
  const JointType type = mechanism.joints[drive->joint].type;
  const bool ball = type == JointType::kSpherical;
  if (FreedomsOf(type) == 0 || (ball && !balls)) {
    node["joint"].Error(fmt::format("a {} joint has no {}; name another one", NameOf(type),
                                    ball ? "single coordinates" : "freedom"));
    return false;
  }
  drive->freedom = ReadFreedom(node, type);
  return true;
}

double ReadSpeed(const Node& node, bool rotates, const Units& units) {
  const Node rpm = node["rpm"], speed = node["speed"];
  if (rpm && speed) speed.KeyError("give either 'rpm' or 'speed'");
  if (rpm && !rotates) rpm.KeyError("this freedom is a translation; give its 'speed'");
  if (rpm) return rpm.Figure(kRpm, 1) * 2 * std::numbers::pi / 60;
  return speed.Number(rotates ? units.angular_velocity : units.velocity, 1);
}

std::optional<HandTable> ReadHandTable(const Node& node, const Units& units,
                                       const std::filesystem::path& folder, GraspKind kind) {
  const CsvTable table = ReadTable(node, folder);
  if (table.rows() == 0) return std::nullopt;
  std::vector<std::string> required{"t", "x", "y", "z"};
  if (kind == GraspKind::kRigid || table.Find("qw")) {
    required.insert(required.end(), {"qw", "qx", "qy", "qz"});
  }
  if (!CheckColumns(node, table, required, {})) return std::nullopt;
  std::vector<Posed> poses;
  for (size_t i = 0; i < table.rows(); ++i) poses.push_back(HandPose(node, table, units, i));
  HandTable hand;
  hand.poses = poses;
  hand.times = Scaled(*table.Find("t"), units.time);
  try {
    hand.law = HandLaw::Table(hand.times, poses);
  } catch (const std::invalid_argument& defect) {
    ReportInTable(node, table, -1, defect.what());
    return std::nullopt;
  }
  const Posed &first = poses.front(), &last = poses.back();
  hand.closed = first.p.isApprox(last.p, 1e-6) && first.R.isApprox(last.R, 1e-6);
  return hand;
}

void ReadFollowingDrive(const Node& node, const Units& units, const std::filesystem::path& folder,
                        LoadStudy* study) {
  ReadJointDrive(node, units, folder, false, study);
}

bool IsRotation(JointType type, int freedom) {
  return FreedomsOfType(type).rotates[freedom];
}

void ReadMotion(const Node& node, const Units& units, const std::filesystem::path& folder,
                LoadStudy* study) {
  if (!node) return;
  if (node.kind() == Node::Kind::kScalar) {
    node.Word<bool>({{kStill, true}}, true);
    study->times = {0};
    return;
  }
  if (node.kind() == Node::Kind::kMap && node["grasp"]) {
    ReadHandDrive(node, units, folder, study);
    return;
  }
  const std::vector<Node> drives = DrivesOf(node);
  if (drives.empty()) node.Error("name at least one drive");
  for (size_t i = 0; i < drives.size(); ++i) {
    ReadJointDrive(drives[i], units, folder, i == 0, study);
  }
}

std::vector<std::string> NotesOnFreedoms(const Node& node, const LoadStudy& study) {
  std::vector<std::string> notes;
  const std::vector<Node> drives = DrivesOf(node);
  for (size_t k = 0; k < study.drives.size() && k < drives.size(); ++k) {
    const Node freedom = drives[k]["freedom"];
    if (!freedom || !freedom.IsNumber()) continue;
    const Joint& joint = study.mechanism.joints[study.drives[k].joint];
    notes.push_back(fmt::format("freedom {} of joint '{}' is called {} now: write `freedom: {}`",
                                study.drives[k].freedom, joint.name,
                                NameOfFreedom(joint.type, study.drives[k].freedom),
                                NameOfFreedom(joint.type, study.drives[k].freedom)));
  }
  return notes;
}

std::string MotionInWords(const Node& node, const LoadStudy& study) {
  if (node.kind() == Node::Kind::kScalar) return "at rest";
  std::string words;
  const std::vector<Node> drives = DrivesOf(node);
  for (size_t k = 0; k < drives.size(); ++k) {
    const Node& drive = drives[k];
    if (!words.empty()) words += "; ";
    words += drive["grasp"] ? "a hand at " + drive["grasp"].Text() : drive["joint"].Text();
    if (drive["freedom"]) {
      const JointDrive& driven = study.drives[k];
      words += "." + NameOfFreedom(study.mechanism.joints[driven.joint].type, driven.freedom);
    }
    if (drive["rpm"]) words += fmt::format(" at {:g} rpm", drive["rpm"].Figure(kRpm));
    if (drive["speed"]) words += " at constant speed";
    if (drive["table"]) words += " through " + drive["table"].Text();
    if (drive["turns"])
      words += fmt::format(", {:g} {}", drive["turns"].Number(),
                           drive["turns"].Number() == 1 ? "turn" : "turns");
  }
  return words;
}

}  // namespace vmech
