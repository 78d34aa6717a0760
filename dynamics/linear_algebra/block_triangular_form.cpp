#include "dynamics/linear_algebra/block_triangular_form.h"

#include <algorithm>
#include <utility>

namespace sprung::dynamics {

namespace {

// Assigns a different column to as many rows as possible (augmenting paths); −1 for the others.
class Matching {
 public:
  explicit Matching(const PatternRows& rows)
      : rows_(rows),
        row_of_column_(rows.size(), -1),
        column_of_row_(rows.size(), -1),
        tried_for_(rows.size(), -1) {
    for (int row = 0; row < static_cast<int>(rows.size()); ++row) augment(row, row);
    for (std::size_t column = 0; column < rows.size(); ++column) {
      if (row_of_column_[column] >= 0)
        column_of_row_[static_cast<std::size_t>(row_of_column_[column])] = static_cast<int>(column);
    }
  }
  bool is_complete() const {
    return std::find(row_of_column_.begin(), row_of_column_.end(), -1) == row_of_column_.end();
  }
  const std::vector<int>& column_of_row() const { return column_of_row_; }
  const std::vector<int>& row_of_column() const { return row_of_column_; }

 private:
  // Finds a column for a row, for which other rows may move to another column.
  // @param origin  the row that began the search, which tries no column twice
  bool augment(int row, int origin) {
    const std::vector<PatternEntry>& entries = rows_[static_cast<std::size_t>(row)];
    for (const PatternEntry& entry : entries) {  // a free column first: then no other row has to move
      int& owner = row_of_column_[static_cast<std::size_t>(entry.column)];
      if (owner >= 0) continue;
      owner = row;
      return true;
    }
    for (const PatternEntry& entry : entries) {
      const auto column = static_cast<std::size_t>(entry.column);
      if (tried_for_[column] == origin) continue;
      tried_for_[column] = origin;
      if (augment(row_of_column_[column], origin)) {
        row_of_column_[column] = row;
        return true;
      }
    }
    return false;
  }
  const PatternRows& rows_;
  std::vector<int> row_of_column_, column_of_row_;
  std::vector<int> tried_for_;
};

// Strongly connected components of the rows [Tarjan 1972]. A row needs the rows whose columns it contains;
// each group comes after the groups that it needs.
class Groups {
 public:
  Groups(const PatternRows& rows, const Matching& matching)
      : rows_(rows),
        matching_(matching),
        index_(rows.size(), -1),
        low_(rows.size(), 0),
        on_stack_(rows.size(), false) {
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
  const PatternRows& rows_;
  const Matching& matching_;
  std::vector<int> index_, low_, stack_;
  std::vector<bool> on_stack_;
  std::vector<std::vector<int>> groups_;
  int next_ = 0;
};

}  // namespace

BlockTriangularForm find_block_triangular_form(const PatternRows& rows) {
  const Matching matching(rows);
  BlockTriangularForm form;
  form.is_regular = matching.is_complete();
  form.column_of_row = matching.column_of_row();
  if (form.is_regular) form.groups = Groups(rows, matching).take();
  return form;
}

}  // namespace sprung::dynamics
