#include "reduce/matrices/modal_freedoms.h"

namespace sprung::reduce {

namespace {

// Of each row of the mass, how strongly it is coupled with some motions.
Eigen::VectorXd calc_coupling(const Eigen::SparseMatrix<double>& mass,
                              const Eigen::SparseMatrix<double>& motions) {
  const Eigen::SparseMatrix<double> rows = mass * motions;
  Eigen::VectorXd coupling = Eigen::VectorXd::Zero(mass.rows());
  for (Eigen::Index column = 0; column < rows.outerSize(); ++column) {
    const double diagonal = motions.col(column).dot(rows.col(column));
    if (!(diagonal > 0.0)) continue;
    for (Eigen::SparseMatrix<double>::InnerIterator entry(rows, column); entry; ++entry)
      coupling(entry.row()) += entry.value() * entry.value() / diagonal;
  }
  return coupling;
}

}  // namespace

ModalFreedoms divide_modal_freedoms(const MatrixSystem& system, const Eigen::SparseMatrix<double>& symmetric,
                                    const Eigen::SparseMatrix<double>& antisymmetric) {
  ModalFreedoms divided;
  const Eigen::VectorXd even = calc_coupling(system.mass, symmetric);
  const Eigen::VectorXd odd = calc_coupling(system.mass, antisymmetric);
  for (int row = 0; row < system.freedoms.size(); ++row) {
    if (!system.freedoms[row].is_modal()) continue;
    (odd(row) > even(row) ? divided.antisymmetric : divided.symmetric).push_back(row);
  }
  return divided;
}

}  // namespace sprung::reduce
