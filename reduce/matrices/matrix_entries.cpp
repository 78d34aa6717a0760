#include "reduce/matrices/matrix_entries.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace sprung::reduce {

namespace {

constexpr double kAsymmetry = 1e-6;          // of an entry
constexpr double kAsymmetryDiagonal = 1e-9;  // of the diagonal
constexpr double kHeldStiffness = 1e30;

support::InputError make_error(const MatrixEntries& entries, const MatrixEntry& entry,
                               const std::string& message) {
  return support::InputError({.path = entries.path, .line = entry.line, .column = entry.text_column},
                             message);
}

std::string describe_place(const MatrixEntry& entry, const FreedomList& freedoms) {
  return fmt::format("({}; {})", describe(freedoms[entry.row]), describe(freedoms[entry.column]));
}

bool is_mirrored(const MatrixEntry& a, const MatrixEntry& b) {
  return a.row != a.column && a.row == b.column && a.column == b.row;
}

// Neighbours of one place of the lower triangle.
void sort_by_place(MatrixEntries& entries) {
  std::stable_sort(
      entries.items.begin(), entries.items.end(), [](const MatrixEntry& a, const MatrixEntry& b) {
        const auto place = [](const MatrixEntry& one) {
          return std::make_tuple(std::min(one.row, one.column), std::max(one.row, one.column), one.row);
        };
        return place(a) < place(b);
      });
}

void check_twice(const MatrixEntries& entries, const FreedomList& freedoms) {
  for (std::size_t i = 1; i < entries.items.size(); ++i) {
    const MatrixEntry &a = entries.items[i - 1], &b = entries.items[i];
    if (a.row == b.row && a.column == b.column) {
      throw make_error(
          entries, b,
          fmt::format("the entry {} stands in line {} already", describe_place(b, freedoms), a.line));
    }
  }
}

bool has_both_triangles(const MatrixEntries& entries) {
  if (entries.is_full) return true;
  for (std::size_t i = 1; i < entries.items.size(); ++i) {
    if (is_mirrored(entries.items[i - 1], entries.items[i])) return true;
  }
  return false;
}

void check_equal(const MatrixEntries& entries, const MatrixEntry& a, double mirrored,
                 const Eigen::VectorXd& diagonal, const FreedomList& freedoms) {
  const double tolerance =
      std::max(kAsymmetry * std::max(std::abs(a.value), std::abs(mirrored)),
               kAsymmetryDiagonal * std::sqrt(std::abs(diagonal(a.row) * diagonal(a.column))));
  if (std::abs(a.value - mirrored) <= tolerance) return;
  throw make_error(entries, a,
                   fmt::format("the matrix is not symmetric: the entry {} is {:.9g}, and {:.9g} on the other "
                               "side of the diagonal",
                               describe_place(a, freedoms), a.value, mirrored));
}

}  // namespace

void add_entry(const TextLines& lines, int row, int column, const TextField& value, MatrixEntries& entries) {
  const double number = lines.real(value);
  if (std::abs(number) >= kHeldStiffness) {
    throw lines.error(value, fmt::format("the entry is {:.3g}, which stands for a freedom that a boundary "
                                         "condition holds; write the matrices of the free body",
                                         number));
  }
  entries.items.push_back({row, column, number, lines.number(), value.column});
}

Eigen::SparseMatrix<double> make_symmetric_matrix(MatrixEntries entries, const FreedomList& freedoms) {
  sort_by_place(entries);
  check_twice(entries, freedoms);
  const bool both = has_both_triangles(entries);
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(freedoms.size());
  for (const MatrixEntry& entry : entries.items) {
    if (entry.row == entry.column) diagonal(entry.row) = entry.value;
  }
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(2 * entries.items.size());
  for (std::size_t i = 0; i < entries.items.size(); ++i) {
    const MatrixEntry& entry = entries.items[i];
    double value = entry.value;
    if (entry.row == entry.column) {
      triplets.emplace_back(entry.row, entry.column, value);
      continue;
    }
    const bool paired = i + 1 < entries.items.size() && is_mirrored(entry, entries.items[i + 1]);
    if (both) {
      const double mirrored = paired ? entries.items[i + 1].value : 0.0;
      check_equal(entries, entry, mirrored, diagonal, freedoms);
      value = 0.5 * (value + mirrored);
      if (paired) ++i;
    }
    triplets.emplace_back(entry.row, entry.column, value);
    triplets.emplace_back(entry.column, entry.row, value);
  }
  Eigen::SparseMatrix<double> matrix(freedoms.size(), freedoms.size());
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  matrix.prune(0.0, 0.0);
  return matrix;
}

}  // namespace sprung::reduce
