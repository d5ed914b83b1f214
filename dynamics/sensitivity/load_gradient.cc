#include "vmech/dynamics/sensitivity/load_gradient.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "vmech/base/lanes4.h"
#include "vmech/base/tape/tape.h"
#include "vmech/base/tape/taped4.h"
#include "vmech/dynamics/loads/pose/external_loads.h"
#include "vmech/dynamics/loads/pose/pose_loads.h"
#include "vmech/dynamics/sensitivity/pose_row.h"
#include "vmech/dynamics/sensitivity/study_numbers.h"

namespace vmech {
namespace {

constexpr size_t kLanes = Lanes4::kLanes;
constexpr std::array kParts{&MotionSample::position, &MotionSample::velocity,
                            &MotionSample::acceleration};

/// Numbers in a row of StudyGradient::prescribed.
size_t PrescribedWidth(const LoadModel& model) {
  return 3 * model.drives.size() + 6 * model.external.size();
}

/// In the order of StudyGradient::constants.
std::vector<double> SlopesOfConstants(const StudyChange& change) {
  std::vector<double> slopes;
  const auto collect = [&](const Dual& number) { slopes.push_back(number.slope); };
  VisitDesign(&change.design, collect);
  for (const Vector3<Dual>& grasp : change.grasps) VisitVector(grasp, collect);
  for (const auto& table : change.prescribed.external) VisitVector(table.p_L, collect);
  return slopes;
}

/// Does what an external load exerts in its own axes go with the parameter?
bool Varies(const LoadModel& model, const StudyChange& change, size_t load) {
  const ExternalLoad::Over over = model.external[load].over;
  const PrescribedSlopes& slopes = change.prescribed;
  if (over == ExternalLoad::Over::kTime && !slopes.times.empty()) return true;
  if (over == ExternalLoad::Over::kDriveCoordinate && !slopes.drives.empty()) return true;
  bool varies = false;
  const LoadTableOf<Dual>& table = slopes.external[load];
  VisitTable(&table, [&](const Dual& number) { varies = varies || number.slope != 0; });
  return varies;
}

double SumOfLanes(const Lanes4& number) {
  return (number[0] + number[1]) + (number[2] + number[3]);
}

}  // namespace

/// The study with its numbers on a tape, those that go with no parameter as constants.
class LoadGradients::Tape {
 public:
  Tape(const LoadModel& model, const Motion& motion, std::span<const StudyChange> changes)
      : model_(model),
        motion_(motion),
        layout_(model),
        design_(DesignOf(model.tree.mechanism).cast<Taped4>()),
        varies_(PrescribedWidth(model), false),
        row_(layout_.width()) {
    on_tape_.tape = &tape_;
    on_tape_.drives.resize(model.drives.size());
    on_tape_.external.resize(model.external.size());
    for (const ExternalLoad& load : model.external) {
      on_tape_.points.push_back(load.p_L.cast<Taped4>());
    }
    for (const Grasp& grasp : model.tree.mechanism.grasps) {
      grasps_.push_back(grasp.X_LG.p.cast<Taped4>());
    }
    PutConstantsOnTape(changes);
    FindWhatVaries(changes);
    workspace_ = std::make_unique<LoadWorkspace<Taped4>>(model, design_);
    workspace_->on_tape = &on_tape_;
    poses_from_ = tape_.size();
  }

  StudyGradient Of(const LoadRows<double>& by_loads) {
    StudyGradient gradient;
    gradient.prescribed.resize(motion_.size() * varies_.size());
    const std::vector<size_t>& poses = by_loads.poses;
    for (size_t i = 0, next = 0; i < poses.size(); i = next) {
      // The last four reach back to poses that were there before, which count no more.
      const size_t first = std::min(poses[i], motion_.size() - kLanes);
      while (next < poses.size() && poses[next] < first + kLanes) ++next;
      Record(first);
      Seed(by_loads, i, next, first);
      tape_.Sweep(operations_from_);
      TakePrescribed(first, &gradient);
    }
    tape_.Rewind(poses_from_);
    tape_.Sweep(static_cast<int>(variables_) + 1);
    for (const int index : constants_) {
      gradient.constants.push_back(SumOfLanes(tape_.Take(index)));
    }
    return gradient;
  }

 private:
  void PutConstantsOnTape(std::span<const StudyChange> changes) {
    std::vector<char> moves;
    for (const StudyChange& change : changes) {
      const std::vector<double> slopes = SlopesOfConstants(change);
      moves.resize(slopes.size());
      for (size_t k = 0; k < slopes.size(); ++k) moves[k] = moves[k] || slopes[k] != 0;
    }
    const auto put = [&](Taped4& number) {
      if (moves[constants_.size()]) number = Taped4::Variable(number.value, &tape_);
      constants_.push_back(number.index);
    };
    VisitDesign(&design_, put);
    for (Vector3<Taped4>& grasp : grasps_) VisitVector(grasp, put);
    for (Vector3<Taped4>& point : on_tape_.points) VisitVector(point, put);
    variables_ = tape_.size() - 1;
  }

  void FindWhatVaries(std::span<const StudyChange> changes) {
    const size_t drives = 3 * model_.drives.size();
    for (const StudyChange& change : changes) {
      if (!change.prescribed.drives.empty()) std::fill_n(varies_.begin(), drives, true);
      for (size_t l = 0; l < model_.external.size(); ++l) {
        if (Varies(model_, change, l)) std::fill_n(&varies_[drives + 6 * l], 6, true);
      }
    }
  }

