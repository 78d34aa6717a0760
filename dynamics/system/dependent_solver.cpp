#include "dynamics/system/dependent_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sprung::dynamics {

namespace {

// For each coordinate its position among the chosen ones, −1 where it is not one of them.
std::vector<int> list_positions(const std::vector<int>& chosen, int num_coordinates) {
  std::vector<int> position(static_cast<std::size_t>(num_coordinates), -1);
  for (std::size_t k = 0; k < chosen.size(); ++k)
    position[static_cast<std::size_t>(chosen[k])] = static_cast<int>(k);
  return position;
}

// φ_d's entries, row by row.
PatternRows list_entries(const BlockJacobian& jacobian, const Partition& partition, int num_coordinates) {
  const std::vector<int> position = list_positions(partition.dependent, num_coordinates);
  PatternRows rows(partition.dependent.size());
  for (const BlockJacobian::Block& block : jacobian.blocks()) {
    for (int i = 0; i < block.num_rows; ++i) {
      for (int j = 0; j < block.num_columns; ++j) {
        const int column = position[static_cast<std::size_t>(block.column + j)];
        const std::size_t source = block.offset + static_cast<std::size_t>(i * block.num_columns + j);
        if (column < 0 || jacobian.is_always_zero(source)) continue;
        rows[static_cast<std::size_t>(block.row + i)].push_back({block.row + i, column, source});
      }
    }
  }
  return rows;
}

}  // namespace

DependentSolver::DependentSolver(const BlockJacobian& jacobian, const Partition& partition,
                                 int num_coordinates) {
  collect_strips(jacobian, partition, num_coordinates);
  const PatternRows rows = list_entries(jacobian, partition, num_coordinates);
  const BlockTriangularForm form = find_block_triangular_form(rows);
  is_regular_ = form.is_regular;
  std::size_t largest = 0, most_entries = 0;
  for (const std::vector<int>& group : form.groups) {
    if (group.size() == 1 && add_single(rows[static_cast<std::size_t>(group[0])], form)) continue;
    const DiagonalBlock& block = add_block(group, rows, form);
    largest = std::max(largest, group.size());
    most_entries = std::max(most_entries, block.inside.size());
  }
  work_.resize(largest);
  entries_.resize(most_entries);
}

// @return false where the entry on the diagonal is a sum
bool DependentSolver::add_single(const std::vector<PatternEntry>& entries, const BlockTriangularForm& form) {
  const int row = entries.front().row, column = form.column_of_row[static_cast<std::size_t>(row)];
  const auto is_inside = [&](const PatternEntry& entry) { return entry.column == column; };
  if (std::count_if(entries.begin(), entries.end(), is_inside) != 1) return false;
  Single single{.row = row, .column = column};
  for (const PatternEntry& entry : entries) {
    if (is_inside(entry))
      single.source = entry.source;
    else
      outside_of_singles_.push_back({entry.column, entry.source});
  }
  single.end_of_outside = outside_of_singles_.size();
  singles_.push_back(single);
  return true;
}

const DependentSolver::DiagonalBlock& DependentSolver::add_block(const std::vector<int>& group,
                                                                 const PatternRows& rows,
                                                                 const BlockTriangularForm& form) {
  DiagonalBlock block;
  block.num_singles_before = singles_.size();
  block.rows = group;
  for (const int row : group) block.columns.push_back(form.column_of_row[static_cast<std::size_t>(row)]);
  std::sort(block.columns.begin(), block.columns.end());
  const int size = static_cast<int>(group.size());
  std::vector<MatrixPosition> positions;
  for (int i = 0; i < size; ++i) {
    for (const PatternEntry& entry : rows[static_cast<std::size_t>(group[static_cast<std::size_t>(i)])]) {
      const auto found = std::lower_bound(block.columns.begin(), block.columns.end(), entry.column);
      if (found != block.columns.end() && *found == entry.column) {
        positions.push_back({i, static_cast<int>(found - block.columns.begin())});
        block.inside.push_back(entry.source);
      } else {
        block.outside.push_back({i, entry.column, entry.source});
      }
    }
  }
  block.lu = SparseLu(size, std::move(positions));
  return blocks_.emplace_back(std::move(block));
}

