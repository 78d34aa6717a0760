#pragma once

#include <Eigen/Core>
#include <complex>
#include <span>
#include <string>
#include <vector>

#include "dynamics/forces/road_response.h"
#include "dynamics/linear/frequency_solver.h"
#include "dynamics/linear/linearisation.h"
#include "dynamics/linear/state_derivatives.h"
#include "dynamics/system/model.h"

namespace sprung::dynamics {

/// A force element through which the road comes in.
struct RoadInput {
  std::string name;         ///< of the element
  int force = 0;            ///< its place in Model::forces
  double distance = 0.0;    ///< along the road [m]
  bool is_pressed = false;  ///< otherwise nothing comes in here
};

/// What a road wave does through each of the k inputs, by itself and with amplitude 1 m there.
struct RoadAction {
  Eigen::MatrixXcd forces;    ///< nq×k, generalized forces [N/m, N·m/m]
  Eigen::MatrixXcd channels;  ///< (all channels of all force elements)×k, their direct part
};

/// A vehicle at rest on level ground, linearised, with the road as its input: M̂ δq̈ + Ĉ δq̇ + K̂ δq = Dᵀ δQ
/// in f independent coordinates, nq coordinates in all, k road inputs (linear, eqs. 6–9; forces, eqs. 11–13).
/// What is read off from its motion are LinearOutputs.
class LinearVehicle {
 public:
  /// @param model  on level ground; has to outlive this  @param q  equilibrium
  /// @throws support::NumericalError if it cannot be linearised there
  LinearVehicle(const Model& model, const Eigen::VectorXd& q);

  const Model& model() const { return equations_.terms().model(); }
  const LinearisedSystem& system() const { return system_; }
  const FrequencySolver& solver() const { return solver_; }
  const std::vector<RoadInput>& inputs() const { return inputs_; }
  /// Kinks of force elements at the equilibrium, where there is no one slope.
  const std::vector<Kink>& kinks() const { return kinks_; }

  /// At the equilibrium, all markers up to date.
  const PartitionedEquations& equations() const { return equations_; }
  const Eigen::VectorXd& positions() const { return q_; }  ///< nq
  Eigen::VectorXd independent_positions() const;           ///< f
  /// The branches of the force elements there.
  const std::vector<int>& branches() const { return branches_; }
  /// What all channels of all force elements show there.
  Eigen::VectorXd calc_channels() const;
  /// First channel of each force element among all channels, and behind the last their number.
  const std::vector<int>& channel_rows() const { return channel_rows_; }

  RoadAction calc_road_action(const RoadWave& wave) const;
  /// The same of one input, as force and torque on the markers of its force element.
  /// @param[out] wrenches  of all markers; those of the element are set, all others left  @param[out]
  /// channels  of the element's channels, direct part
  void calc_road_wrenches(std::size_t input, const RoadWave& wave, std::span<WrenchGain> wrenches,
                          Eigen::VectorXcd& channels) const;
  /// Motion of the independent coordinates, x of q = x e^{iωt}, f×k.
  Eigen::MatrixXcd calc_motion(double omega, const RoadAction& action) const;
  /// Share of the wave's amplitude at each input, and its phase, where the foremost input has 1: e^{iκ(s −
  /// s_foremost)}. The others meet the same road later.  @return k
  Eigen::VectorXcd calc_delays(const RoadWave& wave) const;

 private:
  Eigen::VectorXd q_;
  PartitionedEquations equations_;
  LinearisedSystem system_;
  FrequencySolver solver_;
  std::vector<RoadInput> inputs_;
  std::vector<Kink> kinks_;
  std::vector<int> branches_, channel_rows_;
};

/// Motion of a marker (δx, δy, δangle), world axes, by the coordinates: 3×nq.
/// @param terms  the marker's position up to date
Eigen::MatrixXd calc_marker_jacobian(const SystemTerms& terms, int marker);

}  // namespace sprung::dynamics