  /// Puts four poses on the tape.
  void Record(size_t first) {
    tape_.Rewind(poses_from_);
    prescribed_.clear();
    const size_t drives = model_.drives.size();
    for (size_t k = 0; k < drives; ++k) {
      for (size_t part = 0; part < kParts.size(); ++part) {
        on_tape_.drives[k][part] = Prescribed(
            [&](size_t lane) { return motion_.drives[(first + lane) * drives + k].*kParts[part]; });
      }
    }
    for (size_t l = 0; l < model_.external.size(); ++l) PrescribeLoad(first, l);
    operations_from_ = tape_.size();
    if (!EvaluatePoseLoads(model_, motion_, first, workspace_.get())) {
      RefusePose(model_, motion_, first, first);
    }
    FillRow(model_, grasps_, *workspace_, layout_, row_.data());
  }

  void PrescribeLoad(size_t first, size_t l) {
    const ExternalLoad& load = model_.external[l];
    std::array<Vector6d, kLanes> W;
    for (size_t lane = 0; lane < kLanes; ++lane) {
      W[lane] = WrenchAt(load, TableArgument(model_, load, motion_, first + lane)).Stacked();
    }
    Wrench<Taped4>& on_tape = on_tape_.external[l];
    for (Vector3<Taped4>* half : {&on_tape.force, &on_tape.moment}) {
      const int from = half == &on_tape.force ? 0 : 3;
      for (int k = 0; k < 3; ++k) {
        (*half)[k] = Prescribed([&](size_t lane) { return W[lane][from + k]; });
      }
    }
  }

  /// The next of the prescribed numbers of four poses.
  template <typename Number>
  Taped4 Prescribed(const Number& number) {
    Taped4 taped(Lanes4::Of([&](int lane) { return number(static_cast<size_t>(lane)); }));
    if (varies_[prescribed_.size()]) taped = Taped4::Variable(taped.value, &tape_);
    prescribed_.push_back(taped.index);
    return taped;
  }

  /// Rows [i, next) of what the function has for derivatives.
  void Seed(const LoadRows<double>& by_loads, size_t i, size_t next, size_t first) {
    for (size_t k = 0; k < row_.size(); ++k) {
      std::array<double, kLanes> by{};
      for (size_t at = i; at < next; ++at) by[by_loads.poses[at] - first] = by_loads.row(at)[k];
      tape_.Seed(row_[k].index,
                 Lanes4::Of([&](int lane) { return by[static_cast<size_t>(lane)]; }));
    }
  }

  void TakePrescribed(size_t first, StudyGradient* gradient) {
    for (size_t k = 0; k < prescribed_.size(); ++k) {
      const Lanes4 by = tape_.Take(prescribed_[k]);
      for (size_t lane = 0; lane < kLanes; ++lane) {
        gradient->prescribed[(first + lane) * prescribed_.size() + k] += by[static_cast<int>(lane)];
      }
    }
  }

  const LoadModel& model_;
  const Motion& motion_;
  const LoadLayout layout_;
  TapeOf<Lanes4> tape_;
  Design<Taped4> design_;
  std::vector<Vector3<Taped4>> grasps_;
  PrescribedOnTape<Taped4> on_tape_;
  std::vector<char> varies_;     // of what is prescribed at a pose: it goes with some parameter
  std::vector<int> constants_;   // on the tape, in the order of StudyGradient
  std::vector<int> prescribed_;  // of the four poses at hand
  std::unique_ptr<LoadWorkspace<Taped4>> workspace_;
  std::vector<Taped4> row_;
  int variables_ = 0;        // of the constants, which begin the tape
  int poses_from_ = 0;       // on the tape: before are numbers of the design alone
  int operations_from_ = 0;  // on the tape: before is what is prescribed
};

bool LoadGradients::Exist(const LoadModel& model, const Motion& motion) {
  return RunsInLanes(model) && motion.size() >= kLanes;
}

LoadGradients::LoadGradients(const PreparedStudy& prepared, const Motion& motion,
                             std::span<const StudyChange> changes)
    : tape_(std::make_unique<Tape>(prepared.model, motion, changes)) {}
LoadGradients::~LoadGradients() = default;

StudyGradient LoadGradients::Of(const LoadRows<double>& by_loads) {
  return tape_->Of(by_loads);
}

double SlopeAlong(const StudyChange& change, const StudyGradient& gradient, const LoadModel& model,
                  const Motion& motion) {
  const std::vector<double> slopes = SlopesOfConstants(change);
  double slope = std::inner_product(slopes.begin(), slopes.end(), gradient.constants.begin(), 0.0);
  const size_t drives = model.drives.size(), width = PrescribedWidth(model);
  const double* by = gradient.prescribed.data();
  for (size_t at = 0; at < change.prescribed.drives.size(); ++at) {
    for (size_t part = 0; part < kParts.size(); ++part) {
      slope += by[at / drives * width + 3 * (at % drives) + part] *
               (change.prescribed.drives[at].*kParts[part]);
    }
  }
  for (size_t l = 0; l < model.external.size(); ++l) {
    if (!Varies(model, change, l)) continue;
    for (size_t i = 0; i < motion.size(); ++i) {
      const Wrench<Dual> W = WrenchWithSlope(model, motion, i, l, change.prescribed);
      const double* row = by + i * width + 3 * drives + 6 * l;
      for (const Dual& component : W.Stacked()) slope += *row++ * component.slope;
    }
  }
  return slope;
}

}  // namespace vmech
