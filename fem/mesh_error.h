#pragma once

#include "fem/beam_model.h"

namespace sprung::fem {

/// From this estimate on a mesh is called too coarse.
inline constexpr double kCoarseMesh = 0.01;

/// By how much an element makes frequencies too high: the leading term of the relative error of a mode that
/// moves it with its own inertia, divided by ω² (fem, eqs. 36, 37). The larger one of bending and
/// axial motion.
///
/// @param length  > 0 [m]
/// @return ≥ 0 [s²]; 0 of a bushing and without mass
/// Checked by tests/fem/mesh_error_test.cpp
double calc_error_per_omega_squared(double length, const BeamProperties& properties);

/// What the length of its elements does to a mesh, by the element that is the worst.
struct MeshError {
  int element = -1;                ///< 0-based; −1: no element has mass
  double per_omega_squared = 0.0;  ///< [s²]

  /// The relative error of a frequency, estimated. Above 0.3 it only says that elements are too long to move
  /// as beams do.
  double at(double frequency_hz) const;
  /// The frequency up to which the mesh is not too coarse, infinity without a worst element [Hz].
  double limit_hz() const;
};

MeshError estimate_mesh_error(const BeamModel& model);

/// The elements of a mesh that are too coarse at a frequency.
int count_coarse_elements(const BeamModel& model, double frequency_hz);

/// The number of equal elements in place of one that are not too coarse at a frequency. ≥ 1
int calc_num_parts(const BeamModel& model, int element, double frequency_hz);

}  // namespace sprung::fem
