#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "dynamics/element_input/force_input.h"
#include "dynamics/element_input/history_input.h"
#include "dynamics/element_input/joint_input.h"
#include "dynamics/element_input/motion_input.h"
#include "dynamics/element_input/point_reference.h"
#include "dynamics/mode_choice/judged_quantities.h"
#include "reduce/superelement/superelement.h"
#include "tools/support/toml/toml.h"

namespace sprung::dynamics {

class SuperelementCache;

/// A named point of a body, or of the ground.
struct PointDescription {
  std::string name;
  std::string node;  ///< named node that it is fixed to; if empty, it is fixed to the body frame
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< from the frame's origin or the node, body axes [m]
  support::SourceLocation location;
};

/// A body given by mass and inertia (rigid, frame at the centre of mass), or by a superelement (frame at its
/// reference node, modes may be active).
struct BodyDescription {
  std::string name;
  support::SourceLocation location;
  support::SourceLocation mass_location, inertia_location;  ///< of a rigid body
  support::SourceLocation angle_location;
  double mass = 0.0;         ///< ≥ 0 [kg]; 0 with a superelement
  double inertia = 0.0;      ///< ≥ 0, about the centre of mass [kg·m²]; 0 with a superelement
  std::string superelement;  ///< name, empty if there is none
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< of the body frame [m]
  double angle = 0.0;                                  ///< [rad]
  std::vector<PointDescription> points;
};

/// The contents of a vehicle file, with the superelements that its bodies name.
struct Vehicle {
  std::string name;
  std::string text;                        ///< the file as read
  double direction = 1.0;                  ///< of travel: +1 towards +x, −1 towards −x
  Eigen::Vector2d gravity{0.0, -9.80665};  ///< [m/s²]
  support::SourceLocation gravity_location;
  std::vector<BodyDescription> bodies;
  std::vector<PointDescription> ground_points;
  std::vector<JointDescription> joints;
  std::vector<MotionDescription> motions;
  std::vector<ForceDescription> forces;
  /// Points whose motion is reported; every body's origin if the file has none.
  std::vector<PointReference> monitor;
  JudgedQuantities judged;  ///< by which modes are left out
  std::map<std::string, reduce::Superelement> superelements;
  std::vector<HistoryUse> histories;  ///< measured, that joints, motions and forces follow

  const BodyDescription* find_body(const std::string& body_name) const;  ///< nullptr if there is none
  /// @return nullptr for a body without superelement
  const reduce::Superelement* superelement_of(const BodyDescription& body) const;
  std::vector<std::string> body_names() const;
};

/// Reads a vehicle file (dynamics/models/README.md lists the keys), FOLDER/NAME.h5 of every superelement that
/// a body names, and the files of measured histories.
/// @param cache  of superelements read before; nullptr: none
/// @throws support::InputError at the first key or value that is wrong
/// Checked by tests/dynamics/input/vehicle_test.cpp
Vehicle read_vehicle(const support::TomlDocument& document, const std::filesystem::path& superelement_folder,
                     SuperelementCache* cache = nullptr);

/// A point that joints, forces and results can refer to.
struct VehiclePoint {
  enum class Kind { kFixed, kNode, kCenterOfMass };
  std::string name;  ///< "body.point"
  Kind kind = Kind::kFixed;
  int body = 0;                                      ///< position in Vehicle::bodies, or kGround
  Eigen::Vector2d p_BP = Eigen::Vector2d::Zero();    ///< from the undeformed body's frame, body axes [m]
  int node = -1;                                     ///< 0-based node of the superelement for kNode
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();  ///< from the node, body axes [m]
};

/// Every point of a vehicle. For each body: `origin`, `center_of_mass`, the named nodes of its superelement
/// and its points in the file. Then the points of the ground; the last is its `origin`, that of the world.
std::vector<VehiclePoint> list_points(const Vehicle& vehicle);
std::vector<std::string> point_names(const Vehicle& vehicle);

}  // namespace sprung::dynamics
