#pragma once

#include <Eigen/Core>

#include "reduce/superelement/superelement.h"

namespace sprung::reduce {

/// Displacements of two bodies' modes at the places that both have; of modes of the free body about its mean
/// axes.
struct ShapeSamples {
  Eigen::MatrixXd old_shapes,
      new_shapes;      ///< 2P×n each, rows (x, y) of each place, times the root of its weight
  int num_points = 0;  ///< P
  double share_of_old = 0.0, share_of_new = 0.0;  ///< of each body's nodes that lie on the other
};

/// Nodes of either body that lie on the other one, to 1e-6 of its radius, in body axes; where all points that
/// both name are the same way apart, because the reference node has changed, the bodies are moved onto each
/// other. Checked by tests/reduce/inspection/comparison_test.cpp
ShapeSamples sample_shapes(const Superelement& old_body, const Superelement& new_body);

}  // namespace sprung::reduce
