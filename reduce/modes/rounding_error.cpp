#include "reduce/modes/rounding_error.h"

#include <cmath>
#include <limits>

namespace sprung::reduce {

double estimate_rounding_error(const Eigen::SparseMatrix<double>& stiffness, const Eigen::VectorXd& shape,
                               double omega_squared) {
  double sum = 0.0;
  for (Eigen::Index column = 0; column < stiffness.outerSize(); ++column) {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(stiffness, column); entry; ++entry) {
      const double energy = shape(entry.row()) * entry.value() * shape(entry.col());
      sum += energy * energy;
    }
  }
  return 4.0 * std::numeric_limits<double>::epsilon() * std::sqrt(sum) / omega_squared;
}

}  // namespace sprung::reduce
