#include "dynamics/system/change_point.h"

#include <algorithm>
#include <cmath>

#include "dynamics/system/dependent_solver.h"

namespace sprung::dynamics {

namespace {

// Lengths tried, of the time in which the fastest coordinate moves by its natural size.
constexpr double kShortest = 1e-6, kLongest = 2e-2, kGrowth = 1.3;
constexpr int kCorrections = 2;
// How far the determinant has to fall for a change point to lie within the step, and how far it may still be
// below the determinant of the beginning where the step ends.
constexpr double kFallen = 2.0, kRecovered = 1.1;
constexpr double kGrown = 2.0;  // the smallest pivot, where the step leaves a change point that lies behind
constexpr double kNear = 1e-5;  // of the natural size: how far joints may be open before they are closed

void read(const ConstrainedEquations& equations, ChangePointStep::End& end) {
  end.time = equations.terms().time();
  end.q = equations.q();
  end.v = equations.v();
  end.v_dot = equations.v_dot();
  end.lambda = equations.multipliers();
  const Power& power = equations.terms().power();
  end.power = {power.dissipated, power.input};
}

}  // namespace

ChangePointStep::ChangePointStep(const Model& model)
    : model_(&model), equations_(model, SystemTerms::Markers::kActing) {}

bool ChangePointStep::close(double time, std::span<const int> branches) {
  if (!equations_.close_joints(time, q_)) return false;
  for (int i = 0; i < model_->num_coordinates; ++i) {
    if (!(std::abs(equations_.q()[i] - q_[i]) <= kNear * model_->coordinate_scale(i))) return false;
  }
  return std::isfinite(equations_.close_rates(v_)) && equations_.update_accelerations(branches);
}

bool ChangePointStep::pass(const ConstrainedEquations& from, const Partition& partition,
                           std::span<const int> branches, double longest) {
  read(from, begin_);
  const double rate = model_->largest_natural(begin_.v);
  if (!(rate > 0.0)) return false;
  DependentSolver dependents(from.terms().jacobian(), partition, model_->num_coordinates);
  dependents.factorise(from.terms().jacobian());
  dependents.set_reference();
  bool has_fallen = false;
  for (double length = kShortest / rate; length <= std::min(longest, kLongest / rate); length *= kGrowth) {
    const double time = begin_.time + length;
    q_ = begin_.q + length * begin_.v + 0.5 * length * length * begin_.v_dot;
    v_ = begin_.v + length * begin_.v_dot;
    if (!close(time, branches)) continue;
    dependents.factorise(equations_.terms().jacobian());
    const double decay = dependents.decay();
    has_fallen = has_fallen || decay > kFallen || dependents.is_mirrored();
    const bool is_beyond =
        has_fallen ? decay <= kRecovered
                   : choose_partition(equations_.terms()).smallest_pivot >= kGrown * partition.smallest_pivot;
    if (is_beyond) return correct(time, branches);
  }
  return false;
}

// By the accelerations at the end; only motion at the ends is evaluated.
bool ChangePointStep::correct(double time, std::span<const int> branches) {
  const double length = time - begin_.time;
  for (int i = 0; i < kCorrections; ++i) {
    q_ = begin_.q + 0.5 * length * (begin_.v + equations_.v()) +
         length * length / 12.0 * (begin_.v_dot - equations_.v_dot());
    v_ = begin_.v + 0.5 * length * (begin_.v_dot + equations_.v_dot());
    if (!close(time, branches)) return false;
  }
  read(equations_, end_);
  const double motion = equations_.calc_motion_power();
  end_.power[1] += motion;
  begin_.power[1] +=
      motion;  // the multipliers of the beginning are not ours; over so short a time they are as good
  return true;
}

Eigen::Vector2d ChangePointStep::calc_work(double time) const {
  const double since = time - begin_.time, share = since / (end_.time - begin_.time);
  return since * (begin_.power + 0.5 * share * (end_.power - begin_.power));
}

void ChangePointStep::interpolate(double time, End& at) const {
  const double length = end_.time - begin_.time, s = (time - begin_.time) / length;
  const double e = s * s * (3.0 - 2.0 * s), d = length * s * (1.0 - s);
  at.time = time;
  at.q = (1.0 - e) * begin_.q + e * end_.q + d * ((1.0 - s) * begin_.v - s * end_.v);
  at.v = (1.0 - e) * begin_.v + e * end_.v + d * ((1.0 - s) * begin_.v_dot - s * end_.v_dot);
  at.v_dot = (1.0 - s) * begin_.v_dot + s * end_.v_dot;
  at.lambda = (1.0 - s) * begin_.lambda + s * end_.lambda;
}

}  // namespace sprung::dynamics
