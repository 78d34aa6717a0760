#pragma once

#include <Eigen/Core>
#include <array>

namespace sprung::dynamics {

/// The four Lobatto points of a step, from 0 at its start to 1 at its end, and interpolation through them.
namespace lobatto {

constexpr int kNumNodes = 4;
using NodeWeights = Eigen::Vector4d;
using NodeValues = Eigen::Matrix<double, Eigen::Dynamic, kNumNodes>;  ///< a column for each node

double node(int j);
/// Weights of the values at the nodes for the value of the cubic through them at θ.
NodeWeights cubic_weights(double theta);
/// (θ − c₀)(θ − c₁)(θ − c₂)(θ − c₃): what a force of fourth degree has beyond its cubic.
double node_polynomial(double theta);
/// Coefficient of θ³.
NodeWeights third_degree_weights();

}  // namespace lobatto

/// What uncoupled oscillators and plain integrals do from the start of a step up to one instant of it,
/// exactly, under forces that are cubics through their values at the Lobatto points (dynamics/README.md, eq.
/// 43). f oscillators.
struct OscillatorPropagator {
  Eigen::ArrayXd c, s, c_rate, s_rate;              ///< f, from position and velocity at the start
  lobatto::NodeValues force, force_rate;            ///< f×4, from the forces at the nodes
  Eigen::ArrayXd quartic, quartic_rate;             ///< f, from a force of node_polynomial(θ)
  std::array<double, lobatto::kNumNodes> integral;  ///< from the rates at the nodes [s]
  double integral_quartic;                          ///< [s]

  /// @param theta  the instant, 0 to 1
  /// @param length  of the step [s]
  /// @param stiffness, decay  ω² [1/s²] and d [1/s] of x″ + 2d x′ + ω² x = p, f each
  void update(double theta, double length, const Eigen::ArrayXd& stiffness, const Eigen::ArrayXd& decay);
};

}  // namespace sprung::dynamics
