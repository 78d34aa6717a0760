#include "dynamics/response/harmonic_sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "dynamics/linear/undamped_modes.h"
#include "tools/support/dense/dense_solvers.h"
#include "tools/support/dense/eigenproblems.h"
#include "tools/support/dense/orthogonal_factors.h"

namespace sprung::dynamics {

namespace {

using RealRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double kWorstVectors = 1e-9;  // reciprocal condition of eigenvectors; results are accurate to 1e-6
constexpr Eigen::Index kAtOnce = 256;   // frequencies

// Eigenvectors in real form; both columns of a pair have the same scale.
Eigen::MatrixXd normalise(const support::GeneralEigenpairs& eigen) {
  Eigen::MatrixXd T = eigen.real_vectors;
  for (Eigen::Index i = 0; i < T.cols(); ++i) {
    const Eigen::Index count = eigen.values[i].imag() == 0.0 ? 1 : 2;
    T.middleCols(i, count) /= T.middleCols(i, count).norm();
    i += count - 1;
  }
  return T;
}

// Solves (s − [a b; −b a]) u = r in place, in the rows from `row` on, with s = iω for one ω per column or one
// for all columns. The block has one row where b = 0.
void solve_block(double a, double b, const Eigen::VectorXd& omega, RowsXcd& r, Eigen::Index row) {
  std::complex<double> difference, inverse;
  const auto set_frequency = [&](double w) {
    difference = {-a, w};
    // The inverse of (s − a)² + b², or of s − a where b = 0.
    const double re = b == 0.0 ? -a : a * a - w * w + b * b, im = b == 0.0 ? w : -2.0 * a * w;
    const double size = re * re + im * im;
    inverse = {re / size, -im / size};
  };
  const auto times = [](std::complex<double> x, std::complex<double> y) {  // finite, so without a check
    return std::complex<double>(x.real() * y.real() - x.imag() * y.imag(),
                                x.real() * y.imag() + x.imag() * y.real());
  };
  if (omega.size() == 1) set_frequency(omega[0]);
  for (Eigen::Index i = 0; i < r.cols(); ++i) {
    if (omega.size() > 1) set_frequency(omega[i]);
    const std::complex<double> first = r(row, i);
    if (b == 0.0) {
      r(row, i) = times(first, inverse);
      continue;
    }
    const std::complex<double> second = r(row + 1, i);
    r(row, i) = times(times(difference, first) + b * second, inverse);
    r(row + 1, i) = times(times(difference, second) - b * first, inverse);
  }
}

}  // namespace

RowsXcd multiply_real_complex(const Eigen::MatrixXd& A, const RowsXcd& X) {
  RowsXcd product(A.rows(), X.cols());
  if (A.size() == 0 || X.size() == 0) {
    product.setZero();
    return product;
  }
  const Eigen::Map<const RealRows> right(reinterpret_cast<const double*>(X.data()), X.rows(), 2 * X.cols());
  Eigen::Map<RealRows>(reinterpret_cast<double*>(product.data()), A.rows(), 2 * X.cols()).noalias() =
      A * right;
  return product;
}

DrivenSystem make_held_system(const LinearVehicle& vehicle, const LinearOutputs& outputs,
                              const std::vector<int>& coordinates) {
  const LinearisedSystem& full = vehicle.system();
  const Eigen::Index f = full.mass.rows();
  Eigen::MatrixXd free = Eigen::MatrixXd::Identity(f, f);  // N, a basis of the motions that remain, f×g
  Eigen::MatrixXd by_acceleration = outputs.by_acceleration;
  DrivenSystem held;
  held.by_position = outputs.by_position;
  held.by_velocity = outputs.by_velocity;
  if (!coordinates.empty()) {
    // D_Sᵀ λ = (K̂ + sĈ + s²M̂) x − F: the reactions of the held coordinates and their effect on the outputs.
    const Eigen::MatrixXd holding = full.directions(coordinates, Eigen::all).transpose();
    const support::ColumnSpace held_space = support::find_column_space(holding, f);
    free = held_space.basis.rightCols(f - held_space.rank);
    const Eigen::MatrixXd G = outputs.by_force(Eigen::all, coordinates) *
                              support::solve_least_squares(holding, Eigen::MatrixXd::Identity(f, f));
    held.by_position += G * full.stiffness;
    held.by_velocity += G * full.damping;
    by_acceleration += G * full.mass;
    held.by_force = -G;
  }
  held.mass = free.transpose() * full.mass * free;
  held.damping = free.transpose() * full.damping * free;
  held.stiffness = free.transpose() * full.stiffness * free;
  const Eigen::MatrixXd size = free.cwiseAbs();
  held.stiffness_rounding = size.transpose() * full.stiffness_rounding * size;
  held.input = free.transpose();
  held.by_position *= free;
  held.by_velocity *= free;
  by_acceleration *= free;
  if (by_acceleration.size() > 0 && !by_acceleration.isZero(0.0)) {
    const Eigen::MatrixXd by_inertia =  // outputs per force on the free coordinates
        support::solve_positive_definite(held.mass, by_acceleration.transpose()).transpose();
    held.by_position -= by_inertia * held.stiffness;
    held.by_velocity -= by_inertia * held.damping;
    if (held.by_force.size() == 0) held.by_force = Eigen::MatrixXd::Zero(by_acceleration.rows(), f);
    held.by_force += by_inertia * held.input;
  }
  return held;
}

HarmonicSweep::HarmonicSweep(DrivenSystem system) : system_(std::move(system)) {
  if (system_.stiffness_rounding.size() == 0) {
    system_.stiffness_rounding = calc_matrix_rounding(system_.stiffness);
  }
  uncouple();
}

void HarmonicSweep::uncouple() {
  const Eigen::Index g = system_.mass.rows(), p = system_.by_position.rows();
  input_.resize(0, system_.input.cols());
  state_outputs_.resize(p, 0);
  if (g == 0) return;
  const FirstOrderForm form =
      make_first_order_form(system_.mass, system_.damping, system_.stiffness, system_.stiffness_rounding);
  const Eigen::MatrixXd& V = form.V;
  const Eigen::Index num_free = form.num_free, num_bound = form.num_bound();
  const auto eigen = support::solve_general(form.A);
  const Eigen::MatrixXd T = eigen ? normalise(*eigen) : Eigen::MatrixXd();
  const support::LuFactors inverse = eigen ? support::factorise_lu(T) : support::LuFactors();
  if (!(inverse.reciprocal_condition > kWorstVectors)) {
    solver_ = std::make_unique<FrequencySolver>(system_.mass, system_.damping, system_.stiffness,
                                                system_.stiffness_rounding);
    input_ = system_.input;
    state_outputs_.resize(p, 2 * g);
    state_outputs_ << system_.by_position, system_.by_velocity;
    return;
  }
  real_ = eigen->values.real();
  imaginary_ = eigen->values.imag();
  Eigen::MatrixXd force = Eigen::MatrixXd::Zero(num_bound + g, system_.input.cols());
  force.bottomRows(g) = V.transpose() * system_.input;
  input_ = inverse.solve(force);
  state_outputs_.resize(p, num_bound + g + num_free);
  const Eigen::MatrixXd by_position = system_.by_position * V, by_rate = system_.by_velocity * V;
  Eigen::MatrixXd by_state(p, num_bound + g);
  by_state << by_position.rightCols(num_bound) * form.scale.cwiseInverse().asDiagonal(), by_rate;
  state_outputs_.leftCols(num_bound + g) = by_state * T;
  state_outputs_.rightCols(num_free) = by_position.leftCols(num_free);
  free_rates_ = T.middleRows(num_bound, num_free);
}

RowsXcd HarmonicSweep::project(const Eigen::MatrixXcd& forces) const {
  if (forces.rows() != system_.input.cols()) {
    throw std::invalid_argument(fmt::format("HarmonicSweep: needs forces on {} coordinates, got {}",
                                            system_.input.cols(), forces.rows()));
  }
  return multiply_real_complex(input_, forces);
}

RowsXcd HarmonicSweep::calc_states(const Eigen::VectorXd& omega, const RowsXcd& projected) const {
  const Eigen::Index num_states = projected.rows(), k = projected.cols();
  const auto at = [&](Eigen::Index column) { return omega[omega.size() == 1 ? 0 : column]; };
  if (!is_uncoupled()) {
    RowsXcd states(2 * num_states, k);
    for (Eigen::Index i = 0; i < k; ++i) {
      const Eigen::VectorXcd x = solver_->solve(at(i), projected.col(i));
      states.col(i) << x, std::complex<double>(0.0, at(i)) * x;
    }
    return states;
  }
  RowsXcd states(num_states + free_rates_.rows(), k);
  states.topRows(num_states) = projected;
  for (Eigen::Index i = 0; i < num_states; ++i) {
    solve_block(real_[i], imaginary_[i], omega, states, i);
    if (imaginary_[i] != 0.0) ++i;
  }
  if (free_rates_.rows() > 0) {
    states.bottomRows(free_rates_.rows()) = multiply_real_complex(free_rates_, states.topRows(num_states));
    for (Eigen::Index i = 0; i < k; ++i) {
      states.col(i).tail(free_rates_.rows()) /= std::complex<double>(0.0, at(i));
    }
  }
  return states;
}

RowsXcd HarmonicSweep::respond(const Eigen::VectorXd& omega, const Eigen::MatrixXcd& forces) const {
  RowsXcd y(state_outputs_.rows(), omega.size());
  for (Eigen::Index first = 0; first < omega.size(); first += kAtOnce) {
    const Eigen::Index count = std::min(kAtOnce, omega.size() - first);
    const RowsXcd some = forces.middleCols(first, count);
    y.middleCols(first, count) = multiply_real_complex(
        state_outputs_, calc_states(omega.segment(first, count), multiply_real_complex(input_, some)));
    if (system_.by_force.size() > 0)
      y.middleCols(first, count) += multiply_real_complex(system_.by_force, some);
  }
  return y;
}

}  // namespace sprung::dynamics
