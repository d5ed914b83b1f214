#include "vmech/apps/haptic/recording_page.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "vmech/apps/view/scene.h"
#include "vmech/apps/view/view_page.h"
#include "vmech/hw_interface/audit/felt.h"
#include "vmech/hw_interface/audit/recorded_tree.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"
#include "vmech/kinematics/tree/link_poses.h"

namespace vmech {
namespace {

std::string StateOf(const RecordingReader& reader) {
  std::string text;
  if (!reader.complete()) text += "note: the recording was cut short: it has no last line\n";
  if (reader.lost() > 0) text += fmt::format("note: {} ticks are missing in it\n", reader.lost());
  return text;
}

void Append(const Vector6d& w, std::vector<float>* floats) {
  for (const double value : w) floats->push_back(static_cast<float>(value));
}

/// One instant of a recording, as the page has it.
struct PageRow {
  double time = 0;
  std::vector<float> poses, coordinates, wrenches, hands;
  EnergyBalance energy;
  double closure = 0;
};

/// Rows of a recording of any length, evenly spread: when there are too many, every second goes.
class PageRows {
 public:
  PageRows(const RecordedTree& held, double period)
      : held_(held), period_(period), now_(held.tree.mechanism) {}

  void Take(const TickRecord& tick, const RecordingAudit& audit) {
    constexpr std::size_t kMost = 4000;
    const double time = static_cast<double>(ticks_++) * period_;
    if (!audit.started()) return;
    last_ = {time, tick, audit.energy(), audit.closure()};
    if (rows_.size() == kMost) {
      for (std::size_t i = 1; 2 * i < kMost; ++i) rows_[i] = std::move(rows_[2 * i]);
      rows_.resize(kMost / 2);
      every_ *= 2;
    }
    if (seen_++ % every_ == 0) rows_.push_back(RowOf(last_));
  }

  /// With the last tick, if it is not among them.
  RecordedMotion Motion() {
    if (!rows_.empty() && rows_.back().time < last_.time) rows_.push_back(RowOf(last_));
    RecordedMotion motion;
    const std::size_t hands = held_.grasp_indices.size();
    for (const int grasp : held_.grasp_indices) motion.hands.push_back({grasp, {}});
    for (const PageRow& row : rows_) {
      motion.times.push_back(row.time);
      const auto append = [](const std::vector<float>& from, std::vector<float>* to) {
        to->insert(to->end(), from.begin(), from.end());
      };
      append(row.poses, &motion.poses);
      append(row.coordinates, &motion.coordinates);
      append(row.wrenches, &motion.wrenches);
      for (std::size_t i = 0; i < hands; ++i) {
        const auto begin = row.hands.begin() + static_cast<std::ptrdiff_t>(6 * i);
        motion.hands[i].wrenches.insert(motion.hands[i].wrenches.end(), begin, begin + 6);
      }
    }
    motion.charts = Charts();
    return motion;
  }

 private:
  struct Instant {
    double time = 0;
    TickRecord tick;
    EnergyBalance energy;
    double closure = 0;
  };

  PageRow RowOf(const Instant& at) {
    PageRow row;
    row.time = at.time;
    row.energy = at.energy;
    row.closure = at.closure;
    const TickPicture& picture = at.tick.picture;
    for (const Posed& X_WL : LinkPoses(held_.tree, picture.q)) {
      for (const double value : SevenOf(X_WL)) row.poses.push_back(static_cast<float>(value));
    }
    SetStarts(held_.tree, picture.q, &now_);
    for (const double value : StartOfFreedoms(now_)) {
      row.coordinates.push_back(static_cast<float>(value));
    }
    for (const Wrenchd& w : picture.joints) {
      Append(Stacked<double>(w.force, w.moment), &row.wrenches);
    }
    for (std::size_t i = 0; i < held_.grasp_indices.size(); ++i) {
      const HandPicture& hand = picture.hand(static_cast<int>(i));
      Append(hand.dynamic + hand.constraint, &row.hands);
    }
    return row;
  }

  template <typename ValueOf>
  RecordedMotion::Series SeriesOf(const char* name, const ValueOf& value) const {
    RecordedMotion::Series series{name, {}};
    for (const PageRow& row : rows_) series.values.push_back(static_cast<float>(value(row)));
    return series;
  }

  std::vector<RecordedMotion::Chart> Charts() const {
    const auto energy = [this](const char* name, double EnergyBalance::*part) {
      return SeriesOf(name, [part](const PageRow& row) { return row.energy.*part; });
    };
    return {{"energy",
             "J",
             {energy("work of the hand", &EnergyBalance::hand),
              energy("motion", &EnergyBalance::kinetic), energy("height", &EnergyBalance::weight),
              energy("joints", &EnergyBalance::joints), energy("taken", &EnergyBalance::taken),
              energy("withheld", &EnergyBalance::withheld),
              energy("not traced", &EnergyBalance::untraced)}},
            {"loops closed to",
             "of its length",
             {SeriesOf("largest error", [](const PageRow& row) { return row.closure; })}},
            {"work of constraints along free motions",
             "J",
             {energy("work", &EnergyBalance::constraint)}}};
  }

  const RecordedTree& held_;
  double period_;
  Mechanism now_;
  std::vector<PageRow> rows_;
  Instant last_;
  std::uint64_t ticks_ = 0, seen_ = 0, every_ = 1;
};

void Describe(const AuditedRecording& audited, RecordedMotion* motion) {
  const AuditReport& report = audited.report;
  motion->words = {"Verdict: " + report.Verdict() + ".", "Energy: " + report.energy.Text() + "."};
  if (!audited.felt_verdict.empty()) motion->words.push_back("Felt: " + audited.felt_verdict + ".");
  if (!audited.state.empty()) motion->words.push_back(audited.state);
  if (!report.left_out.empty()) motion->words.push_back("Not judged: " + report.left_out + ".");
  for (const AuditFinding& f : report.findings) {
    motion->findings.push_back({f.what, f.unit == "-" ? "" : f.unit, f.worst, f.bound, f.sound()});
  }
}

}  // namespace

AuditedRecording AuditRecording(
    RecordingReader* reader,
    const std::function<void(const TickRecord&, const RecordingAudit&)>& see) {
  const RecordingHeader& header = reader->header();
  const RecordedTree held(header);
  RecordingAudit audit(header);
  FeltFit felt(header, held);
  const bool one_hand = header.hands() == 1;
  TickRecord tick = header.EmptyTick();
  while (reader->Next(&tick)) {
    audit.Take(tick);
    if (one_hand) felt.Take(tick);
    if (see) see(tick, audit);
  }
  AuditedRecording audited{audit.Report(), {}, {}, StateOf(*reader)};
  if (one_hand) {
    const FeltReport told = felt.Report();
    audited.felt = told.Text() + "  verdict: " + told.Verdict() + "\n";
    audited.felt_verdict = told.Verdict();
  }
  return audited;
}

std::string RecordingPage(const std::filesystem::path& file) {
  RecordingReader reader(file);
  const RecordedTree held(reader.header());
  PageRows rows(held, reader.header().period);
  const AuditedRecording audited = AuditRecording(
      &reader,
      [&](const TickRecord& tick, const RecordingAudit& audit) { rows.Take(tick, audit); });
  RecordedMotion motion = rows.Motion();
  Describe(audited, &motion);
  Scene scene;
  scene.title = held.tree.mechanism.name;
  scene.version = VMECH_VERSION;
  scene.tree = &held.tree;
  scene.recorded = &motion;
  return ViewPage(scene.title, SceneJson(scene));
}

}  // namespace vmech
