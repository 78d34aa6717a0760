#include "dynamics/output/last_state.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "dynamics/output/results_writer.h"
#include "dynamics/system/system_terms.h"
#include "tools/support/errors/input_error.h"
#include "tools/support/hdf5/hdf5_file.h"

namespace sprung::dynamics {

namespace {

constexpr double kOpenJoint = 1e-6;  // natural sizes; results are closed to 1e-12

std::vector<std::string> list_coordinates(const Model& model) {
  std::vector<std::string> names;
  for (int i = 0; i < model.num_coordinates; ++i) names.push_back(model.coordinate_name(i));
  return names;
}

[[noreturn]] void fail(const support::Hdf5Reader& file, const std::string& what) {
  throw support::InputError({.path = file.path().string()}, what);
}

support::Hdf5Reader open_results(const std::filesystem::path& path) {
  support::Hdf5Reader file(path);
  if (!file.has_attribute("/", "format") || file.string_attribute("/", "format") != kResultsFormat)
    fail(file, "is no results file");
  return file;
}

// The last row of a time history.
Eigen::VectorXd read_last_row(const support::Hdf5Reader& file, const std::string& dataset, std::size_t rows,
                              Eigen::Index size) {
  const std::vector<double> row = file.real_rows(dataset, rows - 1, 1);
  if (static_cast<Eigen::Index>(row.size()) != size) {
    fail(file, fmt::format("dataset '{}' must have {} columns, has {}", dataset, size, row.size()));
  }
  return Eigen::Map<const Eigen::VectorXd>(row.data(), size);
}

void check_modes(const support::Hdf5Reader& file, const Body& body) {
  const std::string dataset = "/bodies/" + body.name + "/modal/mode_number";
  std::vector<std::int64_t> found;
  if (file.has(dataset)) found = file.integers(dataset, {-1});
  const std::vector<std::int64_t> wanted(body.mode_numbers.begin(), body.mode_numbers.end());
  if (found == wanted) return;
  const auto list = [](const std::vector<std::int64_t>& numbers) {
    return numbers.empty() ? std::string("no modes") : fmt::format("modes {}", fmt::join(numbers, ", "));
  };
  fail(file, fmt::format("has {} of body '{}', this run has {}; a run continues with the same modes",
                         list(found), body.name, list(wanted)));
}

void check_joints(const support::Hdf5Reader& file, const Model& model, const State& state) {
  if (model.num_constraints == 0) return;
  SystemTerms terms(model);
  terms.update_positions(state.time, state.q);
  Eigen::VectorXd phi(model.num_constraints);
  terms.calc_residual(phi);
  const double open = phi.lpNorm<Eigen::Infinity>();
  if (open <= kOpenJoint * std::min(1.0, model.length_scale)) return;
  fail(file, fmt::format("its last positions leave a joint open by {:.3g}: it is of another vehicle", open));
}

// Files of programs that stored all histories in double precision have the last state in their last rows.
State read_last_rows(const support::Hdf5Reader& file, const Model& model) {
  const auto rows = static_cast<std::size_t>(file.shape("/time").at(0));
  if (rows == 0) fail(file, "has no outputs");
  State state{.time = file.real_rows("/time", rows - 1, 1)[0],
              .q = Eigen::VectorXd::Zero(model.num_coordinates),
              .v = Eigen::VectorXd::Zero(model.num_coordinates),
              .branches = {}};
  for (const Body& body : model.bodies) {
    const std::string group = "/bodies/" + body.name;
    const int first = body.first_coordinate, num_modes = body.num_modes();
    state.q.segment(first, 3) = read_last_row(file, group + "/position", rows, 3);
    state.v.segment(first, 3) = read_last_row(file, group + "/velocity", rows, 3);
    if (num_modes == 0) continue;
    state.q.segment(first + 3, num_modes) = read_last_row(file, group + "/modal/amplitude", rows, num_modes);
    state.v.segment(first + 3, num_modes) = read_last_row(file, group + "/modal/rate", rows, num_modes);
  }
  return state;
}

// The coordinates go by their names, so that bodies and force elements may stand in another order. A force
// element that the file does not know starts with its states at rest. A state keeps its share of its natural
// size, so that friction is no larger than its full value where that has changed.
State read_stored_state(const support::Hdf5Reader& file, const Model& model) {
  const std::vector<std::string> wanted = list_coordinates(model);
  std::vector<std::string> found;
  if (file.has("/last_state/name")) {
    found = file.strings("/last_state/name", {-1});
  } else {  // of a program that knew no internal states
    found.assign(wanted.begin(), wanted.begin() + model.first_state());
  }
  const auto size = static_cast<std::int64_t>(found.size());
  const std::vector<double> coordinates = file.reals("/last_state/coordinates", {size}),
                            velocities = file.reals("/last_state/velocities", {size});
  std::vector<double> state_sizes;
  if (file.has("/last_state/state_size")) state_sizes = file.reals("/last_state/state_size", {-1});
  const bool are_sizes =
      std::all_of(state_sizes.begin(), state_sizes.end(), [](double one) { return one > 0.0; });
  if (!are_sizes || state_sizes.size() > found.size())
    fail(file, "dataset '/last_state/state_size' must have a size > 0 for each of the last coordinates");
  const std::size_t first_state = found.size() - state_sizes.size();
  State state{.time = file.reals("/last_state/time", {1})[0],
              .q = Eigen::VectorXd::Zero(model.num_coordinates),
              .v = Eigen::VectorXd::Zero(model.num_coordinates),
              .branches = {}};
  for (int i = 0; i < model.num_coordinates; ++i) {
    const int own_state = i - model.first_state();
    const auto place = std::find(found.begin(), found.end(), wanted[static_cast<std::size_t>(i)]);
    const auto j = static_cast<std::size_t>(place - found.begin());
    if (place == found.end() || (own_state >= 0 && j < first_state)) {
      if (own_state >= 0) continue;
      fail(file, fmt::format("its last state lacks '{}'", wanted[static_cast<std::size_t>(i)]));
    }
    const double factor =
        own_state < 0 ? 1.0
                      : model.states[static_cast<std::size_t>(own_state)].size / state_sizes[j - first_state];
    state.q[i] = factor * coordinates[j];
    state.v[i] = factor * velocities[j];
  }
  return state;
}

}  // namespace

void make_last_state(support::Hdf5Writer& file, const Model& model) {
  file.write("/last_state/name", list_coordinates(model));
  std::vector<double> sizes;
  for (const InternalState& state : model.states) sizes.push_back(state.size);
  if (!sizes.empty()) file.write("/last_state/state_size", sizes, "J^0.5, J^0.5/m");
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(model.num_coordinates);
  file.write("/last_state/time", std::vector<double>{0.0}, "s");
  file.write("/last_state/coordinates", zero, "m, rad, kg^0.5 m");
  file.write("/last_state/velocities", zero, "m/s, rad/s, kg^0.5 m/s");
}

void write_last_state(support::Hdf5Writer& file, const State& state) {
  file.overwrite("/last_state/time", std::vector<double>{state.time});
  const auto size = static_cast<std::size_t>(state.q.size());
  file.overwrite("/last_state/coordinates", {state.q.data(), size});
  file.overwrite("/last_state/velocities", {state.v.data(), size});
}

double read_run_speed(const std::filesystem::path& results) {
  return open_results(results).real_attribute("/model", "speed");
}

State read_last_state(const std::filesystem::path& results, const Model& model) {
  const support::Hdf5Reader file = open_results(results);
  for (const Body& body : model.bodies) {
    const std::string group = "/bodies/" + body.name;
    if (!file.has(group)) fail(file, fmt::format("has no body '{}', which the vehicle has", body.name));
    check_modes(file, body);
  }
  State state = file.has("/last_state/time") ? read_stored_state(file, model) : read_last_rows(file, model);
  state.branches.resize(static_cast<std::size_t>(model.num_branches));
  check_joints(file, model, state);
  return state;
}

}  // namespace sprung::dynamics
