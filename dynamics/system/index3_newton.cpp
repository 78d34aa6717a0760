#include "dynamics/system/index3_newton.h"

#include <algorithm>
#include <cmath>

namespace sprung::dynamics {

namespace {

constexpr int kMostDense = 100;  // unknowns
constexpr double kShift = 1e-6;  // of the natural size, for differences

}  // namespace

Index3Newton::Index3Newton(const Model& model)
    : model_(&model),
      num_coordinates_(model.num_coordinates),
      num_constraints_(model.num_constraints),
      base_force_(Eigen::VectorXd::Zero(model.num_coordinates)),
      moved_(model),
      coordinate_scale_(base_force_),
      constraint_scale_(Eigen::VectorXd::Zero(model.num_constraints)),
      unknowns_(Eigen::VectorXd::Zero(model.num_coordinates + model.num_constraints)),
      is_dense_(unknowns_.size() <= kMostDense) {
  solution_ = unknowns_;
  if (is_dense_) {
    dense_ = Eigen::MatrixXd::Identity(unknowns_.size(), unknowns_.size());
    dense_factor_.compute(dense_);
  }
  find_couplings();
  colour_groups();
}

void Index3Newton::find_couplings() {
  for (const Body& body : model_->bodies) groups_.push_back({body.first_coordinate, body.num_coordinates()});
  const auto& first_states = model_->force_states;
  std::vector<int> state_groups(model_->forces.size(), -1);
  for (std::size_t f = 0; f < model_->forces.size(); ++f) {
    const int count = first_states[f + 1] - first_states[f];
    if (count == 0) continue;
    state_groups[f] = static_cast<int>(groups_.size());
    groups_.push_back({model_->first_state() + first_states[f], count});
  }
  const std::size_t num_groups = groups_.size();
  std::vector<std::vector<bool>> feels(num_groups, std::vector<bool>(num_groups, false));
  for (std::size_t g = 0; g < num_groups; ++g) feels[g][g] = true;
  const auto couple = [&](const std::vector<int>& markers, int state_group) {
    std::vector<int> together;
    for (const int i : markers) together.push_back(model_->markers[static_cast<std::size_t>(i)].body);
    together.push_back(state_group);
    for (const int a : together) {
      for (const int b : together) {
        if (a >= 0 && b >= 0) feels[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)] = true;
      }
    }
  };
  static_assert(kGround < 0);
  for (const auto& joint : model_->joints) couple({joint->marker_a, joint->marker_b}, -1);
  for (std::size_t f = 0; f < model_->forces.size(); ++f)
    couple(model_->forces[f]->markers(), state_groups[f]);
  for (std::size_t a = 0; a < num_groups; ++a) {
    for (std::size_t b = 0; b < num_groups; ++b) {
      if (!feels[a][b]) continue;
      const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(groups_[a].size, groups_[b].size);
      couplings_.push_back({static_cast<int>(a), static_cast<int>(b), zero, zero});
    }
  }
}

// Greedy: a group takes the first colour that contains no group on which the same forces depend.
// Source: [Curtis, Powell & Reid 1974]
void Index3Newton::colour_groups() {
  const std::size_t num_groups = groups_.size();
  std::vector<std::vector<int>> felt_by(num_groups);
  for (const Coupling& coupling : couplings_) {
    felt_by[static_cast<std::size_t>(coupling.column_group)].push_back(coupling.row_group);
  }
  std::vector<std::vector<bool>> taken;  // rows of each colour
  for (std::size_t b = 0; b < num_groups; ++b) {
    const auto fits = [&](const std::vector<bool>& rows) {
      return std::none_of(felt_by[b].begin(), felt_by[b].end(),
                          [&](int row) { return rows[static_cast<std::size_t>(row)]; });
    };
    const auto colour =
        static_cast<std::size_t>(std::find_if(taken.begin(), taken.end(), fits) - taken.begin());
    if (colour == taken.size()) {
      taken.emplace_back(num_groups, false);
      colours_.emplace_back();
    }
    for (const int row : felt_by[b]) taken[colour][static_cast<std::size_t>(row)] = true;
    colours_[colour].push_back(static_cast<int>(b));
  }
}

void Index3Newton::difference(Index3Residual& residual, ConstrainedMotion& moved,
                              std::span<const int> branches, bool of_velocity) {
  Eigen::VectorXd& x = of_velocity ? moved.v : moved.q;
  for (const std::vector<int>& colour : colours_) {
    int num_columns = 0;
    for (const int g : colour) num_columns = std::max(num_columns, groups_[static_cast<std::size_t>(g)].size);
    for (int k = 0; k < num_columns; ++k) {
      const auto shift_all = [&](double sign) {
        for (const int g : colour) {
          const Group& group = groups_[static_cast<std::size_t>(g)];
          if (k >= group.size) continue;
          const int i = group.first + k;
          x[i] += sign * kShift * model_->coordinate_scale(i);
        }
      };
      shift_all(1.0);
      residual.update(moved, branches);
      shift_all(-1.0);
      for (Coupling& coupling : couplings_) {
        if (std::find(colour.begin(), colour.end(), coupling.column_group) == colour.end()) continue;
        const Group& column = groups_[static_cast<std::size_t>(coupling.column_group)];
        const Group& row = groups_[static_cast<std::size_t>(coupling.row_group)];
        if (k >= column.size) continue;
        const double shift = kShift * model_->coordinate_scale(column.first + k);
        (of_velocity ? coupling.C : coupling.K).col(k) =
            (residual.force() - base_force_).segment(row.first, row.size) / shift;
      }
    }
  }
}

