#include "dynamics/system/dependent_solver.h"

#include <algorithm>
#include <cmath>

namespace sprung::dynamics {

namespace {

struct PatternEntry {
  int row, column;
  std::size_t source;
};

// φ_d's entries, row by row.
std::vector<std::vector<PatternEntry>> list_entries(const BlockJacobian& jacobian, const Partition& partition,
                                                    int num_coordinates) {
  std::vector<int> position(static_cast<std::size_t>(num_coordinates), -1);
  for (std::size_t k = 0; k < partition.dependent.size(); ++k) {
    position[static_cast<std::size_t>(partition.dependent[k])] = static_cast<int>(k);
  }
  std::vector<std::vector<PatternEntry>> rows(partition.dependent.size());
  for (const BlockJacobian::Block& block : jacobian.blocks()) {
    for (int i = 0; i < block.num_rows; ++i) {
      for (int j = 0; j < block.num_columns; ++j) {
        const int column = position[static_cast<std::size_t>(block.column + j)];
        if (column < 0) continue;
        rows[static_cast<std::size_t>(block.row + i)].push_back(
            {block.row + i, column, block.offset + static_cast<std::size_t>(i * block.num_columns + j)});
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

void DependentSolver::factorise(const BlockJacobian& jacobian) {
  values_ = jacobian.data();
  for (DiagonalBlock& block : blocks_) {
    for (std::size_t k = 0; k < block.inside.size(); ++k) entries_[k] = values_[block.inside[k]];
    block.lu.factorise({entries_.data(), block.inside.size()});
  }
}

void DependentSolver::solve(const Eigen::VectorXd& r, Eigen::VectorXd& x) const {
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
