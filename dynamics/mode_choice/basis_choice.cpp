#include "dynamics/mode_choice/basis_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace sprung::dynamics {

namespace {

using Kind = WatchedQuantity::Kind;
using Set = std::vector<int>;  // positions among the candidates

// What leaving out all above the highest frequency looked at may change an r.m.s. by, of the tolerance.
constexpr double kCutChange = 0.02;
// Of the highest frequency looked at: modes up to there are judged also where more than that lies above it.
constexpr double kJudgedShare = 0.5;
constexpr double kMostAbove = 0.02;       // share of an r.m.s. above it at most: peaks want more than r.m.s.
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

// How many of the clusters in an order can be left out, and what was measured on the way: of the first so
// many.
struct LeftOut {
  std::size_t count = 0;
  std::map<std::size_t, NeglectedShares::Worst> joint;
};

// From a guess, that shares add up like independent ones, by growing steps and halving.
LeftOut leave_out(const NeglectMeasure& measure, const std::vector<Set>& clusters,
                  const std::vector<std::size_t>& order, const std::vector<NeglectedShares>& by_cluster,
                  double tolerance) {
  LeftOut found;
  if (!(tolerance > 0.0)) return found;
  std::size_t guess = 0, most = 0;  // what is too much by itself stays
  double squares = 0.0;
  for (; most < order.size() && by_cluster[order[most]].worst().value < tolerance; ++most) {
    squares += std::pow(by_cluster[order[most]].worst().value, 2);
    if (squares < tolerance * tolerance) guess = most + 1;
  }
  std::size_t too_many = most + 1, step = 1;
  while (too_many - found.count > 1) {
    if (guess <= found.count || guess >= too_many) guess = (found.count + too_many) / 2;
    Set set;
    for (std::size_t i = 0; i < guess; ++i)
      set.insert(set.end(), clusters[order[i]].begin(), clusters[order[i]].end());
    const NeglectedShares::Worst worst = measure.measure(set).worst();
    found.joint[guess] = worst;
    if (worst.value < tolerance) {
      found.count = guess;
      guess += step;
    } else {
      too_many = guess;
      guess = guess > step ? guess - step : 0;
    }
    step *= 2;
  }
  return found;
}

// Forcing and transfer functions, thinned for a picture.
void add_spectrum(const LinearVehicle& vehicle, const NeglectMeasure& measure,
                  const WatchedQuantities& watched, const std::vector<int>& points, double speed,
                  BasisChoice& choice) {
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
  const RowsXcd response = measure.calc_wave_response(lines);
  choice.transfer.resize(static_cast<Eigen::Index>(points.size()), shown);
  for (std::size_t p = 0; p < points.size(); ++p) {
    choice.transfer_names.push_back(vehicle.model().markers[static_cast<std::size_t>(points[p])].name);
    const WatchedQuantity& acceleration = watched.list[2 * p + 1];
    for (Eigen::Index i = 0; i < shown; ++i) {
      const double omega = 2.0 * std::numbers::pi * choice.frequency_hz[static_cast<std::size_t>(i)];
      const Eigen::VectorXcd outputs = response.col(i);
      choice.transfer(static_cast<Eigen::Index>(p), i) =
          std::abs(calc_factor(acceleration, omega)) * outputs(acceleration.rows).norm();
    }
  }
}

// Wheels that the prediction pulls at: where it is outside its range.
void remark_lifting(const LinearVehicle& vehicle, const WatchedQuantities& watched,
                    const NeglectMeasure& measure, BasisChoice& choice) {
  std::string wheels;
  for (const RoadInput& input : vehicle.inputs()) {
    if (!input.is_pressed) continue;
    const auto& names = watched.outputs.names;
    const auto found = std::find(names.begin(), names.end(), fmt::format("forces/{}/force", input.name));
    if (found == names.end()) continue;
    const auto row = static_cast<int>(found - names.begin());
    const double standing = vehicle.calc_channels()[watched.outputs.channels[static_cast<std::size_t>(row)]];
    const double lowest = measure.find_lowest(row);
    if (!(standing > 0.0) || standing + lowest >= 0.0) continue;
    if (!wheels.empty()) wheels += ", ";
    wheels += fmt::format("'{}' by {:.2g} times its standing force", input.name, -lowest / standing);
  }
  if (wheels.empty()) return;
  choice.remarks.push_back(
      fmt::format("relieved of more than what they stand with: {}; these wheels leave the ground, which the "
                  "prediction does "
                  "not see: compare the run with one with more modes",
                  wheels));
}

}  // namespace

std::size_t BasisChoice::num_kept() const {
  return static_cast<std::size_t>(std::count_if(verdicts.begin(), verdicts.end(),
                                                [](const ModeVerdict& verdict) { return verdict.is_kept; }));
}

