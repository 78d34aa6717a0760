#include "fem/spread_loads.h"

#include "fem/gauss_points.h"

namespace sprung::fem {

Matrix6 calc_turned_mass(const BeamElement& element) {
  const double length = calc_length(element);
  Matrix6 half = Matrix6::Zero();
  for (const auto& [xi, weight] : make_gauss_points()) {
    const double dm = weight * length * element.properties.mass_per_length;
    const Eigen::Matrix<double, 3, 6> N = calc_shape_functions(length, element.properties, xi);
    half += dm * N.row(1).transpose() * N.row(0);
  }
  const Matrix6 T = calc_rotation(element);
  return T.transpose() * (half - half.transpose()) * T;
}

Eigen::MatrixXd calc_loaded_resultants(const BeamElement& element,
                                       const Eigen::Ref<const Eigen::MatrixXd>& ends,
                                       const Eigen::Ref<const Eigen::MatrixXd>& load) {
  const Eigen::MatrixXd spread = calc_rotation(element) * load;
  Eigen::MatrixXd resultants = calc_resultants(element) * ends;
  resultants.topRows<3>() += spread.topRows<3>();
  resultants.bottomRows<3>() -= spread.bottomRows<3>();
  return resultants;
}

}  // namespace sprung::fem
