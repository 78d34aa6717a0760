#include "dynamics/system/partitioned_equations.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace sprung::dynamics {

namespace {

constexpr double kAssemblyTolerance = 1e-12;  // of the model's length scale
constexpr int kMaxNewtonIterations = 12;

void gather(const Eigen::VectorXd& all, const std::vector<int>& indices, Eigen::VectorXd& part) {
  for (std::size_t k = 0; k < indices.size(); ++k) part[static_cast<Eigen::Index>(k)] = all[indices[k]];
}

void scatter(const Eigen::VectorXd& part, const std::vector<int>& indices, Eigen::VectorXd& all) {
  for (std::size_t k = 0; k < indices.size(); ++k) all[indices[k]] = part[static_cast<Eigen::Index>(k)];
}

}  // namespace

PartitionedEquations::PartitionedEquations(const Model& model)
    : model_(&model), terms_(model), num_freedoms_(model.num_freedoms()), num_constraints_(model.num_constraints) {
  const Eigen::Index f = num_freedoms_, m = num_constraints_, nq = model.num_coordinates;
  q_ = v_ = v_dot_ = last_good_q_ = residual_force_ = mass_scale_ = Eigen::VectorXd::Zero(nq);
  q_i_ = v_i_ = a_i_ = Q_hat_ = Eigen::VectorXd::Zero(f);
  q_d_ = phi_ = correction_ = gamma_ = lambda_ = Eigen::VectorXd::Zero(m);
  alpha_ = Eigen::VectorXd::Zero(nq);
  Phi_d_ = Eigen::MatrixXd::Zero(m, m);
  Phi_i_ = T_ = Eigen::MatrixXd::Zero(m, f);
  directions_ = M_directions_ = Eigen::MatrixXd::Zero(nq, f);
  M_hat_ = Eigen::MatrixXd::Zero(f, f);
  lu_d_ = Eigen::PartialPivLU<Eigen::MatrixXd>(m);
  llt_ = Eigen::LLT<Eigen::MatrixXd>(f);
  visited_.resize(static_cast<std::size_t>(m));
}

void PartitionedEquations::choose_partition_at(double time, const Eigen::VectorXd& q) {
  q_ = last_good_q_ = q;
  terms_.update_positions(time, q_);
  terms_.update_jacobian();
  terms_.update_mass();
  partition_ = choose_partition(terms_);
  for (std::size_t b = 0; b < model_->bodies.size(); ++b) {
    const Body& body = model_->bodies[b];
    mass_scale_.segment(body.first_coordinate, body.num_coordinates()) = terms_.mass(b).diagonal().cwiseSqrt();
  }
  directions_.setZero();
  for (std::size_t k = 0; k < partition_.independent.size(); ++k) {
    directions_(partition_.independent[k], static_cast<Eigen::Index>(k)) = 1.0;
  }
  gather(q_, partition_.independent, q_i_);
  gather(q_, partition_.dependent, q_d_);
  factorise();
  growth_at_choice_ = std::max(1.0, scaled_growth());
  is_mirrored_ = is_determinant_negative();
}

// Sign of det φ_d = sign of the permutation · signs of the pivots. It cannot change while the motion is followed: a
// mechanism goes through det φ_d = 0 only where its independents turn round, and there another partition is due.
bool PartitionedEquations::is_determinant_negative() {
  const Eigen::VectorXi& permutation = lu_d_.permutationP().indices();
  bool is_negative = false;
  std::fill(visited_.begin(), visited_.end(), false);
  for (int start = 0; start < num_constraints_; ++start) {
    is_negative ^= lu_d_.matrixLU()(start, start) < 0.0;
    for (int i = permutation[start]; !visited_[static_cast<std::size_t>(start)] && i != start; i = permutation[i]) {
      visited_[static_cast<std::size_t>(i)] = true;
      is_negative = !is_negative;  // a cycle of k elements is k − 1 exchanges
    }
  }
  return is_negative;
}

// Factors of φ_d, T = −φ_d⁻¹φ_i and the directions [I; T] at the present positions.
void PartitionedEquations::factorise() {
  if (num_constraints_ == 0) return;
  const Eigen::MatrixXd& Phi_q = terms_.jacobian();
  for (std::size_t k = 0; k < partition_.dependent.size(); ++k) {
    Phi_d_.col(static_cast<Eigen::Index>(k)) = Phi_q.col(partition_.dependent[k]);
  }
  for (std::size_t k = 0; k < partition_.independent.size(); ++k) {
    Phi_i_.col(static_cast<Eigen::Index>(k)) = -Phi_q.col(partition_.independent[k]);
  }
  lu_d_.compute(Phi_d_);
  T_ = lu_d_.solve(Phi_i_);
  for (std::size_t k = 0; k < partition_.dependent.size(); ++k) {
    directions_.row(partition_.dependent[k]) = T_.row(static_cast<Eigen::Index>(k));
  }
}

