#pragma once

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <concepts>
#include <string>
#include <string_view>
#include <vector>

#include "vmech/hw_interface/recording/recording.h"

namespace vmech {

/// Names of numbers that stand for something: the number is the index. Whatever has no name is
/// written, and may be read, as its number.
using ValueNames = std::vector<std::string>;
/// The names of the values of IoStatus.
const ValueNames& IoNames();
/// The names of the values of ForceOff.
const ValueNames& ForceOffNames();
/// The names of sets of bits of SafetyStage: "none", "ramped", "damped", "ramped+damped", ...
const ValueNames& StageNames();

/// Visits every column of a tick: the table is stated once, for all formats and both directions.
///
///   visit(name, value)                 a number; `name` is a function that makes the name
///   visit.Named(name, names, value)    a number that stands for one of the names
///
/// `Tick` is a TickRecord, const or not.
template <typename Visitor, typename Tick>
class ColumnVisit {
 public:
  /// `tick` has the shape that the header says.
  ColumnVisit(const RecordingHeader& header, Visitor* visit, Tick* tick)
      : header_(header), visit_(*visit), tick_(*tick) {}

  /// Calls `visit` with every column's name and number, in the order of a row.
  void All() {
    Sample(tick_);
    Loop(tick_);
    if (header_.format > 1) {
      Hand(tick_);
      Grasp(tick_, tick_.picture);
      Mechanism();
    }
    for (int i = 1; i < header_.hands(); ++i) {
      prefix_ = fmt::format("hand {} ", i + 1);
      Sample(tick_.of_hand(i));
      Filter(tick_.of_hand(i));
      Hand(tick_.of_hand(i));
      Grasp(tick_.of_hand(i), tick_.picture.hand(i));
    }
    prefix_.clear();
    for (size_t i = 0; i < header_.channels.size(); ++i) Channel(i);
  }

 private:
  template <typename Value>
  void One(std::string_view name, Value& value) {
    visit_([&] { return prefix_ + std::string(name); }, value);
  }
  template <typename Vector>
  void Six(std::string_view name, Vector& vector) {
    for (int i = 0; i < 6; ++i)
      visit_([&] { return fmt::format("{}{}_{}", prefix_, name, i); }, vector[i]);
  }
  template <typename Vector>
  void Point(std::string_view name, Vector& p) {
    for (int i = 0; i < 3; ++i) {
      visit_([&] { return fmt::format("{}{}_{}", prefix_, name, "xyz"[i]); }, p[i]);
    }
  }
  /// Nine numbers: they come back to the last bit.
  template <typename Matrix>
  void Exactly(std::string_view name, Matrix& R) {
    for (int i = 0; i < 9; ++i) {
      visit_([&] { return fmt::format("{}{}_{}{}", prefix_, name, "xyz"[i / 3], "xyz"[i % 3]); },
             R(i / 3, i % 3));
    }
  }
  /// A unit quaternion.
  template <typename Matrix>
  void Turn(std::string_view name, Matrix& R) {
    Eigen::Quaterniond turn(R);
    double wxyz[4] = {turn.w(), turn.x(), turn.y(), turn.z()};
    for (int i = 0; i < 4; ++i) {
      visit_([&] { return fmt::format("{}{}_{}", prefix_, name, "wxyz"[i]); }, wxyz[i]);
    }
    if constexpr (!std::is_const_v<Tick>) {
      turn = Eigen::Quaterniond(wxyz[0], wxyz[1], wxyz[2], wxyz[3]).normalized();
      R = turn.toRotationMatrix();
    }
  }
  template <typename PoseType>
  void SevenOf(const std::string& name, PoseType& X) {
    Point(name + "_p", X.p);
    Turn(name + "_q", X.R);
  }

  template <typename Record>
  void Sample(Record& record) {
    auto& state = record.state;
    One("sequence", state.sequence);
    One("device_time_ns", state.device_time_ns);
    One("host_time_ns", state.host_time_ns);
    One("valid", state.valid);
    One("buttons", state.buttons);
    One("dead_man", state.dead_man);
    One("emergency_stop", state.emergency_stop);
    One("command_echo", state.command_echo);
    Point("p", state.X_DH.p);
    if (header_.format > 1) {
      Exactly("R", state.X_DH.R);
    } else {
      Turn("orientation", state.X_DH.R);
    }
    Six("V_DH", state.V_DH);
    Six("applied", state.applied_F_Ho_D);
    for (int i = 0; i < kMaxArmJoints; ++i) {
      visit_([&] { return fmt::format("{}q_{}", prefix_, i); }, state.q[i]);
    }
    One("gripper", state.gripper_opening);
  }

