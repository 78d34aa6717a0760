#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "dynamics/mode_choice/neglect_measure.h"
#include "dynamics/response/linear_vehicle.h"

namespace sprung::dynamics {

/// A mode that may be kept or left out.
struct CandidateMode {
  std::string body;
  int number = 0;             ///< 1-based, in the superelement
  double frequency_hz = 0.0;  ///< of the superelement
  int cluster = 0;            ///< the same for modes of equal frequency of a body
  int coordinate = 0;         ///< of the model with all modes
};

/// Shares of a single mode that is left out: the largest in each group of quantities, by r.m.s. and by peak.
struct ModeWorth {
  struct Pair {
    double rms = 0.0, peak = 0.0;
  };
  Pair displacement, acceleration, force;  ///< `force`: forces, torques, reactions and moments together
  double weight = 0.0;                     ///< under the weight alone, the largest of all quantities
};

struct ModeVerdict {
  CandidateMode mode;
  ModeWorth worth;
  bool is_kept = true;
  std::string reason;  ///< "kept: 12 % of the peak acceleration of chassis.seat"
};

/// The modes that a run needs, as predicted from its forcing.
struct BasisChoice {
  double tolerance = 0.0;                  ///< largest share of all modes left out together
  std::vector<ModeVerdict> verdicts = {};  ///< body after body, ascending
  double neglected = 0.0;                  ///< the largest share of all modes left out together
  std::string neglected_of = {};  ///< "r.m.s. acceleration of chassis.seat"; empty where none is left out
  std::vector<std::string> remarks = {};  ///< what was not taken into account, or kept without being judged

  std::vector<double> frequency_hz =
      {};                     ///< m frequencies of the forcing, for a picture; empty without forcing
  Eigen::VectorXd road = {};  ///< m, |Fourier transform| of the height under the foremost wheel [m/Hz]
  std::vector<std::string> transfer_names = {};  ///< the points asked for
  /// Points×m, acceleration on a road wave of 1 m [m/s²/m]; empty for a vehicle at rest.
  Eigen::MatrixXd transfer = {};

  std::size_t num_kept() const;
};

/// Leaves out clusters of modes, those of the smallest shares first, as long as the share of all that are
/// left out stays below the tolerance (mode_choice, eqs. 1–6; response, eqs. 6, 7). At a tolerance of 0 all
/// modes are kept.
/// @param vehicle    with all candidates active, at its equilibrium
/// @param places     points and sections that are watched
/// @param judged     kinds of quantities that count; where the vehicle has none of them, all modes are kept
/// @param tolerance  ≥ 0, < 1
/// @throws std::invalid_argument for another tolerance
/// Checked by tests/dynamics/mode_choice/basis_choice_test.cpp
BasisChoice choose_basis(const LinearVehicle& vehicle, const std::vector<CandidateMode>& candidates,
                         const JudgedPlaces& places, const JudgedQuantities& judged,
                         const KnownForcing& forcing, double tolerance);

/// Keeps all modes without judging them.
/// @param why  "prescribed motion drives the vehicle"
BasisChoice keep_all(const std::vector<CandidateMode>& candidates, double tolerance, const std::string& why);

}  // namespace sprung::dynamics