// Newton for the dependents from the last positions, moved along with the independents; the factors of φ_d are
// renewed only where they no longer contract.
bool PartitionedEquations::solve_dependents(double time) {
  const double tolerance = kAssemblyTolerance * model_->length_scale;
  double last = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < kMaxNewtonIterations; ++iteration) {
    scatter(q_d_, partition_.dependent, q_);
    terms_.update_positions(time, q_);
    if (num_constraints_ == 0) return true;
    terms_.calc_residual(phi_);
    const double size = phi_.lpNorm<Eigen::Infinity>();
    if (!std::isfinite(size)) return false;
    if (size <= tolerance) return true;
    if (size > 0.1 * last) {
      terms_.update_jacobian();
      factorise();
    }
    last = size;
    correction_ = lu_d_.solve(phi_);
    q_d_ -= correction_;
  }
  return false;
}

PartitionedEquations::Outcome PartitionedEquations::update_positions(double time,
                                                                     std::span<const double> q_independent) {
  const Eigen::Map<const Eigen::VectorXd> target(q_independent.data(), num_freedoms_);
  if (!target.allFinite()) return Outcome::kNotFinite;
  a_i_ = target - q_i_;
  q_d_.noalias() += T_ * a_i_;
  q_i_ = target;
  scatter(q_i_, partition_.independent, q_);
  bool assembled = solve_dependents(time);
  if (assembled) {
    terms_.update_jacobian();
    factorise();
    assembled = is_determinant_negative() == is_mirrored_;
  }
  if (assembled) {
    last_good_q_ = q_;
  } else {  // the next search starts where the last one ended well
    q_ = last_good_q_;
    gather(q_, partition_.independent, q_i_);
    gather(q_, partition_.dependent, q_d_);
    terms_.update_positions(time, q_);
    terms_.update_jacobian();
    factorise();
  }
  return assembled ? Outcome::kGood : Outcome::kNotAssembled;
}

void PartitionedEquations::update_velocities(std::span<const double> v_independent) {
  v_i_ = Eigen::Map<const Eigen::VectorXd>(v_independent.data(), num_freedoms_);
  v_.noalias() = directions_ * v_i_;
  if (num_constraints_ > 0) {
    terms_.calc_time_rate(phi_);
    if (!phi_.isZero(0.0)) {
      correction_ = lu_d_.solve(phi_);
      for (std::size_t k = 0; k < partition_.dependent.size(); ++k) {
        v_[partition_.dependent[k]] -= correction_[static_cast<Eigen::Index>(k)];
      }
    }
  }
  terms_.update_velocities(v_);
}

PartitionedEquations::Outcome PartitionedEquations::update_accelerations(std::span<const int> branches) {
  terms_.update_mass();
  terms_.update_forces(branches);
  alpha_.setZero();  // accelerations while the independents' are zero
  if (num_constraints_ > 0) {
    terms_.calc_gamma(gamma_);
    correction_ = lu_d_.solve(gamma_);
    scatter(correction_, partition_.dependent, alpha_);
  }
  for (std::size_t b = 0; b < model_->bodies.size(); ++b) {
    const Eigen::Index first = model_->bodies[b].first_coordinate, size = model_->bodies[b].num_coordinates();
    M_directions_.middleRows(first, size).noalias() = terms_.mass(b) * directions_.middleRows(first, size);
    residual_force_.segment(first, size).noalias() = terms_.mass(b) * alpha_.segment(first, size);
  }
  residual_force_ = terms_.forces() - residual_force_;
  M_hat_.noalias() = directions_.transpose() * M_directions_;
  Q_hat_.noalias() = directions_.transpose() * residual_force_;
  llt_.compute(M_hat_);
  a_i_ = llt_.solve(Q_hat_);
  v_dot_.noalias() = directions_ * a_i_;
  v_dot_ += alpha_;
  return v_dot_.allFinite() ? Outcome::kGood : Outcome::kNotFinite;
}

void PartitionedEquations::update_multipliers() {
  if (num_constraints_ == 0) return;
  for (std::size_t b = 0; b < model_->bodies.size(); ++b) {
    const Eigen::Index first = model_->bodies[b].first_coordinate, size = model_->bodies[b].num_coordinates();
    residual_force_.segment(first, size).noalias() = terms_.mass(b) * v_dot_.segment(first, size);
  }
  residual_force_ = terms_.forces() - residual_force_;
  // φ_dᵀλ = r with P φ_d = LU, step by step: Eigen's own solve of the transposed takes memory.
  gather(residual_force_, partition_.dependent, correction_);
  lu_d_.matrixLU().triangularView<Eigen::Upper>().transpose().solveInPlace(correction_);
  lu_d_.matrixLU().triangularView<Eigen::UnitLower>().transpose().solveInPlace(correction_);
  lambda_.noalias() = lu_d_.permutationP().transpose() * correction_;
}

double PartitionedEquations::calc_motion_power() {
  if (!model_->has_motions) return 0.0;
  terms_.calc_time_rate(phi_);
  return lambda_.dot(phi_);
}

double PartitionedEquations::scaled_growth() const {
  double growth = 0.0;
  for (std::size_t i = 0; i < partition_.dependent.size(); ++i) {
    for (std::size_t k = 0; k < partition_.independent.size(); ++k) {
      growth = std::max(growth, std::abs(T_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k))) *
                                    mass_scale_[partition_.dependent[i]] / mass_scale_[partition_.independent[k]]);
    }
  }
  return growth;
}

double PartitionedEquations::partition_decay() const { return scaled_growth() / growth_at_choice_; }

}  // namespace sprung::dynamics
