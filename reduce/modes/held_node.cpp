#include "reduce/modes/held_node.h"

#include <vector>

namespace sprung::reduce {

Eigen::SparseMatrix<double> remove_node(const Eigen::SparseMatrix<double>& matrix, int node) {
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(static_cast<std::size_t>(matrix.nonZeros()));
  for (Eigen::Index column = 0; column < matrix.outerSize(); ++column) {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix, column); entry; ++entry) {
      if (entry.row() / 3 == node || entry.col() / 3 == node) continue;
      const auto row = static_cast<int>(entry.row()), col = static_cast<int>(entry.col());
      triplets.emplace_back(row / 3 > node ? row - 3 : row, col / 3 > node ? col - 3 : col, entry.value());
    }
  }
  Eigen::SparseMatrix<double> result(matrix.rows() - 3, matrix.cols() - 3);
  result.setFromTriplets(triplets.begin(), triplets.end());
  return result;
}

Eigen::MatrixXd remove_node(const Eigen::MatrixXd& rows, int node) {
  Eigen::MatrixXd held(rows.rows() - 3, rows.cols());
  held << rows.topRows(3 * node), rows.bottomRows(rows.rows() - 3 * node - 3);
  return held;
}

Eigen::MatrixXd insert_node(const Eigen::MatrixXd& rows, int node) {
  Eigen::MatrixXd all(rows.rows() + 3, rows.cols());
  all.topRows(3 * node) = rows.topRows(3 * node);
  all.middleRows(3 * node, 3).setZero();
  all.bottomRows(rows.rows() - 3 * node) = rows.bottomRows(rows.rows() - 3 * node);
  return all;
}

}  // namespace sprung::reduce
