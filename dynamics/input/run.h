#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/adaptivity/mode_adaptation.h"
#include "dynamics/input/mode_selection.h"
#include "dynamics/input/point_reference.h"
#include "dynamics/input/response_input.h"
#include "dynamics/input/road_input.h"
#include "dynamics/input/stiffening_input.h"
#include "dynamics/input/vehicle.h"
#include "dynamics/integration/stepping_options.h"
#include "dynamics/system/model.h"
#include "tools/support/toml/toml.h"

namespace sprung::dynamics {

/// What the start of a run adds to one body's motion, `[initial.BODY]`.
struct InitialMotion {
  Eigen::Vector2d velocity =
      Eigen::Vector2d::Zero();          ///< of the body frame, added to the run's speed, world axes [m/s]
  double angular_velocity = 0.0;        ///< [rad/s]
  std::vector<double> modal_amplitude;  ///< of the active modes, none: 0
  std::vector<double> modal_rate;       ///< [1/s]
  support::SourceLocation location;
};

struct IntegratorSettings {
  SteppingOptions options;
  bool names_method = false;                                      ///< else the method is default_method()
  double largest_step = std::numeric_limits<double>::infinity();  ///< > 0 [s]
};

/// `[adaptivity]`: modes that join and leave during the run.
struct AdaptivitySettings {
  support::SourceLocation location;
  bool enabled = false;
  bool indicator = true;  ///< whether a run with a fixed set is told what it misses
  AdaptivityThresholds thresholds;
  ModeRequests available;  ///< bodies that are not named have all modes of their file
};

/// What a run file says.
struct Run {
  enum class Start {
    kEquilibrium,  ///< static balance, prescribed motion standing still
    kSteady,       ///< balance of what prescribed motion carries along at its rate
    kAsGiven,
  };

  std::string text;                    ///< the file as read
  std::filesystem::path vehicle_path;  ///< made relative to the working folder
  support::SourceLocation vehicle_location;
  double speed = 0.0;  ///< of all bodies along the vehicle's heading at the start [m/s]
  support::SourceLocation speed_location;
  double duration = 0.0;      ///< > 0 [s]
  double output_step = 1e-3;  ///< > 0, ≤ duration [s]
  Start start = Start::kEquilibrium;
  support::SourceLocation start_location;
  double statistics_from = 0.0;  ///< [s]
  double statistics_to = 0.0;    ///< > statistics_from, ≤ duration [s]
  ModeRequests modes;
  ModeChoiceSettings mode_choice;
  DampingRequests modal_damping;
  StiffeningRequests stiffening;
  RoadDescription road;
  IntegratorSettings integrator;
  AdaptivitySettings adaptivity;
  std::map<std::string, InitialMotion> initial;  ///< by body
  std::vector<PointReference> output_points;     ///< none: what the vehicle file monitors
  ResponseRequest response;
};

/// As in run files: "as-given".
std::string_view start_name(Run::Start start);

/// Reads a run file; the vehicle's own file is not opened.
/// @throws support::InputError at the place of whatever does not fit (dynamics/models/README.md lists the
/// keys)
Run read_run(const support::TomlDocument& document);

std::unique_ptr<Road> make_road(const Run& run);
ModeSelection resolve_modes(const Run& run, const Vehicle& vehicle);
/// The modes that may be active: those selected, and with adaptivity the ones available besides.
/// @throws support::InputError as resolve_modes
ModeSelection resolve_available_modes(const Run& run, const ModeSelection& selected, const Vehicle& vehicle);
ModalDamping resolve_modal_damping(const Run& run, const ModeSelection& selection, const Vehicle& vehicle);
StiffenedBodies resolve_stiffening(const Run& run, const ModeSelection& selection, const Vehicle& vehicle);

/// Names of the points whose motion is reported: the run's, else the vehicle's, without repetition.
/// @throws support::InputError at the run's reference to a point that the vehicle lacks
std::vector<std::string> resolve_output_points(const Run& run, const Vehicle& vehicle);
/// Names of the points whose frequency response is reported: those of `[response]`, else the above.
/// @throws support::InputError likewise
std::vector<std::string> resolve_response_points(const Run& run, const Vehicle& vehicle);

/// Adds the run's initial modal amplitudes to q.
/// @throws support::InputError for a body the vehicle lacks, or amplitudes that are not as many as its active
/// modes
void add_initial_amplitudes(const Run& run, const Model& model, Eigen::VectorXd& q);

/// Velocities at the start: all bodies at the run's speed along the vehicle's heading, and what `[initial]`
/// adds. The constraints may ask for others, which is the solver's matter.
/// @return v, model.num_coordinates
/// @throws support::InputError as above
Eigen::VectorXd make_start_velocities(const Run& run, const Vehicle& vehicle, const Model& model);

}  // namespace sprung::dynamics
