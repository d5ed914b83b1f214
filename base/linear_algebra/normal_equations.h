#pragma once

#include <vector>

#include "vmech/base/linear_algebra/block_null_space.h"

namespace vmech {

/// x of (C'C + D) x = C'e + b, the rows of C given block by block, e [rows] in their order, D > 0
/// diagonal: what least squares with a penalty on x lead to. Linear in the number of blocks where
/// each has columns in common with a few neighbours.
Eigen::VectorXd SolveNormalEquations(const std::vector<RowBlock>& C, const Eigen::VectorXd& e,
                                     const Eigen::VectorXd& D, const Eigen::VectorXd& b);

/// The share of C'C, of `columns` columns, that lies within its envelope.
double ShareOfEnvelope(int columns, const std::vector<RowBlock>& C);

}  // namespace vmech
