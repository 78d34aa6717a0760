#pragma once

#include <Eigen/Core>
#include <span>

namespace sprung::support {

/// The entries of a vector, for functions that take spans; valid as long as the vector keeps its size.
inline std::span<double> as_span(Eigen::VectorXd& vector) {
  return {vector.data(), static_cast<std::size_t>(vector.size())};
}
inline std::span<const double> as_span(const Eigen::VectorXd& vector) {
  return {vector.data(), static_cast<std::size_t>(vector.size())};
}

}  // namespace sprung::support
