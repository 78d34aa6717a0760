#include "dynamics/system/partition.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dynamics/linear_algebra/column_pivoting.h"
#include "tools/support/dense/orthogonal_factors.h"

namespace sprung::dynamics {

namespace {

constexpr double kRankTolerance = 1e-9;  // of unit rows; assembled positions are good to 1e-12
// A smallest pivot above this share of the largest leaves no singular value below kRankTolerance.
constexpr double kSafePivot = 1e-6;
constexpr int kTrials = 4;  // positions, so that not all of them are near a change point

// φ_q with columns scaled by 1/√M_ii.
Eigen::SparseMatrix<double> scaled_jacobian(const SystemTerms& terms) {
  const Eigen::VectorXd scales = terms.calc_metric().cwiseSqrt().cwiseInverse();
  return terms.jacobian().sparse() * scales.asDiagonal();
}

}  // namespace

Partition choose_partition(const SystemTerms& terms) {
  const Model& model = terms.model();
  Partition partition;
  std::vector<bool> is_dependent(static_cast<std::size_t>(model.num_coordinates), false);
  const ColumnPivots pivots = choose_columns(scaled_jacobian(terms));
  for (const int column : pivots.columns) is_dependent[static_cast<std::size_t>(column)] = true;
  if (!pivots.sizes.empty()) {
    const auto [smallest, largest] = std::minmax_element(pivots.sizes.begin(), pivots.sizes.end());
    partition.smallest_pivot = *smallest / *largest;
  }
  for (int i = 0; i < model.num_coordinates; ++i) {
    (is_dependent[static_cast<std::size_t>(i)] ? partition.dependent : partition.independent).push_back(i);
  }
  return partition;
}

double calc_usual_pivot(const Model& model, double time, const Eigen::VectorXd& q) {
  SystemTerms terms(model, SystemTerms::Markers::kActing);
  Eigen::VectorXd turned = q;
  double turns = 0.0, largest = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    for (const Body& body : model.bodies) {
      turns += std::numbers::phi;
      turned[body.first_coordinate + 2] = 2.0 * std::numbers::pi * (turns - std::floor(turns));
    }
    terms.update_positions(time, turned);
    terms.update_jacobian();
    terms.update_mass();
    largest = std::max(largest, choose_partition(terms).smallest_pivot);
  }
  return largest;
}

std::vector<int> find_dependent_constraints(const SystemTerms& terms) {
  const int num_constraints = terms.model().num_constraints;
  if (num_constraints == 0) return {};
  const Eigen::SparseMatrix<double> scaled = scaled_jacobian(terms);
  Eigen::VectorXd row_scales = Eigen::VectorXd::Zero(num_constraints);
  for (int j = 0; j < scaled.outerSize(); ++j) {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(scaled, j); entry; ++entry) {
      row_scales[entry.row()] += entry.value() * entry.value();
    }
  }
  for (double& scale : row_scales) scale = scale > 0.0 ? 1.0 / std::sqrt(scale) : 1.0;
  const Eigen::SparseMatrix<double> rows = row_scales.asDiagonal() * scaled;
  if (rows.rows() <= rows.cols()) {
    const ColumnPivots pivots = choose_columns(rows);
    const auto [smallest, largest] = std::minmax_element(pivots.sizes.begin(), pivots.sizes.end());
    if (*smallest > kSafePivot * *largest) return {};
  }
  // The model probably contains a mistake: the cost of finding its place does not matter.
  const support::SingularPairs singular = support::calc_left_singular_pairs(rows.toDense());
  std::vector<int> found;
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    double share = 0.0;  // of constraint i in the combinations of rows that vanish
    for (Eigen::Index k = 0; k < rows.rows(); ++k) {
      const double value = k < singular.values.size() ? singular.values[k] : 0.0;
      if (value <= kRankTolerance) share += std::abs(singular.vectors(i, k));
    }
    if (share > 1e-6) found.push_back(static_cast<int>(i));
  }
  return found;
}

}  // namespace sprung::dynamics
