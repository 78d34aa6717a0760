#include "dynamics/mode_choice/basis_choice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace sprung::dynamics {

namespace {

using Kind = WatchedQuantity::Kind;
using Set = std::vector<int>;  // positions among the candidates

// Largest change of an r.m.s. by leaving out all frequencies above the highest line, of the tolerance.
constexpr double kCutChange = 0.02;
// Of the highest line: modes up to there are judged even if the change is larger than that.
constexpr double kJudgedShare = 0.5;
constexpr double kMostAbove = 0.02;       // largest share of an r.m.s. above the lines, for the sake of peaks
constexpr double kLeastTolerance = 1e-4;  // the tolerance that kCutChange refers to at least
constexpr Eigen::Index kMostShown = 2000;

std::string describe(const NeglectedShares::Worst& worst, const WatchedQuantities& watched) {
  return fmt::format("{} {}", worst.measure, watched.list[worst.quantity].name);
}

std::string percent(double share) {
  return fmt::format("{:.{}g} %", 100.0 * share, share < 0.995 ? 2 : 3);
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

// Clusters by ascending share; of equal shares the higher mode first.
std::vector<std::size_t> sort_clusters(const std::vector<NeglectedShares>& shares) {
  std::vector<std::size_t> order(shares.size());
  std::iota(order.rbegin(), order.rend(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return shares[a].worst().value < shares[b].worst().value;
  });
  return order;
}

// How many of the first clusters in an order can be left out together.
struct LeftOut {
  std::size_t count = 0;
  std::map<std::size_t, NeglectedShares::Worst> joint;  // by number of clusters, where it was computed
};

Set join_first(std::size_t count, const std::vector<Set>& clusters, const std::vector<std::size_t>& order) {
  Set set;
  for (std::size_t i = 0; i < count; ++i)
    set.insert(set.end(), clusters[order[i]].begin(), clusters[order[i]].end());
  return set;
}

// Starts from the number for which the root of the sum of squared shares reaches the tolerance. Then brackets
// the number by growing steps and bisects.
LeftOut leave_out(const NeglectMeasure& measure, const std::vector<Set>& clusters,
                  const std::vector<std::size_t>& order, const std::vector<NeglectedShares>& by_cluster,
                  double tolerance) {
  LeftOut found;
  if (!(tolerance > 0.0)) return found;
  std::size_t guess = 0, most = 0;  // clusters above the tolerance by themselves stay
  double squares = 0.0;
  for (; most < order.size() && by_cluster[order[most]].worst().value < tolerance; ++most) {
    squares += std::pow(by_cluster[order[most]].worst().value, 2);
    if (squares < tolerance * tolerance) guess = most + 1;
  }
  std::size_t too_many = most + 1, step = 1;
  while (too_many - found.count > 1) {
    if (guess <= found.count || guess >= too_many) guess = (found.count + too_many) / 2;
    const NeglectedShares::Worst worst = measure.measure(join_first(guess, clusters, order)).worst();
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

// Shares of each candidate alone, and of each cluster.
struct Shares {
  std::vector<NeglectedShares> by_mode, by_cluster;
};

Shares measure_alone(const NeglectMeasure& measure, std::size_t num_candidates,
                     const std::vector<Set>& clusters) {
  std::vector<Set> sets;
  for (int i = 0; i < static_cast<int>(num_candidates); ++i) sets.push_back({i});
  std::copy_if(clusters.begin(), clusters.end(), std::back_inserter(sets),
               [](const Set& set) { return set.size() > 1; });
  Shares shares{.by_mode = measure.measure_alone(sets), .by_cluster = {}};
  std::size_t next = num_candidates;
  for (const Set& cluster : clusters) {
    const std::size_t place = cluster.size() > 1 ? next++ : static_cast<std::size_t>(cluster.front());
    shares.by_cluster.push_back(shares.by_mode[place]);
  }
  shares.by_mode.resize(num_candidates);
  return shares;
}

// The reason why the cluster at a position in the order is kept or left out.
std::string explain(std::size_t place, const Set& cluster, const NeglectedShares::Worst& own,
                    const LeftOut& left_out, const std::vector<CandidateMode>& candidates,
                    const WatchedQuantities& watched, double tolerance) {
  const bool is_kept = place >= left_out.count;
  std::string reason = fmt::format("{}: {} of the {}", is_kept ? "kept" : "left out", percent(own.value),
                                   describe(own, watched));
  if (cluster.size() > 1) {
    reason += fmt::format(", modes {} to {} of one frequency together",
                          candidates[static_cast<std::size_t>(cluster.front())].number,
                          candidates[static_cast<std::size_t>(cluster.back())].number);
  }
  if (!is_kept || own.value >= tolerance) return reason;
  reason += "; too much together with all of smaller shares";
  const auto together = left_out.joint.find(place + 1);
  if (together == left_out.joint.end()) return reason;
  return reason +
         fmt::format(", {} of the {}", percent(together->second.value), describe(together->second, watched));
}

// Adds forcing and transfer functions at some of the lines, for a picture.
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

// Modes above this frequency are kept without being judged [Hz].
double find_highest_judged(const NeglectMeasure& measure) {
  if (!measure.is_cut_short()) return std::numeric_limits<double>::infinity();
  return kJudgedShare * measure.forcing().frequency(measure.num_lines() - 1);
}

// Remarks what the prediction does not take into account.
void remark_limits(const NeglectMeasure& measure, BasisChoice& choice) {
  if (measure.is_cut_short()) {
    choice.remarks.push_back(fmt::format(
        "frequencies above {:.4g} Hz are left out of the prediction: up to {:.2g} % of the r.m.s. "
        "of a quantity lie there, so that all modes above {:.4g} Hz are kept",
        measure.forcing().frequency(measure.num_lines() - 1), 100.0 * measure.share_above(),
        find_highest_judged(measure)));
  }
  if (!measure.is_excited()) {
    choice.remarks.emplace_back(
        "neither road nor forces in time move the vehicle: modes are judged by their effect under the weight "
        "alone");
  }
}

// Remarks wheels whose predicted force falls below zero, where the linear prediction is not valid.
void remark_lifting(const LinearVehicle& vehicle, const WatchedQuantities& watched,
                    const NeglectMeasure& measure, BasisChoice& choice) {
  std::string wheels;
  for (const RoadInput& input : vehicle.inputs()) {
    if (!input.is_pressed || !input.can_lift) continue;
    const auto& names = watched.outputs.names;
    const auto found = std::find(names.begin(), names.end(), fmt::format("forces/{}/force", input.name));
    if (found == names.end()) continue;
    const auto row = static_cast<int>(found - names.begin());
    const double standing = vehicle.calc_channels()[watched.outputs.channels[static_cast<std::size_t>(row)]];
    const double lowest = measure.find_lowest(row);
    if (!(standing > 0.0) || standing + lowest >= 0.0) continue;
    if (!wheels.empty()) wheels += ", ";
    wheels += fmt::format("'{}' by {:.4g} % of it", input.name, -100.0 * lowest / standing);
  }
  if (wheels.empty()) return;
  choice.remarks.push_back(
      fmt::format("wheels whose force falls by more than its static value: {}; they leave the ground, which "
                  "the prediction does not contain: compare the run with one with more modes",
                  wheels));
}

// Remarks what forces that are not linear would excite of the modes left out, where it is more than they may
// have.
void remark_nonlinear_forces(const LinearVehicle& vehicle, const WatchedQuantities& watched,
                             const NeglectMeasure& measure, const Set& left_out, BasisChoice& choice) {
  if (left_out.empty() || !measure.is_excited()) return;
  const NonlinearForces forces = measure.calc_nonlinear_forces();
  const NeglectedShares::Worst worst = measure.measure_beyond_linear(left_out, forces).worst();
  if (worst.value >= choice.tolerance) {
    choice.remarks.push_back(fmt::format(
        "the prediction is linear: what the forces of '{}' are beyond that makes the modes left "
        "out {} of the {}; take a smaller tolerance, and compare the run with one with more modes",
        fmt::join(forces.elements, "', '"), percent(worst.value), describe(worst, watched)));
  }
  const std::vector<std::string> unknown = list_unpredictable(vehicle);
  if (unknown.empty()) return;
  choice.remarks.push_back(fmt::format(
      "the prediction takes what '{}' does by friction or orifices as at rest: compare the run with one "
      "with more modes",
      fmt::join(unknown, "', '")));
}

}  // namespace

std::size_t BasisChoice::num_kept() const {
  return static_cast<std::size_t>(std::count_if(verdicts.begin(), verdicts.end(),
                                                [](const ModeVerdict& verdict) { return verdict.is_kept; }));
}

BasisChoice choose_basis(const LinearVehicle& vehicle, const std::vector<CandidateMode>& candidates,
                         const JudgedPlaces& places, const JudgedQuantities& judged,
                         const KnownForcing& forcing, double tolerance) {
  if (!(tolerance >= 0.0) || !(tolerance < 1.0)) {
    throw std::invalid_argument(
        fmt::format("choose_basis: tolerance must be from 0 to below 1, got {}", tolerance));
  }
  BasisChoice choice{.tolerance = tolerance};
  if (candidates.empty()) return choice;
  std::vector<int> coordinates;
  for (const CandidateMode& mode : candidates) coordinates.push_back(mode.coordinate);
  const WatchedQuantities watched = make_watched_quantities(vehicle, places, judged);
  if (!watched.judges_any())
    return keep_all(candidates, tolerance, "the vehicle has none of the quantities that judge");
  // An r.m.s. decreases by e²/2 without a part of the share e (mode_choice, eq. 6).
  const double cut = std::min(std::sqrt(2.0 * kCutChange * std::max(tolerance, kLeastTolerance)), kMostAbove);
  const NeglectMeasure measure(vehicle, watched, coordinates, forcing, cut);
  remark_limits(measure, choice);
  remark_lifting(vehicle, watched, measure, choice);

  const std::vector<Set> clusters = find_clusters(candidates);
  const Shares shares = measure_alone(measure, candidates.size(), clusters);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    choice.verdicts.push_back({.mode = candidates[i],
                               .worth = summarise(shares.by_mode[i], watched),
                               .reason = "kept: above the frequencies of the prediction"});
  }
  std::vector<std::size_t> order = sort_clusters(shares.by_cluster);
  const double highest_judged = find_highest_judged(measure);
  std::erase_if(order, [&](std::size_t cluster) {
    return candidates[static_cast<std::size_t>(clusters[cluster].front())].frequency_hz > highest_judged;
  });
  const LeftOut left_out = leave_out(measure, clusters, order, shares.by_cluster, tolerance);
  if (left_out.count > 0) {
    const NeglectedShares::Worst together = left_out.joint.at(left_out.count);
    choice.neglected = together.value;
    choice.neglected_of = describe(together, watched);
    remark_nonlinear_forces(vehicle, watched, measure, join_first(left_out.count, clusters, order), choice);
  }
  for (std::size_t place = 0; place < order.size(); ++place) {
    const Set& cluster = clusters[order[place]];
    const NeglectedShares::Worst own = shares.by_cluster[order[place]].worst();
    for (const int mode : cluster) {
      ModeVerdict& verdict = choice.verdicts[static_cast<std::size_t>(mode)];
      verdict.is_kept = place >= left_out.count;
      verdict.reason = explain(place, cluster, own, left_out, candidates, watched, tolerance);
    }
  }
  add_spectrum(vehicle, measure, watched, places.points, forcing.speed, choice);
  return choice;
}

BasisChoice keep_all(const std::vector<CandidateMode>& candidates, double tolerance, const std::string& why) {
  BasisChoice choice{.tolerance = tolerance};
  for (const CandidateMode& mode : candidates) {
    choice.verdicts.push_back({.mode = mode, .worth = {}, .reason = "kept: not judged, as " + why});
  }
  choice.remarks.push_back("all modes are kept, as " + why);
  return choice;
}

}  // namespace sprung::dynamics
