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
#include "dynamics/element_input/point_reference.h"
#include "dynamics/input/mode_selection.h"
#include "dynamics/input/output_input.h"
#include "dynamics/input/response_input.h"
#include "dynamics/input/road_input.h"
#include "dynamics/input/stiffening_input.h"
#include "dynamics/input/vehicle.h"
#include "dynamics/integration/stepping_options.h"
#include "dynamics/system/model.h"
#include "tools/support/toml/toml.h"

namespace sprung::dynamics {

/// What a run adds to the initial motion of one body, `[initial.BODY]`.
struct InitialMotion {
  Eigen::Vector2d velocity =
      Eigen::Vector2d::Zero();          ///< of the body frame, added to the run's speed, world axes [m/s]
  double angular_velocity = 0.0;        ///< [rad/s]
  std::vector<double> modal_amplitude;  ///< one for each active mode; if empty, 0
  std::vector<double> modal_rate;       ///< [1/s]
  support::SourceLocation location;
};

/// An entry of `[joint_rates]`: the rate of a joint's coordinate at the start.
struct JointRateRequest {
  std::string joint;  ///< its name
  double rate = 0.0;  ///< [m/s, rad/s]
  support::SourceLocation location;
};

struct IntegratorSettings {
  SteppingOptions options;
  bool names_method = false;                                      ///< otherwise default_method() is used
  double largest_step = std::numeric_limits<double>::infinity();  ///< > 0 [s]
};

/// `[adaptivity]`: modes that join and leave during the run.
struct AdaptivitySettings {
  support::SourceLocation location;
  bool enabled = false;
  bool indicator = true;  ///< whether a run with a fixed set estimates the effect of the modes left out
  AdaptivityThresholds thresholds;
  ModeRequests available;  ///< for a body that is not named, all modes of its superelement
};

/// The contents of a run file.
struct Run {
  enum class Start {
    kEquilibrium,  ///< static equilibrium, prescribed motion kept at its initial value
    kSteady,       ///< equilibrium relative to a prescribed motion at its initial rate
    kAsGiven,      ///< the positions of the vehicle file
  };

  std::string text;                    ///< the file as read
  std::filesystem::path vehicle_path;  ///< made relative to the working folder
  support::SourceLocation vehicle_location;
  double speed = 0.0;      ///< of all bodies along the vehicle's heading at the start [m/s]
  bool has_speed = false;  ///< it is given
  support::SourceLocation speed_location;
  double duration = 0.0;  ///< time at the end, > 0 [s]
  support::SourceLocation duration_location;
  double output_step = 1e-3;  ///< > 0, ≤ duration [s]
  Start start = Start::kEquilibrium;
  support::SourceLocation start_location;
  std::filesystem::path continue_from;  ///< results file with whose last state the run starts; "" for none
  support::SourceLocation continue_location;
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
  std::vector<JointRateRequest> joint_rates;     ///< in the order of the file
  OutputSettings output;
  ResponseRequest response;
};

/// The name that a run file uses: "as-given".
std::string_view start_name(Run::Start start);

/// Reads a run file (dynamics/models/README.md lists the keys). The vehicle file is not opened.
/// @throws support::InputError at the first key or value that is wrong
/// Checked by tests/dynamics/input/run_test.cpp
Run read_run(const support::TomlDocument& document);

ModeSelection resolve_modes(const Run& run, const Vehicle& vehicle);
/// The modes that may become active: those selected and, with adaptivity, the others that are available.
/// @throws support::InputError as resolve_modes
ModeSelection resolve_available_modes(const Run& run, const ModeSelection& selected, const Vehicle& vehicle);

/// @return why the last output of a run that begins at this time [s] is before its end; "" where it is not
/// Checked by tests/dynamics/input/run_test.cpp
std::string describe_early_end(const Run& run, double start_time);

/// Names of the points whose motion is reported: the run's, else the vehicle's, without repetition.
/// @throws support::InputError at a reference to a point that the vehicle lacks, or to anything in
///         `[output.store]`
std::vector<std::string> resolve_output_points(const Run& run, const Vehicle& vehicle);
/// Names of the points whose frequency response is reported: those of `[response]`, else those of
/// resolve_output_points.
/// @throws support::InputError likewise
std::vector<std::string> resolve_response_points(const Run& run, const Vehicle& vehicle);

/// Adds the run's initial modal amplitudes to q.
/// @throws support::InputError for a body that the vehicle lacks, or for a number of amplitudes that is not
///         that of its active modes
/// Checked by tests/dynamics/input/run_test.cpp
void add_initial_amplitudes(const Run& run, const Model& model, Eigen::VectorXd& q);

/// Velocities at the start: all bodies at the run's speed along the vehicle's heading, and what `[initial]`
/// adds. They may violate the constraints; project_velocities (dynamics/linear/assembly.h) corrects them.
/// @return v, model.num_coordinates
/// @throws support::InputError as add_initial_amplitudes
/// Checked by tests/dynamics/input/run_test.cpp
Eigen::VectorXd make_start_velocities(const Run& run, const Vehicle& vehicle, const Model& model);

}  // namespace sprung::dynamics
