#include "dynamics/adaptivity/missing_motion.h"

#include <array>
#include <cmath>

#include "dynamics/linear/first_order_form.h"
#include "tools/support/dense/dense_solvers.h"
#include "tools/support/dense/eigenproblems.h"
#include "tools/support/dense/wide_product.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr double kSmall = 0.5;         // |μh| below which the series are summed
constexpr double kEqualStep = 1e-9;    // relative: times of equal steps differ by rounding
constexpr int kTerms = 14;             // of them: 1e-16
constexpr double kWorstBasis = 1e-13;  // reciprocal condition of eigenvectors

using Complex = std::complex<double>;

// Product of finite numbers: that of the standard looks for infinity and NaN.
Complex times(Complex a, Complex b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

// φ_1 … φ_4 of z: φ_1 = (e^z − 1)/z, φ_k+1 = (φ_k − 1/k!)/z.
std::array<Complex, 5> calc_phi(Complex z) {
  std::array<Complex, 5> phi{std::exp(z)};
  const double square = std::norm(z);
  if (square >= kSmall * kSmall) {
    const Complex inverse = std::conj(z) / square;
    phi[1] = times(phi[0] - 1.0, inverse);
    phi[2] = times(phi[1] - 1.0, inverse);
    phi[3] = times(phi[2] - 0.5, inverse);
    phi[4] = times(phi[3] - 1.0 / 6.0, inverse);
    return phi;
  }
  double factorial = 1.0;
  for (std::size_t k = 1; k < phi.size(); ++k) {
    factorial *= static_cast<double>(k);
    Complex term = 1.0 / factorial, sum = term;
    for (int i = 1; i < kTerms; ++i) {
      term = times(term, z) / static_cast<double>(k + static_cast<std::size_t>(i));
      sum += term;
    }
    phi[k] = sum;
  }
  return phi;
}

// With s the share of the step h that has passed, ∫ of the force as the cubic F + h (b s + (3c − 2b − e) s² +
// (b + e − 2c) s³): what ζ, F, b, c and e are multiplied by.
std::array<Complex, 5> calc_step_weights(Complex rate, double h) {
  const std::array<Complex, 5> phi = calc_phi(rate * h);
  const Complex second = 2.0 * phi[3], third = 6.0 * phi[4];
  return {phi[0], h * phi[1], h * h * (phi[2] - 2.0 * second + third), h * h * (3.0 * second - 2.0 * third),
          h * h * (third - second)};
}

}  // namespace

MissingMotion::MissingMotion(const FullSmallMotion& motion, const MissingStart& start)
    : start_(start), coordinates_(motion.independent()) {
  const auto num_rows = static_cast<Eigen::Index>(2 * motion.num_points());
  accelerations_ = Eigen::VectorXd::Zero(num_rows);
  Eigen::MatrixXd of_points(num_rows, motion.motion().mass.rows());
  for (std::size_t i = 0; i < motion.num_points(); ++i)
    of_points.middleRows<2>(static_cast<Eigen::Index>(2 * i)) = motion.reduced_motion(i);
  if (motion.motion().mass.rows() == 0 ||
      !take(motion.motion(), motion.stiffness_rounding(), motion.modal_motion(), of_points))
    take_lone_modes(motion);
}

// Where small motion or its eigenvectors are not known each mode vibrates alone.
void MissingMotion::take_lone_modes(const FullSmallMotion& motion) {
  const auto num_modes = static_cast<Eigen::Index>(motion.modal_coordinates().size());
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(num_modes, num_modes);
  SmallMotion small{zero, zero, zero};
  Eigen::MatrixXd of_points(accelerations_.size(), num_modes);
  for (Eigen::Index j = 0; j < num_modes; ++j) {
    const int coordinate = motion.modal_coordinates()[static_cast<std::size_t>(j)];
    const auto place = motion.model().body_coordinate(coordinate);
    const Body& body = motion.model().bodies[static_cast<std::size_t>(place.body)];
    const Eigen::Index k = coordinate - body.first_coordinate - 3;
    small.mass(j, j) = body.M_ff(k, k);
    small.damping(j, j) = body.damping(k, k);
    small.stiffness(j, j) = body.stiffness(k, k);
    for (std::size_t i = 0; i < motion.num_points(); ++i)
      of_points.block<2, 1>(static_cast<Eigen::Index>(2 * i), j) = motion.point_motion(i).col(coordinate);
  }
  start_.rates.resize(0);
  coordinates_ = motion.modal_coordinates();
  if (!take(small, zero, Eigen::MatrixXd::Identity(num_modes, num_modes), of_points))
    throw support::NumericalError("the damped modes of small motion were not found");
}

