#include "reduce/factors/supernode_columns.h"

#include <algorithm>

#include "reduce/factors/vectorised.h"

namespace sprung::reduce {

namespace {

using Eigen::Index;

constexpr int kColumns = 4;  // that are read together

// The k values of a row.
template <class Values>
SPRUNG_INLINED Values load_row(const double* x, Index row) {
  return load<Values>(x + row * static_cast<Index>(sizeof(Values) / sizeof(double)));
}
template <class Values>
SPRUNG_INLINED void store_row(const Values& values, double* x, Index row) {
  store(values, x + row * static_cast<Index>(sizeof(Values) / sizeof(double)));
}

// kCount columns from j on: their unknowns, and what these take from the other ones of the supernode and
// below.
template <class Values, int kCount>
SPRUNG_INLINED void solve_columns_lower(const SupernodeColumns& node, Index j, double* x, double* shares) {
  const double* columns[kCount];
  Values solved[kCount];
  for (int c = 0; c < kCount; ++c) {
    columns[c] = node.column(j + c);
    solved[c] = load_row<Values>(x, node.first + j + c);
    for (int b = 0; b < c; ++b) solved[c] -= columns[b][j + c] * solved[b];
    store_row<Values>(solved[c], x, node.first + j + c);
  }
  for (Index i = j + kCount; i < node.width; ++i) {
    Values sum = load_row<Values>(x, node.first + i);
    for (int c = 0; c < kCount; ++c) sum -= columns[c][i] * solved[c];
    store_row<Values>(sum, x, node.first + i);
  }
  for (Index i = node.width; i < node.height; ++i) {
    Values sum = load_row<Values>(shares, i - node.width);
    for (int c = 0; c < kCount; ++c) sum += columns[c][i] * solved[c];
    store_row<Values>(sum, shares, i - node.width);
  }
}

template <class Values, int kCount>
SPRUNG_INLINED void solve_columns_upper(const SupernodeColumns& node, Index j, double* x, double* below) {
  const double* columns[kCount];
  Values sums[kCount];
  for (int c = 0; c < kCount; ++c) {
    columns[c] = node.column(j + c);
    sums[c] = load_row<Values>(x, node.first + j + c) / columns[c][j + c];
  }
  for (Index i = j + kCount; i < node.width; ++i) {
    const Values known = load_row<Values>(x, node.first + i);
    for (int c = 0; c < kCount; ++c) sums[c] -= columns[c][i] * known;
  }
  for (Index i = node.width; i < node.height; ++i) {
    const Values known = load_row<Values>(below, i - node.width);
    for (int c = 0; c < kCount; ++c) sums[c] -= columns[c][i] * known;
  }
  for (int c = kCount; c-- > 0;) {
    for (int b = c + 1; b < kCount; ++b) sums[c] -= columns[c][j + b] * sums[b];
    store_row<Values>(sums[c], x, node.first + j + c);
  }
}

// One right-hand side: neighbouring rows are computed with together.
template <int kCount>
SPRUNG_INLINED void solve_single_upper(const SupernodeColumns& node, Index j, double* x,
                                       const double* below) {
  const double* columns[kCount];
  EightDoubles parts[kCount];
  const Index num_below = node.num_below();
  for (int c = 0; c < kCount; ++c) {
    columns[c] = node.column(j + c) + node.width;
    parts[c] = EightDoubles{};
  }
  Index i = 0;
  for (; i + 8 <= num_below; i += 8) {
    const EightDoubles known = load<EightDoubles>(below + i);
    for (int c = 0; c < kCount; ++c) parts[c] += load<EightDoubles>(columns[c] + i) * known;
  }
  for (int c = kCount; c-- > 0;) {
    const double* column = node.column(j + c);
    double sum = x[node.first + j + c] / column[j + c];
    for (Index k = j + c + 1; k < node.width; ++k) sum -= column[k] * x[node.first + k];
    for (Index k = i; k < num_below; ++k) sum -= columns[c][k] * below[k];
    for (int k = 0; k < 8; ++k) sum -= parts[c][k];
    x[node.first + j + c] = sum;
  }
}

template <class Values>
SPRUNG_INLINED void solve_all_lower(const SupernodeColumns& node, double* x, double* shares) {
  const Index num_below = node.num_below();
  for (Index i = 0; i < num_below; ++i) store_row<Values>(Values{}, shares, i);
  Index j = 0;
  for (; j + kColumns <= node.width; j += kColumns) solve_columns_lower<Values, kColumns>(node, j, x, shares);
  if (node.width - j == 3) solve_columns_lower<Values, 3>(node, j, x, shares);
  if (node.width - j == 2) solve_columns_lower<Values, 2>(node, j, x, shares);
  if (node.width - j == 1) solve_columns_lower<Values, 1>(node, j, x, shares);
  for (Index i = 0; i < num_below; ++i) {
    const Index row = node.rows_below()[i];
    store_row<Values>(load_row<Values>(x, row) - load_row<Values>(shares, i), x, row);
  }
}

template <class Values, int kCount>
SPRUNG_INLINED void solve_some_upper(const SupernodeColumns& node, Index j, double* x, double* below) {
  if constexpr (sizeof(Values) == sizeof(double)) {
    solve_single_upper<kCount>(node, j, x, below);
  } else {
    solve_columns_upper<Values, kCount>(node, j, x, below);
  }
}

template <class Values>
SPRUNG_INLINED void solve_all_upper(const SupernodeColumns& node, double* x, double* below) {
  const Index num_below = node.num_below();
  for (Index i = 0; i < num_below; ++i)
    store_row<Values>(load_row<Values>(x, node.rows_below()[i]), below, i);
  Index j = node.width;
  for (; j >= kColumns; j -= kColumns) solve_some_upper<Values, kColumns>(node, j - kColumns, x, below);
  if (j == 3) solve_some_upper<Values, 3>(node, 0, x, below);
  if (j == 2) solve_some_upper<Values, 2>(node, 0, x, below);
  if (j == 1) solve_some_upper<Values, 1>(node, 0, x, below);
}

}  // namespace

SPRUNG_VECTORISED
void solve_lower(const SupernodeColumns& node, int num_together, double* x, double* work) {
  if (num_together == 8) solve_all_lower<EightDoubles>(node, x, work);
  if (num_together == 4) solve_all_lower<FourDoubles>(node, x, work);
  if (num_together == 1) solve_all_lower<double>(node, x, work);
}

SPRUNG_VECTORISED
void solve_upper(const SupernodeColumns& node, int num_together, double* x, double* work) {
  if (num_together == 8) solve_all_upper<EightDoubles>(node, x, work);
  if (num_together == 4) solve_all_upper<FourDoubles>(node, x, work);
  if (num_together == 1) solve_all_upper<double>(node, x, work);
}

}  // namespace sprung::reduce
