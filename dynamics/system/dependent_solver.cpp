#include "dynamics/system/dependent_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprung::dynamics {

namespace {

struct PatternEntry {
  int row, column;
  std::size_t source;
};

// For each coordinate its position among those chosen, −1 where it is not one of them.
std::vector<int> list_positions(const std::vector<int>& chosen, int num_coordinates) {
  std::vector<int> position(static_cast<std::size_t>(num_coordinates), -1);
  for (std::size_t k = 0; k < chosen.size(); ++k) position[static_cast<std::size_t>(chosen[k])] = static_cast<int>(k);
  return position;
}

// φ_d's entries, row by row.
std::vector<std::vector<PatternEntry>> list_entries(const BlockJacobian& jacobian, const Partition& partition,
                                                    int num_coordinates) {
  const std::vector<int> position = list_positions(partition.dependent, num_coordinates);
  std::vector<std::vector<PatternEntry>> rows(partition.dependent.size());
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

// A column for each row such that all of them differ (augmenting paths); −1 where there is none.
class Matching {
 public:
  explicit Matching(const std::vector<std::vector<PatternEntry>>& rows)
      : rows_(rows), row_of_column_(rows.size(), -1), column_of_row_(rows.size(), -1), tried_for_(rows.size(), -1) {
    for (int row = 0; row < static_cast<int>(rows.size()); ++row) augment(row, row);
    for (std::size_t column = 0; column < rows.size(); ++column) {
      if (row_of_column_[column] >= 0) column_of_row_[static_cast<std::size_t>(row_of_column_[column])] = static_cast<int>(column);
    }
  }
  bool is_complete() const {
    return std::find(row_of_column_.begin(), row_of_column_.end(), -1) == row_of_column_.end();
  }
  const std::vector<int>& column_of_row() const { return column_of_row_; }
  const std::vector<int>& row_of_column() const { return row_of_column_; }

 private:
  // @param origin  the row that looks for a column: no column is tried twice for it
  bool augment(int row, int origin) {
    for (const PatternEntry& entry : rows_[static_cast<std::size_t>(row)]) {
      const auto column = static_cast<std::size_t>(entry.column);
      if (tried_for_[column] == origin) continue;
      tried_for_[column] = origin;
      if (row_of_column_[column] < 0 || augment(row_of_column_[column], origin)) {
        row_of_column_[column] = row;
        return true;
      }
    }
    return false;
  }
  const std::vector<std::vector<PatternEntry>>& rows_;
  std::vector<int> row_of_column_, column_of_row_;
  std::vector<int> tried_for_;
};

// Strongly connected groups of rows, where a row needs the rows whose columns it contains; in an order in which each
// group comes after those that it needs.
class Groups {
 public:
  Groups(const std::vector<std::vector<PatternEntry>>& rows, const Matching& matching)
      : rows_(rows), matching_(matching), index_(rows.size(), -1), low_(rows.size(), 0), on_stack_(rows.size(), false) {
    for (std::size_t row = 0; row < rows.size(); ++row) {
      if (index_[row] < 0) visit(static_cast<int>(row));
    }
  }
  std::vector<std::vector<int>> take() { return std::move(groups_); }

 private:
  void visit(int row) {
    const auto r = static_cast<std::size_t>(row);
    index_[r] = low_[r] = next_++;
    stack_.push_back(row);
    on_stack_[r] = true;
    for (const PatternEntry& entry : rows_[r]) {
      const int needed = matching_.row_of_column()[static_cast<std::size_t>(entry.column)];
      const auto k = static_cast<std::size_t>(needed);
      if (index_[k] < 0) {
        visit(needed);
        low_[r] = std::min(low_[r], low_[k]);
      } else if (on_stack_[k]) {
        low_[r] = std::min(low_[r], index_[k]);
      }
    }
    if (low_[r] != index_[r]) return;
    groups_.emplace_back();
    int member = -1;
    do {
      member = stack_.back();
      stack_.pop_back();
      on_stack_[static_cast<std::size_t>(member)] = false;
      groups_.back().push_back(member);
    } while (member != row);
    std::sort(groups_.back().begin(), groups_.back().end());
  }
  const std::vector<std::vector<PatternEntry>>& rows_;
  const Matching& matching_;
  std::vector<int> index_, low_, stack_;
  std::vector<bool> on_stack_;
  std::vector<std::vector<int>> groups_;
  int next_ = 0;
};

}  // namespace

DependentSolver::DependentSolver(const BlockJacobian& jacobian, const Partition& partition, int num_coordinates) {
  const std::vector<std::vector<PatternEntry>> rows = list_entries(jacobian, partition, num_coordinates);
  const Matching matching(rows);
  collect_strips(jacobian, partition, num_coordinates);
  is_regular_ = matching.is_complete();
  if (!is_regular_) return;
  std::size_t largest = 0, most_entries = 0;
  for (const std::vector<int>& group : Groups(rows, matching).take()) {
    DiagonalBlock block;
    block.rows = group;
    for (const int row : group) block.columns.push_back(matching.column_of_row()[static_cast<std::size_t>(row)]);
    std::sort(block.columns.begin(), block.columns.end());
    const int size = static_cast<int>(group.size());
    std::vector<SparseLu::Position> positions;
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
    largest = std::max(largest, group.size());
    most_entries = std::max(most_entries, block.inside.size());
    blocks_.push_back(std::move(block));
  }
  work_.resize(largest);
  entries_.resize(most_entries);
}

void DependentSolver::collect_strips(const BlockJacobian& jacobian, const Partition& partition, int num_coordinates) {
  const std::vector<int> position = list_positions(partition.independent, num_coordinates);
  for (const BlockJacobian::Block& block : jacobian.blocks()) {
    for (int j = 0; j < block.num_columns;) {
      const int first = position[static_cast<std::size_t>(block.column + j)];
      int count = 0;  // both ascend: a run of independent coordinates is one of positions
      while (j + count < block.num_columns && position[static_cast<std::size_t>(block.column + j + count)] >= 0) ++count;
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

void DependentSolver::add_independent_product(std::span<const double> x_independent, Eigen::VectorXd& r) const {
  for (const Strip& strip : strips_) {
    const double* value = values_ + strip.offset;
    const double* x = x_independent.data() + strip.first;
    for (int i = 0; i < strip.num_rows; ++i, value += strip.stride) {
      double sum = 0.0;
      for (int j = 0; j < strip.num_columns; ++j) sum += value[j] * x[j];
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
  for (const DiagonalBlock& block : blocks_) {
    for (std::size_t i = 0; i < block.rows.size(); ++i) work_[i] = r[block.rows[i]];
    for (const Entry& entry : block.outside) {
      work_[static_cast<std::size_t>(entry.row)] -= values_[entry.source] * x[entry.column];
    }
    block.lu.solve(work_.data());
    for (std::size_t i = 0; i < block.columns.size(); ++i) x[block.columns[i]] = work_[i];
  }
}

int DependentSolver::num_factor_entries() const {
  int count = 0;
  for (const DiagonalBlock& block : blocks_) count += block.lu.num_factor_entries() + static_cast<int>(block.outside.size());
  return count;
}

void DependentSolver::set_reference() {
  for (DiagonalBlock& block : blocks_) block.reference_determinant = block.lu.determinant();
}

bool DependentSolver::is_mirrored() const {
  return std::any_of(blocks_.begin(), blocks_.end(), [](const DiagonalBlock& block) {
    return (block.lu.determinant() < 0.0) != (block.reference_determinant < 0.0);
  });
}

double DependentSolver::decay() const {
  double decay = 1.0;
  for (const DiagonalBlock& block : blocks_) {
    decay = std::max(decay, std::abs(block.reference_determinant / block.lu.determinant()));
  }
  return decay;
}

}  // namespace sprung::dynamics
