#include "reduce/modes/held_node.h"

namespace sprung::reduce {

Eigen::SparseMatrix<double> remove_node(const Eigen::SparseMatrix<double>& matrix, int node) {
  Eigen::SparseMatrix<double> result(matrix.rows() - 3, matrix.cols() - 3);
  result.reserve(matrix.nonZeros());
  Eigen::Index to = 0;
  for (Eigen::Index column = 0; column < matrix.outerSize(); ++column) {
    if (column / 3 == node) continue;
    result.startVec(to);
    for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix, column); entry; ++entry) {
      if (entry.row() / 3 == node) continue;
      result.insertBack(entry.row() / 3 > node ? entry.row() - 3 : entry.row(), to) = entry.value();
    }
    ++to;
  }
  result.finalize();
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