bool MissingMotion::take(const SmallMotion& small, const Eigen::MatrixXd& rounding,
                         const Eigen::MatrixXd& of_modes, const Eigen::MatrixXd& of_points) {
  const FirstOrderForm form = make_first_order_form(small.mass, small.damping, small.stiffness, rounding);
  const auto pairs = support::solve_general(form.A);
  const Eigen::Index n = form.num_bound(), f = form.V.cols(), size = form.A.rows();
  if (!pairs) return false;
  vectors_ = support::factorise_lu(pairs->real_vectors);
  if (size > 0 && vectors_.reciprocal_condition < kWorstBasis) return false;
  growth_ = has_growth(pairs->values) ? pairs->values.real().maxCoeff() : 0.0;
  for (Eigen::Index i = 0; i < size; ++i) {
    const Complex value = pairs->values[i];
    const bool is_pair = value.imag() != 0.0;
    parts_.push_back({.rate = std::conj(value), .column = i, .is_pair = is_pair});
    if (is_pair) ++i;
  }
  state_.terms.resize(parts_.size());
  Eigen::MatrixXd inputs = Eigen::MatrixXd::Zero(size, of_modes.rows());
  inputs.bottomRows(f) = form.V.transpose() * of_modes.transpose();
  forcing_ = vectors_.solve(inputs);
  const Eigen::MatrixXd by_motion = of_points * form.V;
  to_accelerations_.resize(by_motion.rows(), size + of_modes.rows());
  to_accelerations_ << by_motion * form.A.bottomRows(f) * pairs->real_vectors,
      by_motion * inputs.bottomRows(f);
  static_states_ = Eigen::MatrixXd::Zero(size, of_modes.rows());
  static_states_.topRows(n) = form.scale.cwiseInverse().asDiagonal() * inputs.bottomRows(n);
  rate_states_ = Eigen::MatrixXd::Zero(size, f);
  rate_states_.bottomRows(f) = form.V.transpose() * small.mass;
  driving_ = Eigen::VectorXd::Zero(size);
  places_and_forces_ = Eigen::VectorXd::Zero(size + of_modes.rows());
  return true;
}

Complex MissingMotion::select(const Eigen::VectorXd& values, const Part& part) const {
  return {values[part.column], part.is_pair ? values[part.column + 1] : 0.0};
}

void MissingMotion::begin(const Eigen::VectorXd& forces, const Eigen::VectorXd& v) {
  Eigen::VectorXd states = Eigen::VectorXd::Zero(driving_.size());
  if (start_.is_balanced) states = static_states_ * forces;
  const Eigen::VectorXd places = vectors_.solve(states);
  for (std::size_t i = 0; i < parts_.size(); ++i) state_.terms[i].place = select(places, parts_[i]);
  if (start_.rates.size() > 0) add_rates(start_.rates - v);
  state_.has_begun = true;
}

void MissingMotion::add_rates(const Eigen::VectorXd& change) {
  const Eigen::VectorXd places = vectors_.solve(rate_states_ * change(coordinates_));
  for (std::size_t i = 0; i < parts_.size(); ++i) state_.terms[i].place += select(places, parts_[i]);
}

void MissingMotion::update(double step, const Eigen::VectorXd& forces, const Eigen::VectorXd& v) {
  if (!state_.has_begun) begin(forces, v);
  support::multiply(forcing_, forces.data(), driving_.data());
  const double last_step = state_.last_step;
  const bool knows_slopes = last_step > 0.0;
  if (step > 0.0 && std::abs(step - weighted_step_) > kEqualStep * step) {
    for (Part& part : parts_) part.weights = calc_step_weights(part.rate, step);
    weighted_step_ = step;
  }
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Part& part = parts_[i];
    Term& term = state_.terms[i];
    const Complex force = select(driving_, part);
    if (step > 0.0) {
      // The force as a cubic, without kinks between steps, which would excite stiff vibrations: its slope at
      // the end is that of the parabola through the last three values.
      const Complex chord = (force - term.force) / step;
      const Complex begin = knows_slopes ? term.slope : chord;
      const Complex end = knows_slopes ? chord + step / (step + last_step) * (chord - term.chord) : chord;
      const auto& [of_place, of_force, of_begin, of_chord, of_end] = part.weights;
      term.place = times(of_place, term.place) + times(of_force, term.force) + times(of_begin, begin) +
                   times(of_chord, chord) + times(of_end, end);
      term.chord = chord;
      term.slope = end;
    }
    term.force = force;
    places_and_forces_[part.column] = term.place.real();
    if (part.is_pair) places_and_forces_[part.column + 1] = term.place.imag();
  }
  state_.last_step = step;
  places_and_forces_.tail(forces.size()) = forces;
  support::multiply(to_accelerations_, places_and_forces_.data(), accelerations_.data());
}

}  // namespace sprung::dynamics
