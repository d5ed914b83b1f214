#include "vmech/dynamics/reactions/open_reactions.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "vmech/kinematics/loops/dimensionless_loops.h"
#include "vmech/kinematics/loops/loops.h"

namespace vmech {
namespace {

using Eigen::Index;

/// The last loop that each dependent velocity moves.
std::vector<int> LastLoops(const KinematicTree& tree, const CoordinatePartition& partition) {
  std::vector<int> last(partition.dependent.size(), -1);
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    for (const LoopColumn& c : tree.loops[l].columns) {
      const int slot = partition.dependent_slot[c.v];
      if (slot >= 0) last[slot] = static_cast<int>(l);
    }
  }
  return last;
}

Index Find(const std::vector<int>& list, int value) {
  return std::find(list.begin(), list.end(), value) - list.begin();
}

/// The slots of both lists.
std::vector<int> Union(std::vector<int> a, const std::vector<int>& b) {
  for (const int slot : b) {
    if (Find(a, slot) == std::ssize(a)) a.push_back(slot);
  }
  return a;
}

/// R [least of rows and columns, columns] of a matrix A = Q R, and Q [rows, rows] if asked for.
MatrixXd FactorQR(const MatrixXd& A, MatrixXd* Q = nullptr) {
  const Index rank = std::min(A.rows(), A.cols());
  if (rank == 0) {
    if (Q != nullptr) *Q = MatrixXd::Identity(A.rows(), A.rows());
    return MatrixXd::Zero(0, A.cols());
  }
  const Eigen::HouseholderQR<MatrixXd> qr(A);
  if (Q != nullptr) *Q = qr.householderQ();
  return qr.matrixQR().topRows(rank).triangularView<Eigen::Upper>();
}

}  // namespace

OpenReactions::OpenReactions(const KinematicTree& tree, const CoordinatePartition& partition,
                             const TreeWorkspace<double>& ws)
    : last_loop_(LastLoops(tree, partition)) {
  has_full_rank_ = Find(last_loop_, -1) == std::ssize(last_loop_);
  double longest_row = 0;  // by its sum, as the columns
  VectorXd columns = VectorXd::Zero(std::ssize(last_loop_));
  Rows handed;
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    const RowBlock block = DimensionlessLoopRows(tree, ws, l);
    Rows own;
    std::vector<int> kept;
    for (size_t k = 0; k < block.columns.size(); ++k) {
      const int slot = partition.dependent_slot[block.columns[k]];
      if (slot < 0) continue;
      own.slots.push_back(slot);
      kept.push_back(static_cast<int>(k));
    }
    own.A = block.A(Eigen::all, kept);
    columns(own.slots) += own.A.cwiseAbs().colwise().sum().transpose();
    longest_row = std::max(longest_row, own.A.cwiseAbs().rowwise().sum().maxCoeff());
    handed = TakeTurn(handed, own, l);
  }
  if (columns.size() > 0) norm_ = std::sqrt(longest_row * columns.maxCoeff());
  LookAhead();
}

OpenReactions::Rows OpenReactions::TakeTurn(const Rows& handed, const Rows& own, size_t loop) {
  Turn turn;
  turn.handed = handed.A.rows();
  std::vector<int> slots = Union(handed.slots, own.slots);
  const auto goes_on = std::stable_partition(slots.begin(), slots.end(), [&](int slot) {
    return last_loop_[slot] <= static_cast<int>(loop);
  });
  MatrixXd A = MatrixXd::Zero(handed.A.rows() + own.A.rows(), std::ssize(slots));
  for (Index k = 0; k < handed.A.cols(); ++k) {
    A.col(Find(slots, handed.slots[k])).head(handed.A.rows()) = handed.A.col(k);
  }
  for (Index k = 0; k < own.A.cols(); ++k) {
    A.col(Find(slots, own.slots[k])).tail(own.A.rows()) = own.A.col(k);
  }
  const MatrixXd R = FactorQR(A, &turn.Q);
  const Index ending = goes_on - slots.begin();
  const Index eliminated = std::min(ending, R.rows());
  has_full_rank_ = has_full_rank_ && eliminated == ending;
  turn.eliminated.assign(slots.begin(), slots.begin() + eliminated);
  turn.later.assign(slots.begin() + eliminated, slots.end());
  turn.R = R.topLeftCorner(eliminated, eliminated);
  turn.R_later = R.topRightCorner(eliminated, std::ssize(turn.later));
  turn.handed_on = R.rows() - eliminated;
  Rows rest{{goes_on, slots.end()}, {}};
  rest.A = R.bottomRightCorner(turn.handed_on, std::ssize(rest.slots));
  turns_.push_back(std::move(turn));
  return rest;
}

