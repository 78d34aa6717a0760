#pragma once

#include <Eigen/Core>
#include <string>

#include "dynamics/bodies/body.h"
#include "dynamics/section_loads/body_loads.h"
#include "tools/support/files/bytes.h"

namespace sprung::dynamics {

/// Below this share of the length, axial forces may change a deflection as they like.
inline constexpr double kNoDeflection = 1e-4;

/// How large a flexible body's deflection has become in a run, and what axial forces that the model leaves
/// out would have changed in it (section_loads, eqs. 7, 8).
class BodyBending {
 public:
  /// @param loads  of the body
  BodyBending(const Body& body, const reduce::Superelement& superelement, const BodyLoads& loads);

  const std::string& name() const { return name_; }
  /// @param time   not before that of the last call [s]   @param loads  at this time   @param q  of the model
  void add(double time, const BodyLoads& loads, const Eigen::VectorXd& q);

  double deflection_share() const { return deflection_.value / length_; }
  double deflection_time() const { return deflection_.time; }  ///< [s]
  /// 0 for a body with stiffening, and one whose superelement has no geometric stiffness or that hardly
  /// bends.
  double axial_effect() const;

  template <class Bytes, class Bending>
  static void transfer(Bytes& bytes, Bending& bending) {
    bytes.transfer(bending.deflection_.value);
    bytes.transfer(bending.deflection_.time);
    bytes.transfer(bending.time_);
    bytes.transfer(bending.once_);
    bytes.transfer(bending.averaged_);
    bytes.transfer(bending.largest_work_);
    bytes.transfer(bending.largest_strain_);
  }

 private:
  struct Peak {
    double value = 0.0, time = 0.0;
  };

  void add_to_means(double time);

  std::string name_;
  int first_, num_modes_;
  double length_;                   // [m]
  Eigen::MatrixXd shapes_;          // x and y of each node, 2N×n
  Eigen::MatrixXd geometric_;       // K_G of unit loads, m² × coefficients; empty: not judged
  Eigen::VectorXd stiffness_;       // of the lowest m modes
  Eigen::VectorXd displacement_;    // 2N
  Eigen::VectorXd present_, half_;  // K_G, m²; K_G η, m
  Peak deflection_;                 // [m]
  double averaging_time_ = 0.0;     // [s]
  double time_ = 0.0;               // of the last output [s]
  // ηᵀK_Gη [J], then of each of the lowest m modes: Kη² [J], the share of K by which axial forces change it,
  // and |K_G| η² [J]. Now, after one low-pass filter, and after two: empty before the first output.
  Eigen::VectorXd now_, once_, averaged_;
  double largest_work_ = 0.0, largest_strain_ = 0.0;  // of the means over a short time [J]
};

}  // namespace sprung::dynamics
