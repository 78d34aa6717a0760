#include "dynamics/analysis/mode_changes.h"

#include <algorithm>

#include "tools/support/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr double kPeriodsOfRelease = 4.0;  // over which what was held is let go

// What the indicator refers to at the start: the full model, in which modes that the run lacks stand at zero.
State expand(const Model& model, const AdaptivityOptions& options, const State& start) {
  if (options.changes) return start;
  State full{.time = start.time, .q = Eigen::VectorXd::Zero(options.full->num_coordinates), .v = {}, .branches = {}};
  put_active(match_modes(model, *options.full), start.q, full.q);
  return full;
}

}  // namespace

struct ModeChanges::Memory {
  std::shared_ptr<const ModeAdaptation::Memory> modes;
  Eigen::VectorXd q, v;
};

ModeChanges::ModeChanges(const Model& model, const AdaptivityOptions& options, const State& start)
    : model_(&model), modes_(options, expand(model, options, start)) {
  q_ = v_ = v_dot_ = Eigen::VectorXd::Zero(options.full->num_coordinates);
  if (options.changes) {
    q_ = start.q;
    v_ = start.v;
    full_terms_.emplace(model);
    hold(start.time);
  } else {
    held_ = match_modes(model, *options.full);
  }
}

// From q_ and v_ on, with the modes that are active now.
void ModeChanges::hold(double time) {
  held_ = hold_modes(*model_, modes_.active(), q_);
  std::erase_if(fading_, [&](const FadingForce& one) {
    return time >= one.start + one.duration || !modes_.active()[static_cast<std::size_t>(one.mode)];
  });
  for (FadingForce fading : fading_) {
    const auto place = std::lower_bound(held_.coordinates.begin(), held_.coordinates.end(), fading.mode);
    const int coordinate = static_cast<int>(place - held_.coordinates.begin());
    const auto body = std::find_if(held_.model.bodies.begin(), held_.model.bodies.end(), [&](const Body& one) {
      return coordinate < one.first_coordinate + one.num_coordinates();
    });
    fading.mode = coordinate - body->first_coordinate - 3;
    body->fading.push_back(fading);
  }
}

State ModeChanges::stepped_state(double time, const std::vector<int>& branches) const {
  return {.time = time, .q = select_active(held_, q_), .v = select_active(held_, v_), .branches = branches};
}

void ModeChanges::take(const ConstrainedEquations& equations) {
  v_.setZero();
  v_dot_.setZero();
  put_active(held_, equations.q(), q_);
  put_active(held_, equations.v(), v_);
  put_active(held_, equations.v_dot(), v_dot_);
}

void ModeChanges::update(double time, const ConstrainedEquations& equations, std::span<const int> branches) {
  take(equations);
  modes_.update(time, q_, v_, v_dot_, equations.multipliers(), branches);
}

const SystemTerms& ModeChanges::calc_full_terms(double time) {
  full_terms_->update_positions(time, q_);
  full_terms_->update_jacobian();
  full_terms_->update_mass();
  full_terms_->update_velocities(v_);
  return *full_terms_;
}

std::shared_ptr<const ModeChanges::Memory> ModeChanges::remember() const {
  return std::make_shared<const Memory>(Memory{modes_.remember(), q_, v_});
}

void ModeChanges::join(const Memory& memory, double time, const std::vector<int>& coordinates) {
  modes_.go_back(*memory.modes);
  q_ = memory.q;
  v_ = memory.v;
  for (const int coordinate : coordinates) {
    const double frequency = modes_.frequency_of(coordinate);
    if (frequency > 0.0) {
      fading_.push_back({coordinate, -modes_.unbalanced_force_of(coordinate), time, kPeriodsOfRelease / frequency});
    }
  }
  modes_.activate(coordinates);
  hold(time);
}

double ModeChanges::leave(double time, const std::vector<int>& coordinates, std::span<const int> branches) {
  const SystemTerms& before = calc_full_terms(time);
  const double energy = calc_energy(before, branches).total();
  Eigen::VectorXd momentum(model_->num_coordinates);
  for (std::size_t b = 0; b < model_->bodies.size(); ++b) {
    const Body& body = model_->bodies[b];
    momentum.segment(body.first_coordinate, body.num_coordinates()) =
        before.mass(b) * v_.segment(body.first_coordinate, body.num_coordinates());
  }
  modes_.deactivate(coordinates);
  for (const int coordinate : coordinates) v_[coordinate] = v_dot_[coordinate] = 0.0;
  hold(time);

  // An impulse on the modes that leave, and on no other coordinate, stops them: M v of the others stays, but for what
  // the joints do.
  ConstrainedEquations equations(held_.model, SystemTerms::Markers::kActing);
  if (!equations.close_joints(time, select_active(held_, q_))) {
    throw support::NumericalError("the joints cannot be closed where modes leave");
  }
  Eigen::VectorXd v = select_active(held_, momentum);
  equations.terms().update_mass();
  for (std::size_t b = 0; b < held_.model.bodies.size(); ++b) {
    equations.terms().masses()[b].solve(v.data() + held_.model.bodies[b].first_coordinate);
  }
  equations.close_rates(v);
  put_active(held_, equations.q(), q_);
  put_active(held_, equations.v(), v_);
  return energy - calc_energy(calc_full_terms(time), branches).total();
}

}  // namespace sprung::dynamics
