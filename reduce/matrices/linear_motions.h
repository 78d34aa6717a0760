#pragma once

#include "reduce/matrices/matrix_body.h"

namespace sprung::reduce {

/// Motions of a body's nodes that are linear in their places; 3(N+A) each.
struct LinearMotions {
  Eigen::VectorXd along_x, along_y;  ///< (1, 0, 0), (0, 1, 0)
  Eigen::VectorXd rotation;          ///< (−y, x, 1)
  Eigen::VectorXd places;            ///< (x, y, 0): each node moves by its own place
};

/// @param origin  of x and y
LinearMotions make_linear_motions(const MatrixBody& body, const Eigen::Vector2d& origin);

/// The middle of the nodes.
Eigen::Vector2d calc_middle(const MatrixBody& body);

}  // namespace sprung::reduce
