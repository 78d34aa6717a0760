#pragma once

#include "fem/beam_properties.h"

namespace sprung::fem {

/// A spring or bushing in the middle between two nodes, to which it is connected rigidly.
struct Spring {
  double axial = 0.0;       ///< along the line between the nodes, > 0 [N/m]
  double transverse = 0.0;  ///< across it, > 0 and at most 12 rotational / length² [N/m]
  double rotational = 0.0;  ///< > 0 [N·m]
};

/// The largest transverse stiffness of a spring with this rotational one: that without shear (fem, eq. 31).
double calc_largest_transverse_stiffness(double rotational, double length);

/// The massless beam element that is such a spring exactly (fem, eq. 31).
/// @param length  between the nodes, > 0 [m]
/// @throws std::invalid_argument if a stiffness is out of its range
/// Checked by tests/reduce/design/springs_test.py
BeamProperties make_spring_properties(const Spring& spring, double length);

}  // namespace sprung::fem
