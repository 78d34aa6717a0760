#pragma once

#include <vector>

#include "fem/beam_element.h"
#include "fem/beam_properties.h"
#include "fem/coupling.h"
#include "fem/mesh.h"

namespace sprung::fem {

/// A mass concentrated at a node.
struct PointMass {
  int node = 0;          ///< 0-based
  double mass = 0.0;     ///< ≥ 0 [kg]
  double inertia = 0.0;  ///< ≥ 0, about the node [kg·m²]
};

/// A frame of beams with everything its matrices depend on.
struct BeamModel {
  Mesh mesh;
  std::vector<BeamProperties> sections;  ///< one for each of mesh.section_names
  std::vector<PointMass> point_masses;   ///< several on one node add up
  std::vector<Coupling> couplings = {};  ///< nodes that follow others; no node follows one that follows
};

/// The element of that 0-based number with its positions and properties.
BeamElement make_element(const BeamModel& model, int element);

/// @throws std::invalid_argument (names function, item and value) if an index is out of range, the number of
///         sections is not that of the mesh's names, or a property or point mass is out of range
void check_beam_model(const BeamModel& model, const char* function);

}  // namespace sprung::fem
