#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <random>

namespace sprung::reduce {

/// Values uniform on −½ … ½, the same on every machine.
inline Eigen::VectorXd make_random_vector(Eigen::Index size, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  Eigen::VectorXd vector(size);
  for (double& value : vector) value = static_cast<double>(generator() >> 11) * 0x1p-53 - 0.5;
  return vector;
}

}  // namespace sprung::reduce
