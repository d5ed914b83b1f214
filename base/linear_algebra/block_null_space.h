#pragma once

#include <vector>

#include "vmech/base/eigen.h"

namespace vmech {

/// Rows of a matrix of which few columns are not zero.
struct RowBlock {
  std::vector<int> columns;  ///< each once
  Eigen::MatrixXd A;         ///< [rows, columns]
};

/// Rank and null space of a matrix A that is given as blocks of rows, one block after the other:
/// the null space of the blocks so far, as an orthonormal basis N, becomes that of one more, N Z, Z
/// that of A_b N. Later blocks see of N only what it moves in their columns, so that N is turned
/// until a few of its vectors move all of that, as many as there are such columns; the others are
/// settled. A block's turn knows its own part of all this only: time and memory are linear in the
/// number of blocks where each has columns in common with a few neighbours. With a single block it
/// is FindNullSpace, to the bit.
class BlockNullSpace {
 public:
  /// Pivots that are small in the sense of FindNullSpace count as zero, block by block. A column
  /// [0, columns) that no block has is free. `held` columns are left out: theirs are zero in the
  /// null space.
  BlockNullSpace(int columns, const std::vector<RowBlock>& blocks, double tolerance,
                 const std::vector<bool>& held = {});

  int rank() const { return rank_; }            ///< of all blocks together
  int dimension() const { return dimension_; }  ///< columns - rank()
  /// Vectors of the null space [columns, n] from their coordinates in Basis() [dimension, n].
  Eigen::MatrixXd FromCoordinates(const Eigen::MatrixXd& coordinates) const;
  /// Orthonormal [columns, dimension].
  Eigen::MatrixXd Basis() const;
  /// |N' t| for each row t of T [n, columns of a block], in the block's order of columns: how much
  /// t' x can be for a vector x of the null space of unit length [n].
  Eigen::VectorXd LargestOf(size_t block, const Eigen::MatrixXd& T) const;

 private:
  /// The null space of the blocks before is moved on by coordinates z.
  struct Turn {
    std::vector<int> fresh;  ///< columns that no block before has
    Eigen::MatrixXd effect;  ///< of [z; fresh] on the columns of the block
    Eigen::MatrixXd Z;       ///< [z; fresh] = Z [handed on as the next z; settled]
    Eigen::Index handed = 0, handed_on = 0, first_settled = 0;
    /// What z handed on moves in all later blocks is |z' ahead|.
    Eigen::MatrixXd ahead;
    Eigen::Index settled() const { return Z.cols() - handed_on; }
  };
  /// Columns that later blocks have, and what the coordinates z move in them.
  struct Handed {
    std::vector<int> columns;
    Eigen::MatrixXd effect;  ///< [columns, z]
  };

  Handed TakeTurn(const Handed& handed, const RowBlock& block, const std::vector<int>& last,
                  double tolerance);
  void LookAhead();

  int columns_ = 0, rank_ = 0, dimension_ = 0;
  std::vector<bool> held_;
  std::vector<Turn> turns_;
  std::vector<int> loose_;  ///< columns of no block: the last of the basis
};

}  // namespace vmech
