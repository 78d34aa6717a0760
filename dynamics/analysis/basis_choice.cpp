#include "dynamics/analysis/basis_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace sprung::dynamics {

namespace {

using Kind = WatchedQuantity::Kind;
using Set = std::vector<int>;  // positions among the candidates

constexpr double kCutShare = 0.1;       // accuracy of the range of frequencies, of the tolerance
// Of the highest frequency looked at: modes up to there are judged also where much of the forcing lies above it.
constexpr double kJudgedShare = 0.5;
constexpr double kLeastTolerance = 1e-4;  // what it is never finer than
constexpr Eigen::Index kMostShown = 2000;

std::string describe(const NeglectedShares::Worst& worst, const WatchedQuantities& watched) {
  return fmt::format("{} {}", worst.measure, watched.list[worst.quantity].name);
}

std::string percent(double share) {
  return fmt::format("{:.2g} %", 100.0 * share);
}

std::vector<Set> find_clusters(const std::vector<CandidateMode>& candidates) {
  std::vector<Set> clusters;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const bool joins = i > 0 && candidates[i].body == candidates[i - 1].body &&
                       candidates[i].cluster == candidates[i - 1].cluster;
    if (!joins) clusters.emplace_back();
    clusters.back().push_back(static_cast<int>(i));
  }
  return clusters;
}

ModeWorth summarise(const NeglectedShares& shares, const WatchedQuantities& watched) {
  ModeWorth worth;
  for (std::size_t i = 0; i < watched.size(); ++i) {
    const Kind kind = watched.list[i].kind;
    ModeWorth::Pair& pair = kind == Kind::kDisplacement   ? worth.displacement
                            : kind == Kind::kAcceleration ? worth.acceleration
                                                          : worth.force;
    const auto k = static_cast<Eigen::Index>(i);
    pair.rms = std::max(pair.rms, shares.rms[k]);
    pair.peak = std::max(pair.peak, shares.peak[k]);
    worth.weight = std::max(worth.weight, shares.weight[k]);
  }
  return worth;
}

// The least first; of equals the higher mode.
std::vector<std::size_t> sort_clusters(const std::vector<NeglectedShares>& shares) {
  std::vector<std::size_t> order(shares.size());
  std::iota(order.rbegin(), order.rend(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return shares[a].worst().value < shares[b].worst().value;
  });
  return order;
}

void add_spectrum(const LinearVehicle& vehicle, const NeglectMeasure& measure, const std::vector<int>& points,
                  double speed, BasisChoice& choice) {
  const Eigen::Index m = measure.num_lines();
  std::vector<Eigen::Index> lines;
  for (Eigen::Index i = 0; i < std::min(m, kMostShown); ++i) {
    const double u = static_cast<double>(i) / static_cast<double>(kMostShown);
    const Eigen::Index line = m <= kMostShown ? i : std::llround(std::pow(static_cast<double>(m), u)) - 1;
    if (lines.empty() || line > lines.back()) lines.push_back(line);
  }
  const auto shown = static_cast<Eigen::Index>(lines.size());
  choice.road.resize(shown);
  for (Eigen::Index i = 0; i < shown; ++i) {
    const Eigen::Index line = lines[static_cast<std::size_t>(i)];
    choice.frequency_hz.push_back(measure.forcing().frequency(line));
    choice.road[i] = std::abs(measure.forcing().road[line]) * measure.forcing().period;
  }
  if (!(speed > 0.0) || vehicle.inputs().empty()) return;
  choice.transfer.resize(static_cast<Eigen::Index>(points.size()), shown);
  for (std::size_t p = 0; p < points.size(); ++p) {
    choice.transfer_names.push_back(vehicle.model().markers[static_cast<std::size_t>(points[p])].name);
    const LinearOutputs outputs = make_point_outputs(vehicle, points[p]).pick({6, 7});  // acceleration x, y
    for (Eigen::Index i = 0; i < shown; ++i) {
      const RoadWave wave = make_road_wave(choice.frequency_hz[static_cast<std::size_t>(i)], speed);
      choice.transfer(static_cast<Eigen::Index>(p), i) = calc_response(vehicle, outputs, wave).norm();
    }
  }
}

}  // namespace

std::size_t BasisChoice::num_kept() const {
  return static_cast<std::size_t>(
      std::count_if(verdicts.begin(), verdicts.end(), [](const ModeVerdict& verdict) { return verdict.is_kept; }));
}

