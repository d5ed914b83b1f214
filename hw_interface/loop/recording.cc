#include "vmech/hw_interface/loop/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <stdexcept>
#include <string_view>

namespace vmech {
namespace {

constexpr std::string_view kFirstLine = "# vmech recording 1";
constexpr std::string_view kDevice = "# device ";
constexpr std::string_view kPeriod = "# period ";
constexpr std::string_view kNote = "note ";

/// Visits every column of a tick with its name: the table is stated once, for both directions.
/// Numbers that are not doubles pass through one.
template <typename Visitor, typename Tick>
void VisitColumns(Visitor&& visit, Tick& tick, int channels,
                  const std::vector<std::string>& channel_names) {
  auto& state = tick.state;
  visit("sequence", state.sequence);
  visit("device_time_ns", state.device_time_ns);
  visit("host_time_ns", state.host_time_ns);
  visit("valid", state.valid);
  visit("buttons", state.buttons);
  visit("dead_man", state.dead_man);
  visit("emergency_stop", state.emergency_stop);
  visit("command_echo", state.command_echo);
  for (int i = 0; i < 3; ++i) visit(fmt::format("p_{}", "xyz"[i]), state.X_DH.p[i]);
  visit("orientation", state.X_DH.R);
  const auto six = [&](std::string_view name, auto& vector) {
    for (int i = 0; i < 6; ++i) visit(fmt::format("{}_{}", name, i), vector[i]);
  };
  six("V_DH", state.V_DH);
  six("applied", state.applied_F_Ho_D);
  for (int i = 0; i < kMaxArmJoints; ++i) visit(fmt::format("q_{}", i), state.q[i]);
  visit("gripper", state.gripper_opening);
  six("wanted", tick.wanted_F_Ho_D);
  six("sent", tick.sent_F_Ho_D);
  visit("io", tick.io);
  visit("off", tick.off);
  visit("stages", tick.stages);
  visit("energy", tick.energy);
  visit("late_ns", tick.late_ns);
  visit("compute_ns", tick.compute_ns);
  visit("skipped", tick.skipped);
  for (int i = 0; i < channels; ++i) visit(channel_names[i], tick.channels[i]);
}

/// Writes the names, or the values, of one tick.
class LineWriter {
 public:
  explicit LineWriter(bool names) : names_(names) {}

  void operator()(std::string_view name, const Matrix3d& R) {
    const Eigen::Quaterniond turn(R);
    const std::array<double, 4> wxyz{turn.w(), turn.x(), turn.y(), turn.z()};
    for (int i = 0; i < 4; ++i) (*this)(fmt::format("{}_{}", name, "wxyz"[i]), wxyz[i]);
  }
  template <typename T>
  void operator()(std::string_view name, const T& value) {
    if (!line_.empty()) line_ += ',';
    if (names_) {
      line_ += name;
    } else if constexpr (std::is_enum_v<T> || std::is_same_v<T, bool>) {
      line_ += fmt::to_string(static_cast<int>(value));
    } else {
      line_ += fmt::to_string(value);
    }
  }
  const std::string& line() const { return line_; }

 private:
  bool names_;
  std::string line_;
};

/// Reads one value after the other from a line. @throws std::runtime_error without the place.
class LineReader {
 public:
  explicit LineReader(std::string_view line) : rest_(line) {}

  void operator()(std::string_view name, Matrix3d& R) {
    std::array<double, 4> wxyz;
    for (double& value : wxyz) (*this)(name, value);
    R = Eigen::Quaterniond(wxyz[0], wxyz[1], wxyz[2], wxyz[3]).normalized().toRotationMatrix();
  }
  template <typename T>
  void operator()(std::string_view name, T& value) {
    const std::string_view cell = rest_.substr(0, rest_.find(','));
    if constexpr (std::is_enum_v<T> || std::is_same_v<T, bool>) {
      value = static_cast<T>(Parse<int>(name, cell));
    } else {
      value = Parse<T>(name, cell);
    }
    rest_.remove_prefix(std::min(rest_.size(), cell.size() + 1));
  }
  std::string_view rest() const { return rest_; }

