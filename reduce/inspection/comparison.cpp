#include "reduce/inspection/comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "reduce/inspection/shape_samples.h"
#include "tools/support/dense/orthogonal_factors.h"

namespace sprung::reduce {

namespace {

constexpr double kLeastOverlap = 0.5;  // mean cos²; below it clusters have nothing to do with each other

// Of the vectors that are modes of the body, free or held at its reference node.
std::vector<ModeRange> list_clusters(const Superelement& s) {
  std::vector<ModeRange> ranges;
  for (ModeRange range; range.begin < s.cluster.size(); range.begin = range.end) {
    range = find_cluster_of(s.cluster, range.begin);
    const std::string kind = s.kind_of(static_cast<int>(range.begin));
    if (kind == kFreeVector || kind == kClampedVector) ranges.push_back(range);
  }
  return ranges;
}

// Clusters of both bodies, by position in `old_ranges` and `new_ranges`.
struct Clusters {
  std::vector<ModeRange> old_ranges, new_ranges;
};

// Whether the modes of both are free, or clamped; true if one has none.
bool are_modes_alike(const Superelement& old_body, const Superelement& new_body, const Clusters& clusters) {
  if (clusters.old_ranges.empty() || clusters.new_ranges.empty()) return true;
  return old_body.kind_of(static_cast<int>(clusters.old_ranges.front().begin)) ==
         new_body.kind_of(static_cast<int>(clusters.new_ranges.front().begin));
}

Eigen::Index count_others(const Superelement& s, const std::vector<ModeRange>& modes) {
  Eigen::Index num = s.cluster.size();
  for (const ModeRange& range : modes) num -= range.size();
  return num;
}

// Orthonormal basis of the displacements of a cluster; columns of zeros where it does not move at the places.
Eigen::MatrixXd make_basis(const Eigen::MatrixXd& shapes, const ModeRange& range) {
  const Eigen::MatrixXd columns = shapes.middleCols(range.begin, range.size());
  if (columns.rows() < columns.cols()) return Eigen::MatrixXd::Zero(columns.rows(), columns.cols());
  support::ColumnSpace space = support::find_column_space(columns, columns.cols());
  space.basis.rightCols(columns.cols() - space.rank).setZero();
  return space.basis;
}

struct Overlap {
  double mean = 0.0;   // of cos² of the principal angles
  double least = 0.0;  // cos² of the largest
};

Overlap calc_overlap(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const Eigen::MatrixXd product = a.transpose() * b;
  const Eigen::VectorXd cosines = support::calc_singular_values(product);
  return {.mean = cosines.cwiseAbs2().mean(),
          .least = std::min(1.0, cosines.minCoeff() * cosines.minCoeff())};
}

// Row: old cluster, column: new cluster.
std::vector<std::vector<Overlap>> calc_overlaps(const ShapeSamples& samples,
                                                const std::vector<ModeRange>& old_ranges,
                                                const std::vector<ModeRange>& new_ranges) {
  std::vector<Eigen::MatrixXd> new_bases;
  for (const ModeRange& range : new_ranges) new_bases.push_back(make_basis(samples.new_shapes, range));
  std::vector<std::vector<Overlap>> overlaps;
  for (const ModeRange& range : old_ranges) {
    const Eigen::MatrixXd basis = make_basis(samples.old_shapes, range);
    std::vector<Overlap>& row = overlaps.emplace_back();
    for (const Eigen::MatrixXd& other : new_bases) row.push_back(calc_overlap(basis, other));
  }
  return overlaps;
}

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

ModeMatch make_match(const ModeRange& old_modes, const ModeRange& new_modes, double mac) {
  return {.old_modes = old_modes, .new_modes = new_modes, .old_hz = 0.0, .new_hz = 0.0, .mac = mac};
}

std::vector<ModeMatch> pair_in_order(const Clusters& clusters) {
  const auto& [old_ranges, new_ranges] = clusters;
  std::vector<ModeMatch> matches;
  for (std::size_t i = 0; i < std::max(old_ranges.size(), new_ranges.size()); ++i) {
    matches.push_back(make_match(i < old_ranges.size() ? old_ranges[i] : ModeRange{},
                                 i < new_ranges.size() ? new_ranges[i] : ModeRange{}, kNone));
  }
  return matches;
}

// Two clusters belong together where either is the other's best; a cluster that split or merged has several
// partners.
std::vector<ModeMatch> pair_by_overlap(const Clusters& clusters,
                                       const std::vector<std::vector<Overlap>>& overlaps) {
  const auto& [old_ranges, new_ranges] = clusters;
  std::vector<std::size_t> best_new(old_ranges.size(), 0), best_old(new_ranges.size(), 0);
  for (std::size_t i = 0; i < old_ranges.size(); ++i) {
    for (std::size_t j = 0; j < new_ranges.size(); ++j) {
      if (overlaps[i][j].mean > overlaps[i][best_new[i]].mean) best_new[i] = j;
      if (overlaps[i][j].mean > overlaps[best_old[j]][j].mean) best_old[j] = i;
    }
  }
  std::vector<ModeMatch> matches;
  std::vector<bool> new_matched(new_ranges.size(), false);
  for (std::size_t i = 0; i < old_ranges.size(); ++i) {
    bool matched = false;
    for (std::size_t j = 0; j < new_ranges.size(); ++j) {
      if ((best_new[i] != j && best_old[j] != i) || overlaps[i][j].mean < kLeastOverlap) continue;
      matches.push_back(make_match(old_ranges[i], new_ranges[j], overlaps[i][j].least));
      matched = new_matched[j] = true;
    }
    if (!matched) matches.push_back(make_match(old_ranges[i], {}, kNone));
  }
  for (std::size_t j = 0; j < new_ranges.size(); ++j) {
    if (!new_matched[j]) matches.push_back(make_match({}, new_ranges[j], kNone));
  }
  return matches;
}

}  // namespace

Comparison compare_modes(const Superelement& old_body, const Superelement& new_body) {
  const ShapeSamples samples = sample_shapes(old_body, new_body);
  const Clusters clusters{.old_ranges = list_clusters(old_body), .new_ranges = list_clusters(new_body)};
  const bool are_alike = are_modes_alike(old_body, new_body, clusters);
  const bool comparable = are_alike && std::min(samples.share_of_old, samples.share_of_new) >= kLeastShare;
  Comparison comparison{
      .num_points = samples.num_points,
      .share_of_old = samples.share_of_old,
      .share_of_new = samples.share_of_new,
      .comparable = comparable,
      .are_alike = are_alike,
      .matches = comparable ? pair_by_overlap(
                                  clusters, calc_overlaps(samples, clusters.old_ranges, clusters.new_ranges))
                            : pair_in_order(clusters),
      .num_other_old = count_others(old_body, clusters.old_ranges),
      .num_other_new = count_others(new_body, clusters.new_ranges)};
  for (ModeMatch& match : comparison.matches) {
    if (match.old_modes.size() > 0) match.old_hz = old_body.frequency_hz(match.old_modes.begin);
    if (match.new_modes.size() > 0) match.new_hz = new_body.frequency_hz(match.new_modes.begin);
  }
  return comparison;
}

}  // namespace sprung::reduce
