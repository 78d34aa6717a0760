#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dynamics/section_loads/body_loads.h"

namespace sprung::dynamics {

/// Axial force, shear force and bending moment along the beams of a body at an instant, and deflections of
/// its named points, from its modes and from its loads (section_loads, eqs. 1, 2). There is one station at
/// each end of each element, in the superelement's order of elements, first end first. Values are 3×stations,
/// rows N [N], Q [N], M [N·m]. `update` allocates nothing.
class BodySections {
 public:
  /// @param body    0-based, of the model; with a superelement
  /// @param points  of the vehicle, in the order of the model's markers
  BodySections(const Model& model, int body, const reduce::Superelement& superelement,
               const std::vector<VehiclePoint>& points);

  const std::string& name() const { return name_; }
  std::size_t body() const { return body_; }  ///< 0-based, of the model
  /// Undeformed positions of the stations, body axes, stations×2 [m].
  const Eigen::MatrixXd& positions() const { return positions_; }
  double length() const { return length_; }  ///< diagonal of the stations [m]
  double weight() const { return weight_; }  ///< [N], of the mass at 1 m/s² at least
  /// Area [m²] and section modulus [m³] at each station, 0: not known; none where the superelement has none.
  const std::optional<reduce::SectionSizes>& sizes() const { return sizes_; }
  bool has_modes() const { return num_modes_ > 0; }
  /// Whether all vectors of the superelement are among the modes.
  bool has_whole_basis() const { return has_whole_basis_; }
  /// Whether the superelement has a certificate with a bound.
  bool is_certified() const { return is_certified_; }
  /// Whether there are values from loads. There are none of a body with stiffening, whose equilibrium is that
  /// of its deformed shape, and none where the superelement has no section loads.
  bool has_loads() const { return by_load_.size() > 0; }

  /// @param loads  force and torque on each marker of the model, world axes
  /// @param q, v, v_dot  of the model
  void update(std::span<const Wrench> loads, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
              const Eigen::VectorXd& v_dot);
  const BodyLoads& loads() const { return loads_; }
  const Eigen::Matrix3Xd& from_modes() const { return from_modes_; }
  const Eigen::Matrix3Xd& from_loads() const { return from_loads_; }
  /// Whether it is known what the modes lack.
  bool has_missing() const { return missing_moment_by_.size() > 0; }
  /// What the modes lack of the mean bending moment of each element (section_loads, eqs. 3, 5) [N·m].
  const Eigen::VectorXd& missing_moment() const { return missing_moment_; }
  /// Names of the superelement's points, "body.point".
  const std::vector<std::string>& points() const { return points_; }
  /// Deflections of these points with what the modes lack of them, and this part alone, body axes
  /// (section_loads, eqs. 4, 5). Rows x [m], y [m], rotation [rad], 3×points
  const Eigen::Matrix3Xd& deflections() const { return deflections_; }
  const Eigen::Matrix3Xd& missing_deflections() const { return missing_deflections_; }
  /// What all vectors of the superelement would lack of both under the same loads (section_loads, eq. 9).
  const Eigen::VectorXd& basis_missing_moment() const { return basis_missing_moment_; }
  const Eigen::Matrix3Xd& basis_missing_deflections() const { return basis_missing_deflections_; }

 private:
  Eigen::MatrixXd combine(const reduce::UnitLoads& unit, const std::vector<int>& columns) const;
  void prepare_missing(const Body& body, const reduce::Superelement& superelement,
                       const std::vector<int>& columns);
  void prepare_left_out(const reduce::Superelement& superelement, const std::vector<int>& columns);
  Eigen::MatrixXd calc_amplitudes(const reduce::Superelement& superelement, const std::vector<int>& vectors,
                                  const std::vector<int>& columns) const;
  Eigen::MatrixXd average_moments(const Eigen::MatrixXd& resultants) const;
  Eigen::MatrixXd pick_deflections(const reduce::Superelement& superelement,
                                   const std::vector<int>& columns) const;

  std::string name_;
  std::size_t body_;
  int first_, num_modes_;
  bool has_whole_basis_, is_certified_;
  BodyLoads loads_;
  Eigen::MatrixXd positions_;
  double length_, weight_;
  std::optional<reduce::SectionSizes> sizes_;
  Eigen::MatrixXd by_mode_;  // 3 stations × modes
  Eigen::MatrixXd by_load_;  // 3 stations × coefficients of the loads, modes, modes turned
  Eigen::VectorXd causes_;   // these coefficients and accelerations, then the amplitudes below
  Eigen::Matrix3Xd from_modes_, from_loads_;
  Eigen::VectorXd delay_;  // damping over stiffness of each mode
  Eigen::MatrixXd
      amplitude_by_load_;       // with stiffening: K⁻¹ times the modal load, modes × columns of by_load_
  Eigen::VectorXd amplitudes_;  // that the loads have: η + delay η̇, with stiffening by the above
  Eigen::MatrixXd missing_moment_by_;  // mean moment of each element by causes_
  Eigen::VectorXd missing_moment_;
  std::vector<std::string> points_;
  Eigen::MatrixXd deflection_by_mode_;     // 3 points × modes
  Eigen::MatrixXd missing_deflection_by_;  // 3 points × causes_
  Eigen::Matrix3Xd deflections_, missing_deflections_;
  // Of vectors that are no modes, by causes_ without amplitudes; none where all vectors are modes
  Eigen::MatrixXd left_out_moment_by_, left_out_deflection_by_;
  Eigen::VectorXd basis_missing_moment_;
  Eigen::Matrix3Xd basis_missing_deflections_;
};

}  // namespace sprung::dynamics
