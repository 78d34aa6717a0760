#pragma once

#include <Eigen/SparseCore>
#include <string>

#include "reduce/matrices/tables.h"

namespace sprung::reduce {

/// Stiffness and mass of a structure in space, as another program wrote them, n×n.
struct MatrixSystem {
  std::string stiffness_path, mass_path;  ///< for messages
  FreedomList freedoms;                   ///< n, of the rows
  Eigen::SparseMatrix<double> stiffness, mass;
  NodeTable nodes;  ///< at least those of the freedoms
};

/// Which of a structure's axes span the plane of the body frame.
struct PlanarAxes {
  Eigen::Vector3d first = Eigen::Vector3d::UnitX();   ///< becomes x; an axis of space, or its opposite
  Eigen::Vector3d second = Eigen::Vector3d::UnitY();  ///< becomes y; another one
};

/// What the numbers of the files stand for. Time is in seconds.
struct MatrixUnits {
  double length = 1.0;  ///< the unit of length [m]
  double mass = 1.0;    ///< the unit of mass [kg]
};

}  // namespace sprung::reduce
