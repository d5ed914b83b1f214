#include "vmech/base/linear_algebra/normal_equations.h"

#include <algorithm>
#include <numeric>

#include "vmech/base/linear_algebra/envelope_ldlt.h"

namespace vmech {
namespace {

/// The first column that shares a block with each column.
std::vector<int> EnvelopeOf(int columns, const std::vector<RowBlock>& C) {
  std::vector<int> first(columns);
  std::iota(first.begin(), first.end(), 0);
  for (const RowBlock& block : C) {
    if (block.columns.empty()) continue;
    const int lowest = *std::min_element(block.columns.begin(), block.columns.end());
    for (const int c : block.columns) first[c] = std::min(first[c], lowest);
  }
  return first;
}

}  // namespace

Eigen::VectorXd SolveNormalEquations(const std::vector<RowBlock>& C, const Eigen::VectorXd& e,
                                     const Eigen::VectorXd& D, const Eigen::VectorXd& b) {
  const int n = static_cast<int>(D.size());
  EnvelopeLdlt<double> H(EnvelopeOf(n, C));
  for (int i = 0; i < n; ++i) H(i, i) = D[i];
  Eigen::VectorXd x = b;
  Eigen::Index row = 0;
  for (const RowBlock& block : C) {
    const Eigen::MatrixXd gram = block.A.transpose() * block.A;
    x(block.columns) += block.A.transpose() * e.segment(row, block.A.rows());
    row += block.A.rows();
    for (Eigen::Index i = 0; i < gram.rows(); ++i) {
      for (Eigen::Index j = 0; j <= i; ++j) H.Add(block.columns[i], block.columns[j], gram(i, j));
    }
  }
  H.Factor();
  H.Solve(x.data());
  return x;
}

double ShareOfEnvelope(int columns, const std::vector<RowBlock>& C) {
  const std::vector<int> first = EnvelopeOf(columns, C);
  double inside = 0;
  for (int i = 0; i < columns; ++i) inside += 2 * (i - first[i]) + 1;
  return columns == 0 ? 0 : inside / columns / columns;
}

}  // namespace vmech
