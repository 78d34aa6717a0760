#pragma once

#include <Eigen/Core>

namespace sprung::support {

/// The columns of one matrix and behind them those of another one with as many rows.
inline Eigen::MatrixXd join_columns(const Eigen::MatrixXd& left, const Eigen::MatrixXd& right) {
  Eigen::MatrixXd joined(left.rows(), left.cols() + right.cols());
  joined << left, right;
  return joined;
}

}  // namespace sprung::support