void Index3Newton::linearise(Index3Residual& residual, const ConstrainedMotion& motion,
                             std::span<const int> branches) {
  residual.update(motion, branches);
  base_force_ = residual.force();
  moved_ = motion;
  difference(residual, moved_, branches, false);
  moved_.q = motion.q;
  difference(residual, moved_, branches, true);
  residual.update(motion, branches);
}

void Index3Newton::collect_entries(const SystemTerms& terms, const Weights& weights) {
  entries_.clear();
  constraint_scale_.setZero();
  coordinate_scale_.setOnes();
  for (std::size_t b = 0; b < model_->bodies.size(); ++b) {
    const Body& body = model_->bodies[b];
    for (int k = 0; k < body.num_coordinates(); ++k) {
      coordinate_scale_[body.first_coordinate + k] = 1.0 / std::sqrt(terms.masses()[b].metric(k));
    }
  }
  for (const Coupling& coupling : couplings_) {
    const auto row_group = static_cast<std::size_t>(coupling.row_group);
    const int row = groups_[row_group].first;
    const int column = groups_[static_cast<std::size_t>(coupling.column_group)].first;
    const bool is_own = coupling.row_group == coupling.column_group;
    for (int j = 0; j < coupling.K.cols(); ++j) {
      for (int i = 0; i < coupling.K.rows(); ++i) {
        double value = weights.velocity * coupling.C(i, j) + weights.position * coupling.K(i, j);
        if (is_own && row_group < model_->bodies.size())
          value += weights.acceleration * terms.mass(row_group)(i, j);
        else if (is_own && i == j)
          value += weights.acceleration;  // the unit mass of a state
        entries_.push_back(
            {row + i, column + j, value * coordinate_scale_[row + i] * coordinate_scale_[column + j]});
      }
    }
  }
  const std::size_t first = entries_.size();
  const BlockJacobian& jacobian = terms.jacobian();
  for (std::size_t k = 0; k < jacobian.blocks().size(); ++k) {
    const BlockJacobian::Block& block = jacobian.blocks()[k];
    const double* value = jacobian.values(k);
    for (int i = 0; i < block.num_rows; ++i) {
      for (int j = 0; j < block.num_columns; ++j) {
        const double scaled = *value++ * coordinate_scale_[block.column + j];
        entries_.push_back({block.row + i, block.column + j, scaled});
        constraint_scale_[block.row + i] += scaled * scaled;
      }
    }
  }
  constraint_scale_ = constraint_scale_.cwiseSqrt().cwiseInverse();
  const std::size_t end = entries_.size();
  for (std::size_t k = first; k < end; ++k) {
    Entry& entry = entries_[k];
    entry.value *= constraint_scale_[entry.row];
    entry.row += num_coordinates_;
    entries_.push_back({entry.column, entry.row, entry.value});
  }
}

bool Index3Newton::factorise(const SystemTerms& terms, const Weights& weights) {
  weights_ = weights;
  collect_entries(terms, weights);
  if (!is_dense_) {
    std::vector<Eigen::Triplet<double>> triplets;
    triplets.reserve(entries_.size());
    for (const Entry& entry : entries_) triplets.emplace_back(entry.row, entry.column, entry.value);
    const bool has_pattern = sparse_.rows() > 0;
    sparse_.resize(unknowns_.size(), unknowns_.size());
    sparse_.setFromTriplets(triplets.begin(), triplets.end());
    if (!has_pattern) sparse_factor_.analyzePattern(sparse_);
    sparse_factor_.factorize(sparse_);
    return sparse_factor_.info() == Eigen::Success;
  }
  dense_.setZero();
  for (const Entry& entry : entries_) dense_(entry.row, entry.column) += entry.value;
  dense_factor_.compute(dense_);
  const auto pivots = dense_factor_.matrixLU().diagonal();
  return pivots.allFinite() && (pivots.array() != 0.0).all();
}

void Index3Newton::solve(const Eigen::VectorXd& r, const Eigen::VectorXd& phi, Eigen::VectorXd& delta,
                         Eigen::VectorXd& delta_lambda) {
  unknowns_.head(num_coordinates_) = -r.cwiseProduct(coordinate_scale_);
  unknowns_.tail(num_constraints_) = -phi.cwiseProduct(constraint_scale_);
  if (is_dense_)
    solution_ = dense_factor_.solve(unknowns_);
  else
    solution_ = sparse_factor_.solve(unknowns_);
  delta = solution_.head(num_coordinates_).cwiseProduct(coordinate_scale_);
  delta_lambda = solution_.tail(num_constraints_).cwiseProduct(constraint_scale_);
}

void Index3Newton::calc_force_change(const Eigen::VectorXd& y, Eigen::VectorXd& force) const {
  force.setZero();
  for (const Coupling& coupling : couplings_) {
    const Group& row = groups_[static_cast<std::size_t>(coupling.row_group)];
    const Group& column = groups_[static_cast<std::size_t>(coupling.column_group)];
    auto on_row = force.segment(row.first, row.size);
    on_row.noalias() += weights_.velocity * (coupling.C * y.segment(column.first, column.size));
    on_row.noalias() += weights_.position * (coupling.K * y.segment(column.first, column.size));
  }
}

Eigen::MatrixXd Index3Newton::dense() const {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(unknowns_.size(), unknowns_.size());
  for (const Entry& entry : entries_) matrix(entry.row, entry.column) += entry.value;
  return matrix;
}

}  // namespace sprung::dynamics