// What a turn is handed in x it makes open in A x, or hands on in B x to where it counts as
// |ahead B x|; of the two above one another only the triangle is kept.
void OpenReactions::LookAhead() {
  for (size_t l = turns_.size(); l-- > 1;) {
    const Turn& turn = turns_[l];
    const Index open = turn.Q.rows() - turn.R.rows() - turn.handed_on;
    const MatrixXd from_handed = turn.Q.topRows(turn.handed).transpose();
    MatrixXd seen(open + turn.ahead.rows(), turn.handed);
    seen.topRows(open) = from_handed.bottomRows(open);
    seen.bottomRows(turn.ahead.rows()) =
        turn.ahead * from_handed.middleRows(turn.R.rows(), turn.handed_on);
    turns_[l - 1].ahead = FactorQR(seen);
  }
}

VectorXd OpenReactions::LargestOpen(const std::vector<Block>& blocks) const {
  if (blocks.empty()) return {};
  const Index count = blocks.front().T.rows();
  VectorXd squared = VectorXd::Zero(count);
  MatrixXd handed = MatrixXd::Zero(turns_[blocks.front().loop].handed, count);
  auto block = blocks.begin();
  for (size_t l = blocks.front().loop; l <= blocks.back().loop; ++l) {
    const Turn& turn = turns_[l];
    MatrixXd y = turn.Q.topRows(turn.handed).transpose() * handed;
    if (block->loop == l) {
      y += turn.Q.bottomRows(turn.Q.rows() - turn.handed).transpose() * block->T.transpose();
      ++block;
    }
    const Index settled = turn.R.rows() + turn.handed_on;
    squared += y.bottomRows(y.rows() - settled).colwise().squaredNorm().transpose();
    handed = y.middleRows(turn.R.rows(), turn.handed_on);
  }
  const MatrixXd later = turns_[blocks.back().loop].ahead * handed;
  return (squared + later.colwise().squaredNorm().transpose()).cwiseSqrt();
}

/// R' y = b.
VectorXd OpenReactions::SolveTransposed(VectorXd b) const {
  for (const Turn& turn : turns_) {
    const std::vector<int>&own = turn.eliminated, &later = turn.later;
    for (size_t j = 0; j < own.size(); ++j) {
      double& y = b[own[j]];
      for (size_t i = 0; i < j; ++i) y -= turn.R(i, j) * b[own[i]];
      y /= turn.R(j, j);
      for (size_t k = 0; k < later.size(); ++k) b[later[k]] -= turn.R_later(j, k) * y;
    }
  }
  return b;
}

/// R x = b.
VectorXd OpenReactions::Solve(VectorXd b) const {
  for (auto turn = turns_.rbegin(); turn != turns_.rend(); ++turn) {
    const std::vector<int>&own = turn->eliminated, &later = turn->later;
    for (size_t j = own.size(); j-- > 0;) {
      double& x = b[own[j]];
      for (size_t k = 0; k < later.size(); ++k) x -= turn->R_later(j, k) * b[later[k]];
      for (size_t i = j + 1; i < own.size(); ++i) x -= turn->R(j, i) * b[own[i]];
      x /= turn->R(j, j);
    }
  }
  return b;
}

double OpenReactions::LeastSingularValue() const {
  if (last_loop_.empty()) return 1;
  if (!has_full_rank_) return 0;
  constexpr int kSteps = 3;
  constexpr double kGolden = 0.6180339887498949;
  VectorXd x(std::ssize(last_loop_));
  for (Index k = 0; k < x.size(); ++k) {  // without a preference for any direction
    const double turns = kGolden * static_cast<double>(k + 1);
    x[k] = turns - std::floor(turns) - 0.5;
  }
  double shrunk = 0;  // |R'R x| / |x| as it converges
  for (int step = 0; step < kSteps; ++step) {
    x.normalize();
    x = Solve(SolveTransposed(x));
    shrunk = 1 / x.norm();
  }
  return std::isfinite(shrunk) ? std::sqrt(shrunk) / norm_ : 0;
}

}  // namespace vmech