void DependentSolver::collect_strips(const BlockJacobian& jacobian, const Partition& partition,
                                     int num_coordinates) {
  const std::vector<int> position = list_positions(partition.independent, num_coordinates);
  for (const BlockJacobian::Block& block : jacobian.blocks()) {
    for (int j = 0; j < block.num_columns;) {
      const int first = position[static_cast<std::size_t>(block.column + j)];
      int count = 0;  // both ascend: successive coordinates have successive positions
      while (j + count < block.num_columns &&
             position[static_cast<std::size_t>(block.column + j + count)] >= 0)
        ++count;
      if (count > 0) {
        strips_.push_back({.offset = block.offset + static_cast<std::size_t>(j),
                           .row = block.row,
                           .num_rows = block.num_rows,
                           .stride = block.num_columns,
                           .first = first,
                           .num_columns = count});
      }
      j += std::max(count, 1);
    }
  }
}

void DependentSolver::add_independent_product(std::span<const double> x_independent,
                                              Eigen::VectorXd& r) const {
  for (const Strip& strip : strips_) {
    const double* value = values_ + strip.offset;
    const double* x = x_independent.data() + strip.first;
    for (int i = 0; i < strip.num_rows; ++i, value += strip.stride) {
      double sum = value[0] * x[0];
      for (int j = 1; j < strip.num_columns; ++j) sum += value[j] * x[j];
      r[strip.row + i] += sum;
    }
  }
}

void DependentSolver::get_independent_column(std::size_t k, Eigen::VectorXd& r) const {
  r.setZero();
  const int column = static_cast<int>(k);
  for (const Strip& strip : strips_) {
    if (column < strip.first || column >= strip.first + strip.num_columns) continue;
    const double* value = values_ + strip.offset + (column - strip.first);
    for (int i = 0; i < strip.num_rows; ++i, value += strip.stride) r[strip.row + i] += *value;
  }
}

void DependentSolver::factorise(const BlockJacobian& jacobian) {
  values_ = jacobian.data();
  for (Single& single : singles_) single.inverse = 1.0 / values_[single.source];
  for (DiagonalBlock& block : blocks_) {
    for (std::size_t k = 0; k < block.inside.size(); ++k) entries_[k] = values_[block.inside[k]];
    block.lu.factorise({entries_.data(), block.inside.size()});
  }
}

void DependentSolver::solve(const Eigen::VectorXd& r, Eigen::VectorXd& x) const {
  if (!is_regular_) {
    x.setConstant(std::numeric_limits<double>::quiet_NaN());
    return;
  }
  std::size_t num_solved = 0;  // of the singles
  for (const DiagonalBlock& block : blocks_) {
    solve_singles(num_solved, block.num_singles_before, r, x);
    num_solved = block.num_singles_before;
    for (std::size_t i = 0; i < block.rows.size(); ++i) work_[i] = r[block.rows[i]];
    for (const Entry& entry : block.outside) {
      work_[static_cast<std::size_t>(entry.row)] -= values_[entry.source] * x[entry.column];
    }
    block.lu.solve(work_.data());
    for (std::size_t i = 0; i < block.columns.size(); ++i) x[block.columns[i]] = work_[i];
  }
  solve_singles(num_solved, singles_.size(), r, x);
}

void DependentSolver::solve_singles(std::size_t first, std::size_t end, const Eigen::VectorXd& r,
                                    Eigen::VectorXd& x) const {
  std::size_t outside = first == 0 ? 0 : singles_[first - 1].end_of_outside;
  for (std::size_t k = first; k < end; ++k) {
    const Single& single = singles_[k];
    double left = r[single.row];
    for (; outside < single.end_of_outside; ++outside) {
      const Coupling& coupling = outside_of_singles_[outside];
      left -= values_[coupling.source] * x[coupling.column];
    }
    x[single.column] = left * single.inverse;
  }
}

// The blocks of φ_dᵀ in the opposite order: each takes its share out of the columns of those before it.
void DependentSolver::solve_transposed(Eigen::VectorXd& r, Eigen::VectorXd& y) const {
  if (!is_regular_) {
    y.setConstant(std::numeric_limits<double>::quiet_NaN());
    return;
  }
  std::size_t end = singles_.size();
  for (std::size_t b = blocks_.size(); b-- > 0;) {
    const DiagonalBlock& block = blocks_[b];
    solve_singles_transposed(block.num_singles_before, end, r, y);
    end = block.num_singles_before;
    for (std::size_t i = 0; i < block.columns.size(); ++i) work_[i] = r[block.columns[i]];
    block.lu.solve_transposed(work_.data());
    for (std::size_t i = 0; i < block.rows.size(); ++i) y[block.rows[i]] = work_[i];
    for (const Entry& entry : block.outside)
      r[entry.column] -= values_[entry.source] * work_[static_cast<std::size_t>(entry.row)];
  }
  solve_singles_transposed(0, end, r, y);
}

