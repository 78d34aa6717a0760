#include "dynamics/system/partition.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace sprung::dynamics {

namespace {

// φ_q with columns scaled by 1/√M_ii: the constraints as the masses feel them.
Eigen::MatrixXd scaled_jacobian(const SystemTerms& terms) {
  Eigen::MatrixXd scaled = terms.jacobian().dense();
  const Model& model = terms.model();
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    for (int k = 0; k < model.bodies[b].num_coordinates(); ++k) {
      scaled.col(model.bodies[b].first_coordinate + k) /= std::sqrt(terms.mass(b)(k, k));
    }
  }
  return scaled;
}

}  // namespace

Partition choose_partition(const SystemTerms& terms) {
  const Model& model = terms.model();
  Partition partition;
  std::vector<bool> is_dependent(static_cast<std::size_t>(model.num_coordinates), false);
  if (model.num_constraints > 0) {
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(scaled_jacobian(terms));
    for (int k = 0; k < model.num_constraints; ++k) {
      is_dependent[static_cast<std::size_t>(qr.colsPermutation().indices()[k])] = true;
    }
  }
  for (int i = 0; i < model.num_coordinates; ++i) {
    (is_dependent[static_cast<std::size_t>(i)] ? partition.dependent : partition.independent).push_back(i);
  }
  return partition;
}

std::vector<int> find_dependent_constraints(const SystemTerms& terms) {
  if (terms.model().num_constraints == 0) return {};
  Eigen::MatrixXd rows = scaled_jacobian(terms);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const double norm = rows.row(i).norm();
    if (norm > 0.0) rows.row(i) /= norm;
  }
  constexpr double kRankTolerance = 1e-9;  // of unit rows; assembled positions are good to 1e-12
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows, Eigen::ComputeFullU);
  std::vector<int> found;
  const auto singular = svd.singularValues();
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    double share = 0.0;  // of constraint i in the combinations of rows that vanish
    for (Eigen::Index k = 0; k < rows.rows(); ++k) {
      const double value = k < singular.size() ? singular[k] : 0.0;
      if (value <= kRankTolerance) share += std::abs(svd.matrixU()(i, k));
    }
    if (share > 1e-6) found.push_back(static_cast<int>(i));
  }
  return found;
}

}  // namespace sprung::dynamics
