#include "vmech/base/linear_algebra/block_null_space.h"

#include <Eigen/QR>
#include <algorithm>

#include "vmech/base/linear_algebra/linear_algebra.h"

namespace vmech {
namespace {

using Eigen::Index;

/// The last block that each column is in, -1 where there is none.
std::vector<int> LastBlocks(int columns, const std::vector<RowBlock>& blocks) {
  std::vector<int> last(columns, -1);
  for (size_t b = 0; b < blocks.size(); ++b) {
    for (const int column : blocks[b].columns) last[column] = static_cast<int>(b);
  }
  return last;
}

/// Q [rows of A, rows of A] and R of A = Q R.
struct Triangle {
  MatrixXd Q, R;
  explicit Triangle(const MatrixXd& A) : Q(MatrixXd::Identity(A.rows(), A.rows())) {
    const Index rank = std::min(A.rows(), A.cols());
    R = MatrixXd::Zero(rank, A.cols());
    if (rank == 0) return;
    const Eigen::HouseholderQR<MatrixXd> qr(A);
    Q = qr.householderQ();
    R = qr.matrixQR().topRows(rank).triangularView<Eigen::Upper>();
  }
};

}  // namespace

BlockNullSpace::BlockNullSpace(int columns, const std::vector<RowBlock>& blocks, double tolerance,
                               const std::vector<bool>& held)
    : columns_(columns), held_(held) {
  held_.resize(columns, false);
  const std::vector<int> last = LastBlocks(columns, blocks);
  Handed handed;
  for (const RowBlock& block : blocks) handed = TakeTurn(handed, block, last, tolerance);
  LookAhead();
  for (int c = 0; c < columns; ++c) {
    if (last[c] < 0 && !held_[c]) loose_.push_back(c);
  }
  dimension_ += static_cast<int>(loose_.size());
}

BlockNullSpace::Handed BlockNullSpace::TakeTurn(const Handed& handed, const RowBlock& block,
                                                const std::vector<int>& last, double tolerance) {
  Turn turn;
  turn.handed = handed.effect.cols();
  std::vector<int> known = handed.columns;
  for (const int c : block.columns) {
    if (held_[c] || std::find(known.begin(), known.end(), c) != known.end()) continue;
    turn.fresh.push_back(c);
    known.push_back(c);
  }
  const Index inputs = turn.handed + std::ssize(turn.fresh);
  MatrixXd effect = MatrixXd::Zero(std::ssize(known), inputs);
  effect.topLeftCorner(std::ssize(handed.columns), turn.handed) = handed.effect;
  effect.bottomRightCorner(std::ssize(turn.fresh), std::ssize(turn.fresh)).setIdentity();
  turn.effect = MatrixXd::Zero(std::ssize(block.columns), inputs);
  for (size_t k = 0; k < block.columns.size(); ++k) {
    const auto at = std::find(known.begin(), known.end(), block.columns[k]);
    if (at != known.end()) turn.effect.row(k) = effect.row(at - known.begin());
  }
  NullSpace free = FindNullSpace(block.A * turn.effect, tolerance);
  rank_ += free.rank;

  Handed next;
  std::vector<int> rows;
  for (size_t k = 0; k < known.size(); ++k) {
    if (last[known[k]] <= static_cast<int>(turns_.size())) continue;
    next.columns.push_back(known[k]);
    rows.push_back(static_cast<int>(k));
  }
  turn.Z = std::move(free.basis);
  if (!rows.empty()) {
    const Triangle turned((effect(rows, Eigen::all) * turn.Z).transpose());
    turn.Z *= turned.Q;
    next.effect = turned.R.transpose();
  }
  turn.handed_on = next.effect.cols();
  turn.first_settled = dimension_;
  dimension_ += static_cast<int>(turn.settled());
  turns_.push_back(std::move(turn));
  return next;
}

// Of [handed on; settled] a turn's z moves Z' z; of the two parts that later blocks move only the
// triangle is kept.
void BlockNullSpace::LookAhead() {
  for (size_t b = turns_.size(); b-- > 1;) {
    const Turn& turn = turns_[b];
    const MatrixXd from_handed = turn.Z.topRows(turn.handed).transpose();
    MatrixXd moved(turn.settled() + turn.ahead.cols(), turn.handed);
    moved.topRows(turn.settled()) = from_handed.bottomRows(turn.settled());
    moved.bottomRows(turn.ahead.cols()) =
        turn.ahead.transpose() * from_handed.topRows(turn.handed_on);
    turns_[b - 1].ahead = Triangle(moved).R.transpose();
  }
}

MatrixXd BlockNullSpace::FromCoordinates(const MatrixXd& coordinates) const {
  MatrixXd vectors = MatrixXd::Zero(columns_, coordinates.cols());
  MatrixXd handed(0, coordinates.cols());
  for (auto turn = turns_.rbegin(); turn != turns_.rend(); ++turn) {
    MatrixXd y(turn->Z.cols(), coordinates.cols());
    y.topRows(turn->handed_on) = handed;
    y.bottomRows(turn->settled()) = coordinates.middleRows(turn->first_settled, turn->settled());
    const MatrixXd inputs = turn->Z * y;
    vectors(turn->fresh, Eigen::all) = inputs.bottomRows(std::ssize(turn->fresh));
    handed = inputs.topRows(turn->handed);
  }
  vectors(loose_, Eigen::all) = coordinates.bottomRows(std::ssize(loose_));
  return vectors;
}

MatrixXd BlockNullSpace::Basis() const {
  return FromCoordinates(MatrixXd::Identity(dimension_, dimension_));
}

VectorXd BlockNullSpace::LargestOf(size_t block, const MatrixXd& T) const {
  const Turn& turn = turns_[block];
  const MatrixXd moved = T * turn.effect * turn.Z;
  const MatrixXd later = moved.leftCols(turn.handed_on) * turn.ahead;
  return (moved.rightCols(turn.settled()).rowwise().squaredNorm() + later.rowwise().squaredNorm())
      .cwiseSqrt();
}

}  // namespace vmech