BasisChoice choose_basis(const LinearVehicle& vehicle, const std::vector<CandidateMode>& candidates,
                         const std::vector<int>& points, const KnownForcing& forcing, double tolerance) {
  if (!(tolerance >= 0.0) || !(tolerance < 1.0)) {
    throw std::invalid_argument(fmt::format("choose_basis: tolerance must be from 0 to below 1, got {}", tolerance));
  }
  BasisChoice choice{.tolerance = tolerance};
  if (candidates.empty()) return choice;
  std::vector<int> coordinates;
  for (const CandidateMode& mode : candidates) coordinates.push_back(mode.coordinate);
  const WatchedQuantities watched = make_watched_quantities(vehicle, points);
  const NeglectMeasure measure(vehicle, watched, coordinates, forcing,
                               kCutShare * std::max(tolerance, kLeastTolerance));
  const double highest = measure.forcing().frequency(measure.num_lines() - 1);
  const bool is_blind = measure.share_above() > tolerance;
  if (measure.is_cut_short()) {
    choice.remarks.push_back(fmt::format(
        "frequencies above {:.4g} Hz are left out of the prediction: {:.2g} % of the r.m.s. of one of the quantities lie "
        "there{}",
        highest, 100.0 * measure.share_above(),
        is_blind ? fmt::format(", so that all modes above {:.4g} Hz are kept", kJudgedShare * highest) : ""));
  }

  // Each mode by itself, then each cluster, then the clusters left out one after the other.
  const std::vector<Set> clusters = find_clusters(candidates);
  std::vector<Set> sets;
  for (int i = 0; i < static_cast<int>(candidates.size()); ++i) sets.push_back({i});
  for (const Set& cluster : clusters) sets.push_back(cluster);
  const std::vector<NeglectedShares> shares = measure.measure(sets);
  const std::vector<NeglectedShares> by_cluster(shares.begin() + static_cast<std::ptrdiff_t>(candidates.size()),
                                                shares.end());
  const auto is_beyond = [&](std::size_t cluster) {
    const auto first = static_cast<std::size_t>(clusters[cluster].front());
    return is_blind && candidates[first].frequency_hz > kJudgedShare * highest;
  };
  std::vector<std::size_t> order = sort_clusters(by_cluster);
  const auto judged_end = std::stable_partition(order.begin(), order.end(), std::not_fn(is_beyond));
  const std::vector<std::size_t> beyond(judged_end, order.end());
  order.erase(judged_end, order.end());
  Set mode_order;
  std::vector<int> sizes;
  for (const std::size_t cluster : order) {
    mode_order.insert(mode_order.end(), clusters[cluster].begin(), clusters[cluster].end());
    sizes.push_back(static_cast<int>(mode_order.size()));
  }
  const std::vector<NeglectedShares> joint = measure.measure_nested(mode_order, sizes);

  for (std::size_t i = 0; i < candidates.size(); ++i) {
    choice.verdicts.push_back({.mode = candidates[i], .worth = summarise(shares[i], watched), .reason = {}});
  }
  bool is_over = false;
  for (std::size_t place = 0; place < order.size(); ++place) {
    const NeglectedShares::Worst together = joint[place].worst(), own = by_cluster[order[place]].worst();
    is_over = is_over || !(together.value < tolerance);
    if (!is_over) {
      choice.neglected = together.value;
      choice.neglected_of = describe(together, watched);
    }
    const Set& cluster = clusters[order[place]];
    std::string reason = fmt::format("{}: {} of the {}", is_over ? "kept" : "left out", percent(own.value),
                                     describe(own, watched));
    if (cluster.size() > 1) {
      reason += fmt::format(", modes {} to {} of one frequency together",
                            candidates[static_cast<std::size_t>(cluster.front())].number,
                            candidates[static_cast<std::size_t>(cluster.back())].number);
    }
    if (is_over && own.value < tolerance) {
      reason += fmt::format("; with all that have less {} of the {}", percent(together.value),
                            describe(together, watched));
    }
    for (const int mode : cluster) {
      choice.verdicts[static_cast<std::size_t>(mode)].is_kept = is_over;
      choice.verdicts[static_cast<std::size_t>(mode)].reason = reason;
    }
  }
  for (const std::size_t cluster : beyond) {
    for (const int mode : clusters[cluster]) {
      choice.verdicts[static_cast<std::size_t>(mode)].is_kept = true;
      choice.verdicts[static_cast<std::size_t>(mode)].reason = "kept: beyond what the prediction looks at";
    }
  }
  add_spectrum(vehicle, measure, points, forcing.speed, choice);
  return choice;
}

BasisChoice keep_all(const std::vector<CandidateMode>& candidates, double tolerance, const std::string& why) {
  BasisChoice choice{.tolerance = tolerance};
  for (const CandidateMode& mode : candidates) {
    choice.verdicts.push_back({.mode = mode, .worth = {}, .reason = "kept: not measured, as " + why});
  }
  choice.remarks.push_back("all modes are kept, as " + why);
  return choice;
}

}  // namespace sprung::dynamics