BasisChoice choose_basis(const LinearVehicle& vehicle, const std::vector<CandidateMode>& candidates,
                         const std::vector<int>& points, const KnownForcing& forcing, double tolerance) {
  if (!(tolerance >= 0.0) || !(tolerance < 1.0)) {
    throw std::invalid_argument(
        fmt::format("choose_basis: tolerance must be from 0 to below 1, got {}", tolerance));
  }
  BasisChoice choice{.tolerance = tolerance};
  if (candidates.empty()) return choice;
  std::vector<int> coordinates;
  for (const CandidateMode& mode : candidates) coordinates.push_back(mode.coordinate);
  const WatchedQuantities watched = make_watched_quantities(vehicle, points);
  // An r.m.s. that loses a part with the share e falls by e²/2 (mode_choice, eq. 6).
  const double cut = std::min(std::sqrt(2.0 * kCutChange * std::max(tolerance, kLeastTolerance)), kMostAbove);
  const NeglectMeasure measure(vehicle, watched, coordinates, forcing, cut);
  const double highest = measure.forcing().frequency(measure.num_lines() - 1);
  const bool is_blind = measure.is_cut_short();
  if (is_blind) {
    choice.remarks.push_back(
        fmt::format("frequencies above {:.4g} Hz are left out of the prediction: {:.2g} % of the r.m.s. of "
                    "one of the quantities lie "
                    "there, so that all modes above {:.4g} Hz are kept",
                    highest, 100.0 * measure.share_above(), kJudgedShare * highest));
  }

  if (!measure.is_excited()) {
    choice.remarks.emplace_back(
        "neither road nor forces in time move the vehicle: modes are judged by what they do under the weight "
        "alone");
  }
  remark_lifting(vehicle, watched, measure, choice);
  // Each mode by itself, then each cluster of several.
  const std::vector<Set> clusters = find_clusters(candidates);
  std::vector<Set> sets;
  for (int i = 0; i < static_cast<int>(candidates.size()); ++i) sets.push_back({i});
  std::copy_if(clusters.begin(), clusters.end(), std::back_inserter(sets),
               [](const Set& set) { return set.size() > 1; });
  const std::vector<NeglectedShares> shares = measure.measure_alone(sets);
  std::vector<NeglectedShares> by_cluster;
  std::size_t next = candidates.size();
  for (const Set& cluster : clusters) {
    by_cluster.push_back(cluster.size() > 1 ? shares[next++]
                                            : shares[static_cast<std::size_t>(cluster.front())]);
  }
  const auto is_beyond = [&](std::size_t cluster) {
    const auto first = static_cast<std::size_t>(clusters[cluster].front());
    return is_blind && candidates[first].frequency_hz > kJudgedShare * highest;
  };
  std::vector<std::size_t> order = sort_clusters(by_cluster);
  const auto judged_end = std::stable_partition(order.begin(), order.end(), std::not_fn(is_beyond));
  const std::vector<std::size_t> beyond(judged_end, order.end());
  order.erase(judged_end, order.end());
  const LeftOut left_out = leave_out(measure, clusters, order, by_cluster, tolerance);
  if (left_out.count > 0) {
    const NeglectedShares::Worst together = left_out.joint.at(left_out.count);
    choice.neglected = together.value;
    choice.neglected_of = describe(together, watched);
  }

  for (std::size_t i = 0; i < candidates.size(); ++i) {
    choice.verdicts.push_back({.mode = candidates[i], .worth = summarise(shares[i], watched), .reason = {}});
  }
  for (std::size_t place = 0; place < order.size(); ++place) {
    const NeglectedShares::Worst own = by_cluster[order[place]].worst();
    const bool is_kept = place >= left_out.count;
    const Set& cluster = clusters[order[place]];
    std::string reason = fmt::format("{}: {} of the {}", is_kept ? "kept" : "left out", percent(own.value),
                                     describe(own, watched));
    if (cluster.size() > 1) {
      reason += fmt::format(", modes {} to {} of one frequency together",
                            candidates[static_cast<std::size_t>(cluster.front())].number,
                            candidates[static_cast<std::size_t>(cluster.back())].number);
    }
    if (is_kept && own.value < tolerance) {
      const auto together = left_out.joint.find(place + 1);
      reason += "; too much with all that have less";
      if (together != left_out.joint.end()) {
        reason += fmt::format(", {} of the {}", percent(together->second.value),
                              describe(together->second, watched));
      }
    }
    for (const int mode : cluster) {
      choice.verdicts[static_cast<std::size_t>(mode)].is_kept = is_kept;
      choice.verdicts[static_cast<std::size_t>(mode)].reason = reason;
    }
  }
  for (const std::size_t cluster : beyond) {
    for (const int mode : clusters[cluster]) {
      choice.verdicts[static_cast<std::size_t>(mode)].is_kept = true;
      choice.verdicts[static_cast<std::size_t>(mode)].reason = "kept: beyond what the prediction looks at";
    }
  }
  add_spectrum(vehicle, measure, watched, points, forcing.speed, choice);
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
