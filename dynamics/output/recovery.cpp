#include "dynamics/output/recovery.h"

namespace sprung::dynamics {

ResultantRecovery::ResultantRecovery(const reduce::Superelement& superelement, const Body& body) {
  const Eigen::Index stations = 2 * superelement.elements.cols();
  const Eigen::Index n = body.num_modes();
  positions_.resize(stations, 2);
  axial_.resize(stations, n);
  shear_.resize(stations, n);
  moment_.resize(stations, n);
  for (Eigen::Index station = 0; station < stations; ++station) {
    const int node = superelement.elements(station % 2, station / 2);
    positions_.row(station) = superelement.node_positions.col(node).transpose();
    for (Eigen::Index k = 0; k < n; ++k) {
      const Eigen::Index mode = body.mode_numbers[static_cast<std::size_t>(k)] - 1;
      axial_(station, k) = superelement.resultants(3 * station, mode);
      shear_(station, k) = superelement.resultants(3 * station + 1, mode);
      moment_(station, k) = superelement.resultants(3 * station + 2, mode);
    }
  }
}

}  // namespace sprung::dynamics
