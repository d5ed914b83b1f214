#include "vmech/apps/loads/tables.h"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <atomic>
#include <functional>
#include <iterator>
#include <thread>

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/mechanisms/freedoms.h"
#include "vmech/studies/csv_table.h"

namespace vmech {
namespace {

constexpr const char* kComponents[] = {"fx", "fy", "fz", "mx", "my", "mz"};
constexpr size_t kChunk = 256;  // rows a thread writes at a time

/// A growing row of numbers.
class Row {
 public:
  explicit Row(fmt::memory_buffer* text) : text_(*text) {}
  void Add(double value) {
    if (!first_) text_.push_back(',');
    first_ = false;
    // Without the sign of a zero, which says nothing.
    fmt::format_to(std::back_inserter(text_), FMT_COMPILE("{}"), value == 0 ? 0.0 : value);
  }
  template <typename Vector>
  void AddAll(const Vector& v) {
    for (Eigen::Index i = 0; i < v.size(); ++i) Add(v[i]);
  }
  void Add(const Wrenchd& w) {
    AddAll(w.force);
    AddAll(w.moment);
  }
  void End() { text_.push_back('\n'); }

 private:
  fmt::memory_buffer& text_;
  bool first_ = true;
};

/// The rows 0..count as text, chunks of them on several threads.
std::string WriteRows(size_t count, int threads,
                      const std::function<void(size_t, Row*)>& write_row) {
  const size_t chunks = (count + kChunk - 1) / kChunk;
  std::vector<fmt::memory_buffer> texts(chunks);
  std::atomic<size_t> next{0};
  auto work = [&] {
    for (size_t c = next++; c < chunks; c = next++) {
      for (size_t i = c * kChunk; i < std::min(count, (c + 1) * kChunk); ++i) {
        Row row(&texts[c]);
        write_row(i, &row);
        row.End();
      }
    }
  };
  std::vector<std::thread> helpers;
  for (int i = 1; i < threads && static_cast<size_t>(i) < chunks; ++i) helpers.emplace_back(work);
  work();
  for (std::thread& helper : helpers) helper.join();
  std::string all;
  for (const fmt::memory_buffer& text : texts) all.append(text.data(), text.size());
  return all;
}

std::string DriveColumn(const StudyFile& file, size_t drive, const char* what) {
  const LoadStudy& study = file.study;
  if (study.drives.size() == 1) return fmt::format("drive.{}", what);
  const Joint& joint = study.mechanism.joints[study.drives[drive].joint];
  return fmt::format("drive.{}.{}", NameOfFreedom(joint, study.drives[drive].freedom), what);
}

std::string LoadsHeader(const StudyFile& file) {
  const LoadStudy& study = file.study;
  std::string header = "t";
  auto add = [&](const std::string& name) { header += "," + CsvCell(name); };
  for (size_t k = 0; k < study.drives.size(); ++k) add(DriveColumn(file, k, "position"));
  for (const Joint& joint : study.mechanism.joints) {
    for (const char* component : kComponents) add(joint.name + "." + component);
  }
  for (size_t k = 0; k < study.drives.size(); ++k) add(DriveColumn(file, k, "force"));
  if (study.hand) {
    const std::string& grasp = study.mechanism.grasps[study.hand->grasp].name;
    for (const char* component : kComponents) add(grasp + "." + component);
    add(grasp + ".distance");
  }
  return header + ",power_error\n";
}

/// Orientations of all links at all poses; of q and -q the one nearer to the pose before.
std::vector<Eigen::Vector4d> Quaternions(const LoadStudyResult& result, size_t links) {
  std::vector<Eigen::Vector4d> quaternions;
  quaternions.reserve(links * result.poses.size());
  for (const PoseLoads& pose : result.poses) {
    for (size_t l = 0; l < links; ++l) {
      const Eigen::Quaterniond q(pose.links[l].X_WL.R);
      Eigen::Vector4d wxyz(q.w(), q.x(), q.y(), q.z());
      const bool first = quaternions.size() < links;
      const double agreement = first ? wxyz[0] : wxyz.dot(quaternions[quaternions.size() - links]);
      quaternions.push_back(agreement < 0 ? Eigen::Vector4d(-wxyz) : wxyz);
    }
  }
  return quaternions;
}

}  // namespace

std::string LoadsTable(const StudyFile& file, const LoadStudyResult& result, int threads) {
  return LoadsHeader(file) + WriteRows(result.poses.size(), threads, [&](size_t i, Row* row) {
           const PoseLoads& pose = result.poses[i];
           row->Add(pose.time);
           for (const MotionSample& drive : pose.drives) row->Add(drive.position);
           for (const Wrenchd& joint : pose.joints) row->Add(joint);
           for (const DriveSample& drive : pose.drives) row->Add(drive.force);
           if (file.study.hand) {
             row->Add(pose.hand);
             row->Add(pose.hand_error);
           }
           row->Add(pose.power_error);
         });
}

std::string MotionTable(const StudyFile& file, const LoadStudyResult& result, int threads) {
  const Mechanism& mechanism = file.study.mechanism;
  std::string header = "t";
  for (size_t l = 0; l < mechanism.links.size(); ++l) {
    if (static_cast<int>(l) == mechanism.ground) continue;
    for (const char* column : {"x", "y", "z", "qw", "qx", "qy", "qz", "vx", "vy", "vz", "wx", "wy",
                               "wz", "ax", "ay", "az", "alphax", "alphay", "alphaz"}) {
      header += "," + CsvCell(mechanism.links[l].name + "." + column);
    }
  }
  const size_t links = mechanism.links.size();
  const std::vector<Eigen::Vector4d> quaternions = Quaternions(result, links);
  return header + "\n" + WriteRows(result.poses.size(), threads, [&](size_t i, Row* row) {
           row->Add(result.poses[i].time);
           for (size_t l = 0; l < links; ++l) {
             if (static_cast<int>(l) == mechanism.ground) continue;
             const LinkMotion& motion = result.poses[i].links[l];
             row->AddAll(motion.X_WL.p);
             row->AddAll(quaternions[i * links + l]);
             row->AddAll(motion.v);
             row->AddAll(motion.w);
             row->AddAll(motion.a);
             row->AddAll(motion.alpha);
           }
         });
}

std::string JointsTable(const StudyFile& file, const LoadStudyResult& result, int threads) {
  std::string header = "t";
  for (const Joint& joint : file.study.mechanism.joints) {
    for (int k = 0; k < FreedomsOf(joint.type); ++k) {
      for (const char* column : {"position", "rate", "acceleration"}) {
        header += "," + CsvCell(NameOfFreedom(joint, k) + "." + column);
      }
    }
  }
  const LoadArrays& loads = result.poses.arrays();
  return header + "\n" + WriteRows(result.poses.size(), threads, [&](size_t i, Row* row) {
           row->Add(loads.times[i]);
           const size_t first = i * loads.freedom_count();
           for (size_t k = first; k < first + loads.freedom_count(); ++k) {
             row->Add(loads.positions[k]);
             row->Add(loads.rates[k]);
             row->Add(loads.accelerations[k]);
           }
         });
}

std::string CertaintyTable(const StudyFile& file, const LoadStudyResult& result) {
  std::string text = "joint,component,verdict\n";
  for (size_t j = 0; j < result.certainty.size(); ++j) {
    for (int k = 0; k < 6; ++k) {
      text += fmt::format("{},{},{}\n", CsvCell(file.study.mechanism.joints[j].name),
                          kComponents[k], NameOf(result.certainty[j][k]));
    }
  }
  return text;
}

std::string DigestOfMechanism(const StudyFile& file) {
  for (const InputFile& input : file.inputs) {
    if (input.path == file.mechanism_path) return input.sha256;
  }
  return "";
}

std::string BearingsTable(const StudyFile& file, const StudyOutcome& outcome) {
  std::string text =
      "joint,position,designation,fits,bore,outer_diameter,width,C,C0,mean_load,peak_load,"
      "peak_static_load,life_hours,static_safety,certainty,message\n";
  for (size_t i = 0; i < outcome.bearings.size(); ++i) {
    const JointBearings& bearings = outcome.bearings[i].bearings;
    const BearingRequest& request = file.bearings[i];
    for (size_t k = 0; k < bearings.selections.size(); ++k) {
      const BearingSelection& selection = bearings.selections[k];
      const Candidate* best = selection.best();
      if (best == nullptr) continue;
      const BearingRating rating = best->rating.value_or(BearingRating{});
      const Bearing& b = best->bearing;
      text += fmt::format(
          "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n",
          CsvCell(file.study.mechanism.joints[request.joint].name),
          request.arrangement.positions[k], CsvCell(b.designation), best->fits() ? "yes" : "no",
          b.bore, b.outer_diameter, b.width, b.dynamic_rating, b.static_rating, rating.mean_load,
          rating.peak_load, rating.peak_static, rating.modified_life_hours, rating.static_safety,
          bearings.certainty == LoadCertainty::kCertain ? "certain" : "depends on the rule",
          CsvCell(selection.message));
    }
  }
  return text;
}

}  // namespace vmech
