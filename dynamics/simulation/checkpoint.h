#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>

#include "dynamics/simulation/transient_statistics.h"
#include "dynamics/system/model.h"
#include "tools/support/files/bytes.h"

namespace sprung::dynamics {

/// Everything that a run needs to continue from the end of a step (simulation, "Checkpoints").
struct Checkpoint {
  State start;  ///< of the run
  State state;
  SystemStepper::EnergyFlow flow;  ///< since the start [J]
  TransientStatistics statistics;  ///< since the start
  double active_mode_time = 0.0;   ///< Σ active modes × time since the start [s]
  long next_output = 0;            ///< number of the first output after it
  double last_switch = -std::numeric_limits<double>::infinity();  ///< time [s]
  int switches_in_place = 0;                                      ///< up to the last one
  std::optional<KnownMotion> small_motion;                        ///< of the stepper, if its method uses it
  std::string monitor;  ///< bytes of the ModeMonitor, "" without one

  /// Whether its states have the sizes of a model's.
  bool fits(const Model& model) const {
    const auto has_sizes = [&model](const State& one) {
      return one.q.size() == model.num_coordinates && one.v.size() == model.num_coordinates &&
             one.branches.size() == static_cast<std::size_t>(model.num_branches);
    };
    return has_sizes(start) && has_sizes(state);
  }
};

template <class Bytes, class Matrix>
void transfer_square_matrix(Bytes& bytes, Matrix& matrix) {
  Eigen::VectorXd values = matrix.reshaped();
  bytes.transfer(values);
  const auto size = static_cast<Eigen::Index>(std::lround(std::sqrt(static_cast<double>(values.size()))));
  if (size * size != values.size()) throw support::DamagedBytes();
  if constexpr (!std::is_const_v<Matrix>) matrix = values.reshaped(size, size);
}

template <class Bytes, class Motion>
void transfer_small_motion(Bytes& bytes, Motion& motion) {
  bool is_there = motion.has_value();
  bytes.transfer(is_there);
  if (!is_there) return;
  if constexpr (!std::is_const_v<Motion>) motion.emplace();
  bytes.transfer_items(motion->independent, [&](auto& coordinate) { bytes.transfer(coordinate); });
  for (auto* matrix : {&motion->motion.mass, &motion->motion.damping, &motion->motion.stiffness})
    transfer_square_matrix(bytes, *matrix);
}

/// The checkpoint as bytes, or back. @tparam Bytes  ByteWriter with a constant checkpoint, or ByteReader
template <class Bytes, class Value>
void transfer_checkpoint(Bytes& bytes, Value& checkpoint) {
  const auto transfer = [&bytes](auto&... values) { (bytes.transfer(values), ...); };
  for (auto* state : {&checkpoint.start, &checkpoint.state}) {
    transfer(state->time, state->q, state->v);
    bytes.transfer_items(state->branches, transfer);
  }
  transfer(checkpoint.flow.dissipated, checkpoint.flow.input);
  auto& statistics = checkpoint.statistics;
  auto& integrator = statistics.stepper.integrator;
  transfer(integrator.steps, integrator.error_test_failures, integrator.iteration_failures,
           integrator.restarts);
  transfer(statistics.stepper.evaluations, statistics.stepper.repartitions,
           statistics.stepper.velocity_violation);
  transfer(statistics.output_evaluations, statistics.switches, statistics.mode_changes);
  transfer_small_motion(bytes, checkpoint.small_motion);
  transfer(checkpoint.active_mode_time, checkpoint.next_output, checkpoint.last_switch,
           checkpoint.switches_in_place, checkpoint.monitor);
}

}  // namespace sprung::dynamics
