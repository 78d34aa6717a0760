#include "fem/bushing.h"

namespace sprung::fem {

Eigen::Matrix<double, 6, 6> calc_bushing_stiffness(const Bushing& bushing, double length) {
  const double before = bushing.place * length, after = length - before;
  Eigen::Matrix<double, 3, 6> D;       // displacement of the second node's side against the first node's
  D << -1.0, 0.0, 0.0, 1.0, 0.0, 0.0,  //
      0.0, -1.0, -before, 0.0, 1.0, -after,  //
      0.0, 0.0, -1.0, 0.0, 0.0, 1.0;
  return D.transpose() * bushing.stiffness * D;
}

}  // namespace sprung::fem