  void Loop(Tick& tick) {
    Filter(tick);
    One("late_ns", tick.late_ns);
    One("compute_ns", tick.compute_ns);
    One("skipped", tick.skipped);
  }

  template <typename Record>
  void Filter(Record& record) {
    Six("wanted", record.wanted_F_Ho_D);
    Six("sent", record.sent_F_Ho_D);
    visit_.Named([&] { return prefix_ + "io"; }, IoNames(), record.io);
    visit_.Named([&] { return prefix_ + "off"; }, ForceOffNames(), record.off);
    visit_.Named([&] { return prefix_ + "stages"; }, StageNames(), record.stages);
    One("energy", record.energy);
  }

  template <typename Record>
  void Hand(Record& record) {
    One("observed", record.observed);
    Point("hand_p", record.hand.X_DH.p);
    Exactly("hand_R", record.hand.X_DH.R);
    Six("hand_V", record.hand.V_DH);
    SevenOf("X_WD", record.registration.X_WD);
    Turn("R_HK", record.registration.R_HK);
  }

  template <typename Record, typename Picture>
  void Grasp(Record& record, Picture& picture) {
    One("room_force", record.room.force);
    One("room_moment", record.room.moment);
    One("room_together", record.room.together);
    One("stored_energy", record.stored_energy);
    One("holds", picture.holds);
    SevenOf("X_WH", picture.X_WH);
    SevenOf("X_WG", picture.X_WG);
    Six("dynamic", picture.dynamic);
    Six("constraint", picture.constraint);
  }

  void Mechanism() {
    auto& picture = tick_.picture;
    const RecordedMechanism& names = header_.mechanism;
    Several("coordinate", names.coordinates, picture.q);
    Several("velocity", names.velocities, picture.v);
    for (size_t j = 0; j < names.joints.size(); ++j) {
      Three("force", "joint " + names.joints[j], picture.joints[j].force);
      Three("moment", "joint " + names.joints[j], picture.joints[j].moment);
    }
  }

  template <typename Vector>
  void Several(const char* what, const std::vector<std::string>& names, Vector& values) {
    for (size_t i = 0; i < names.size(); ++i) {
      visit_([&] { return fmt::format("{} {}", what, names[i]); },
             values[static_cast<Eigen::Index>(i)]);
    }
  }
  template <typename Vector>
  void Three(const char* what, const std::string& of, Vector& p) {
    for (int i = 0; i < 3; ++i) {
      visit_([&] { return fmt::format("{} {}_{}", of, what, "xyz"[i]); }, p[i]);
    }
  }

  void Channel(size_t i) {
    const auto name = [&] { return header_.channels[i]; };
    if (!header_.states.empty() && header_.channels[i] == "state") {
      visit_.Named(name, header_.states, tick_.channels[i]);
    } else {
      visit_(name, tick_.channels[i]);
    }
  }

  const RecordingHeader& header_;
  Visitor& visit_;
  Tick& tick_;
  std::string prefix_;  // of the columns of a hand beside the first
};

/// Hands every column of a tick to the visitor, in the order of the table.
template <typename Visitor, typename Tick>
void VisitColumns(const RecordingHeader& header, Visitor* visit, Tick* tick) {
  ColumnVisit<Visitor, Tick>(header, visit, tick).All();
}

/// What a column holds.
enum class CellKind { kNumber, kInteger, kFlag, kName };
/// A column of a recording as text.
struct Column {
  std::string name;                   ///< unique in the header line
  CellKind kind;                      ///< how its text is read
  const ValueNames* names = nullptr;  ///< of kName: what it may be
};
/// The columns of a recording, one per cell of a row. They refer to the header.
std::vector<Column> ColumnsOf(const RecordingHeader& header);

/// A row of a table, "0.1,ok,..", and the members of an object, "\"p_x\":0.1,\"io\":\"ok\",..".
void AppendRow(const RecordingHeader& header, const TickRecord& tick, std::string* text);
/// The members of an object; `columns` are those of the header.
void AppendMembers(const RecordingHeader& header, const std::vector<Column>& columns,
                   const TickRecord& tick, std::string* text);
/// Reads a row back. `tick` is an EmptyTick or any other of this recording.
/// @throws std::runtime_error naming the column and what is wrong there.
void ReadRow(const RecordingHeader& header, const std::vector<Column>& columns,
             std::string_view row, TickRecord* tick);
/// The same for the members of an object.
void ReadMembers(const RecordingHeader& header, const std::vector<Column>& columns,
                 std::string_view members, TickRecord* tick);

}  // namespace vmech