 private:
  template <typename T>
  static T Parse(std::string_view name, std::string_view cell) {
    T value{};
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error == std::errc{} && end == cell.data() + cell.size()) return value;
    throw std::runtime_error(fmt::format("column '{}': '{}' is not a number", name, cell));
  }
  std::string_view rest_;
};

std::string NameLine(const std::vector<std::string>& channels) {
  LineWriter names(true);
  const TickRecord tick;
  VisitColumns(names, tick, static_cast<int>(channels.size()), channels);
  return names.line();
}

std::vector<std::string> Split(std::string_view line) {
  std::vector<std::string> words;
  while (true) {
    const std::size_t comma = line.find(',');
    words.emplace_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return words;
    line.remove_prefix(comma + 1);
  }
}

/// The channels are the columns after those that every recording has.
std::vector<std::string> ChannelsOf(const std::string& names) {
  const std::string fixed = NameLine({});
  if (names == fixed) return {};
  if (names.rfind(fixed + ',', 0) != 0) {
    throw std::runtime_error("these are not the columns of a recording");
  }
  std::vector<std::string> channels = Split(std::string_view(names).substr(fixed.size() + 1));
  if (channels.size() <= kMaxChannels) return channels;
  throw std::runtime_error(
      fmt::format("{} channels, at most {} are possible", channels.size(), kMaxChannels));
}

std::string AfterWord(const std::string& line, std::string_view word) {
  if (line.rfind(word, 0) == 0) return line.substr(word.size());
  throw std::runtime_error(fmt::format("'{}' expected", word));
}

std::string PhysicsLine(const HandlePhysics& handle) {
  return fmt::format("{} {} {} {} {} {}", handle.mass, handle.damping, handle.coulomb,
                     handle.resolution, handle.peak, handle.max_speed);
}

HandlePhysics ReadPhysics(std::string text) {
  std::replace(text.begin(), text.end(), ' ', ',');
  HandlePhysics handle;
  LineReader reader(text);
  for (double* value : {&handle.mass, &handle.damping, &handle.coulomb, &handle.resolution,
                        &handle.peak, &handle.max_speed}) {
    reader("physics of the handle", *value);
  }
  return handle;
}

/// What stands behind "# " in one of the lines that not every recording has.
void ReadRemark(const std::string& remark, Recording* recording) {
  const std::string word = remark.substr(0, remark.find(' '));
  const std::string rest = remark.substr(std::min(remark.size(), word.size() + 1));
  if (word == "delay") {
    LineReader{rest}("delay", recording->delay);
  } else if (word == "linear") {
    recording->linear = ReadPhysics(rest);
  } else if (word == "angular") {
    recording->angular = ReadPhysics(rest);
  } else if (word == "note") {
    const std::string key = rest.substr(0, rest.find(' '));
    recording->notes.emplace_back(key, rest.substr(std::min(rest.size(), key.size() + 1)));
  } else {
    throw std::runtime_error(fmt::format("'# {}': delay, linear, angular or note expected", word));
  }
}

std::string HeaderOf(const Recording& recording) {
  std::string lines =
      fmt::format("{}\n{}{}\n{}{}\n# delay {}\n# linear {}\n# angular {}\n", kFirstLine, kDevice,
                  recording.device, kPeriod, recording.period, recording.delay,
                  PhysicsLine(recording.linear), PhysicsLine(recording.angular));
  for (const auto& [key, text] : recording.notes) {
    lines += fmt::format("# {}{} {}\n", kNote, key, text);
  }
  return lines;
}

TickRecord ReadTick(const std::string& line, const std::vector<std::string>& channels) {
  TickRecord tick;
  LineReader reader(line);
  VisitColumns(reader, tick, static_cast<int>(channels.size()), channels);
  if (!reader.rest().empty()) throw std::runtime_error("more values than columns");
  return tick;
}

}  // namespace

std::string Recording::Note(std::string_view wanted) const {
  for (const auto& [key, text] : notes) {
    if (key == wanted) return text;
  }
  return {};
}

void WriteRecording(const std::filesystem::path& file, const Recording& recording) {
  std::ofstream out(file);
  out << HeaderOf(recording) << NameLine(recording.channels) << '\n';
  for (const TickRecord& tick : recording.ticks) {
    LineWriter line(false);
    VisitColumns(line, tick, static_cast<int>(recording.channels.size()), recording.channels);
    out << line.line() << '\n';
  }
  if (!out.flush()) {
    throw std::runtime_error(fmt::format("{}: cannot be written", file.string()));
  }
}

Recording ReadRecording(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(fmt::format("{}: cannot be opened", file.string()));
  Recording recording;
  std::string line;
  int number = 0;
  const auto next = [&] {
    ++number;
    return static_cast<bool>(std::getline(in, line));
  };
  try {
    next();
    if (line != kFirstLine) throw std::runtime_error(fmt::format("'{}' expected", kFirstLine));
    next();
    recording.device = AfterWord(line, kDevice);
    next();
    const std::string text = AfterWord(line, kPeriod);
    LineReader{text}("period", recording.period);
    while (next() && line.rfind("# ", 0) == 0) ReadRemark(line.substr(2), &recording);
    recording.channels = ChannelsOf(line);
    while (next()) recording.ticks.push_back(ReadTick(line, recording.channels));
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("{}:{}: {}", file.string(), number, error.what()));
  }
  return recording;
}

}  // namespace vmech