void DependentSolver::solve_singles_transposed(std::size_t first, std::size_t end, Eigen::VectorXd& r,
                                               Eigen::VectorXd& y) const {
  for (std::size_t k = end; k-- > first;) {
    const Single& single = singles_[k];
    const double value = r[single.column] * single.inverse;
    y[single.row] = value;
    for (std::size_t i = k == 0 ? 0 : singles_[k - 1].end_of_outside; i < single.end_of_outside; ++i)
      r[outside_of_singles_[i].column] -= values_[outside_of_singles_[i].source] * value;
  }
}

void DependentSolver::subtract_transposed_product(const Eigen::VectorXd& y,
                                                  std::span<double> x_independent) const {
  for (const Strip& strip : strips_) {
    const double* value = values_ + strip.offset;
    double* x = x_independent.data() + strip.first;
    for (int i = 0; i < strip.num_rows; ++i, value += strip.stride) {
      const double factor = y[strip.row + i];
      for (int j = 0; j < strip.num_columns; ++j) x[j] -= value[j] * factor;
    }
  }
}

Eigen::MatrixXd DependentSolver::find_followers(int num_independent) const {
  Eigen::Index num_constraints = static_cast<Eigen::Index>(singles_.size());
  for (const DiagonalBlock& block : blocks_) num_constraints += static_cast<Eigen::Index>(block.rows.size());
  Eigen::MatrixXd touched = Eigen::MatrixXd::Zero(num_constraints, num_independent);  // by constraints
  for (const Strip& strip : strips_)
    touched.block(strip.row, strip.first, strip.num_rows, strip.num_columns).setOnes();
  Eigen::MatrixXd followers = Eigen::MatrixXd::Zero(num_constraints, num_independent);
  std::size_t num_found = 0;  // of the singles
  const auto find_singles = [&](std::size_t end) {
    for (; num_found < end; ++num_found) {
      const Single& single = singles_[num_found];
      Eigen::RowVectorXd row = touched.row(single.row);
      for (std::size_t i = num_found == 0 ? 0 : singles_[num_found - 1].end_of_outside;
           i < single.end_of_outside; ++i)
        row = row.cwiseMax(followers.row(outside_of_singles_[i].column));
      followers.row(single.column) = row;
    }
  };
  for (const DiagonalBlock& block : blocks_) {
    find_singles(block.num_singles_before);
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(num_independent);
    for (const int constraint : block.rows) row = row.cwiseMax(touched.row(constraint));
    for (const Entry& entry : block.outside) row = row.cwiseMax(followers.row(entry.column));
    for (const int column : block.columns) followers.row(column) = row;
  }
  find_singles(singles_.size());
  return followers;
}

int DependentSolver::num_factor_entries() const {
  std::size_t count = singles_.size() + outside_of_singles_.size();
  for (const DiagonalBlock& block : blocks_) {
    count += static_cast<std::size_t>(block.lu.num_factor_entries()) + block.outside.size();
  }
  return static_cast<int>(count);
}

void DependentSolver::set_reference() {
  for (Single& single : singles_) single.reference = values_[single.source];
  for (DiagonalBlock& block : blocks_) block.reference_determinant = block.lu.determinant();
}

void DependentSolver::raise_reference() {
  const auto raise = [](double& reference, double value) {
    if (std::abs(value) > std::abs(reference)) reference = value;
  };
  for (Single& single : singles_) raise(single.reference, values_[single.source]);
  for (DiagonalBlock& block : blocks_) raise(block.reference_determinant, block.lu.determinant());
}

bool DependentSolver::is_mirrored() const {
  return std::any_of(
             singles_.begin(), singles_.end(),
             [](const Single& single) { return (single.inverse < 0.0) != (single.reference < 0.0); }) ||
         std::any_of(blocks_.begin(), blocks_.end(), [](const DiagonalBlock& block) {
           return (block.lu.determinant() < 0.0) != (block.reference_determinant < 0.0);
         });
}

double DependentSolver::decay() const {
  double decay = 1.0;
  for (const Single& single : singles_) decay = std::max(decay, std::abs(single.reference * single.inverse));
  for (const DiagonalBlock& block : blocks_) {
    decay = std::max(decay, std::abs(block.reference_determinant / block.lu.determinant()));
  }
  return decay;
}

}  // namespace sprung::dynamics
