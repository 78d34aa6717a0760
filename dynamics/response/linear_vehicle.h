#pragma once

#include <Eigen/Core>
#include <complex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dynamics/forces/road_response.h"
#include "dynamics/linear/frequency_solver.h"
#include "dynamics/linear/linearisation.h"
#include "dynamics/linear/state_derivatives.h"
#include "dynamics/system/model.h"

namespace sprung::dynamics {

/// A force element through which the road acts on the vehicle.
struct RoadInput {
  std::string name;         ///< of the element
  int force = 0;            ///< its index in Model::forces
  double distance = 0.0;    ///< along the road [m]
  bool is_pressed = false;  ///< whether it is on the ground; otherwise the road does not act here
  bool can_lift = true;     ///< whether it can leave the ground
};

/// The effect of a road wave of amplitude 1 m at each of the k inputs alone.
struct RoadAction {
  Eigen::MatrixXcd forces;    ///< nq×k, generalized forces [N/m, N·m/m]
  Eigen::MatrixXcd channels;  ///< (all channels of all force elements)×k, their direct part
};

/// A vehicle at rest on level ground, linearised, with the road as its input: M̂ δq̈ + Ĉ δq̇ + K̂ δq = Dᵀ δQ
/// in f independent coordinates, nq coordinates in all, k road inputs (response, eqs. 1–3; linear, eq. 4;
/// forces, eqs. 11–13). LinearOutputs compute quantities from its motion. Checked by
/// tests/dynamics/response/linear_vehicle_test.cpp
class LinearVehicle {
 public:
  /// @param model  on level ground; must outlive this
  /// @param q      equilibrium, nq
  /// @throws support::NumericalError if it cannot be linearised there
  LinearVehicle(const Model& model, const Eigen::VectorXd& q);

  /// Gives force elements linear laws in the place of theirs near rest.
  /// @param laws  one entry for each force element; an empty one leaves the element as it is near rest
  void set_random_laws(std::vector<RandomLaws> laws);
  const std::vector<RandomLaws>& random_laws() const { return laws_; }  ///< empty: none were given

  const Model& model() const { return equations_.terms().model(); }
  const LinearisedSystem& system() const { return system_; }
  const FrequencySolver& solver() const;  ///< made at the first call
  const std::vector<RoadInput>& inputs() const { return inputs_; }
  /// Kinks of force elements at the equilibrium, where the law has two slopes.
  const std::vector<Kink>& kinks() const { return kinks_; }

  /// At the equilibrium, all markers up to date.
  const PartitionedEquations& equations() const { return equations_; }
  const Eigen::VectorXd& positions() const { return q_; }  ///< nq
  Eigen::VectorXd independent_positions() const;           ///< f
  /// The branches of the force elements there.
  const std::vector<int>& branches() const { return branches_; }
  /// Values of all channels of all force elements at the equilibrium.
  Eigen::VectorXd calc_channels() const;
  /// Index of the first channel of each force element among all channels; the last entry is their number.
  const std::vector<int>& channel_rows() const { return channel_rows_; }

  RoadAction calc_road_action(const RoadWave& wave) const;
  /// The action of one input, as force and torque on the markers of its force element.
  /// @param[out] wrenches  one for each marker of the model; only those of the element are set
  /// @param[out] channels  direct part of the element's channels
  void calc_road_wrenches(std::size_t input, const RoadWave& wave, std::span<WrenchGain> wrenches,
                          Eigen::VectorXcd& channels) const;
  /// Complex amplitudes x of the independent coordinates, q = x e^{iωt}, f×k.
  Eigen::MatrixXcd calc_motion(double omega, const RoadAction& action) const;
  /// Phase of the wave at each input, relative to the foremost one: e^{iκ(s − s_foremost)}. The others meet
  /// the same road later.
  /// @return k
  Eigen::VectorXcd calc_delays(const RoadWave& wave) const;

 private:
  Eigen::VectorXd q_;
  PartitionedEquations equations_;
  LinearisedSystem system_;
  std::vector<RandomLaws> laws_;
  mutable std::optional<FrequencySolver> solver_;
  std::vector<RoadInput> inputs_;
  std::vector<Kink> kinks_;
  std::vector<int> branches_, channel_rows_;
};

/// Slopes of the laws of dampers among some laws, as PartitionedEquations takes them.
std::vector<std::vector<double>> list_rate_slopes(const std::vector<RandomLaws>& laws);

}  // namespace sprung::dynamics
