#include "dynamics/statistics/run_warnings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "dynamics/section_loads/body_remarks.h"
#include "dynamics/statistics/missing_modes_warning.h"

namespace sprung::dynamics {

namespace {

constexpr double kAlarmingClosure = 1e-3;    // far above the closure at any useful tolerance
constexpr double kClosed = 1e-6;             // gap of a joint, of the largest movement
constexpr double kFarMoved = 0.05;           // of the length scale, by closing the joints
constexpr double kFarMotion = 0.02;          // natural sizes of its coordinate
constexpr double kSmallestScale = 1e-4;      // m: a hundred thousand times the dead band of switches
constexpr double kTooRough = 0.4;            // SampleDensity::roughness: about five samples per period
constexpr double kMissedPeak = 0.1;          // SampleDensity::missed
constexpr double kUnconverged = 0.1;         // estimated error of an acceleration, of its r.m.s.
constexpr double kSmallAcceleration = 1e-3;  // of the natural acceleration: smaller ones are not judged

void warn_of_energy(const RunStatistics& statistics, std::vector<RunWarning>& warnings) {
  if (statistics.energy_closure() <= kAlarmingClosure) return;
  warnings.push_back(
      {.concerns = kSummary,
       .of = {std::string(kComputation)},
       .text = fmt::format(
           "the energy balance does not close (relative {:.1e}): do not trust this run; try a smaller "
           "relative tolerance, and look for motion much smaller than the vehicle",
           statistics.energy_closure()),
       .fails = true});
}

void add_remarks(const std::vector<BodyRemark>& remarks, const RunStatistics& statistics,
                 std::vector<RunWarning>& warnings) {
  for (const BodyRemark& remark : remarks)
    warnings.push_back({kSummary, list_rows_of(remark.body, statistics), remark.text});
}

// Accelerations below this count as this: a share of gravity, at least of one length scale per s² [m/s²].
double find_smallest_acceleration(const Model& model) {
  return kSmallAcceleration * std::max(model.gravity.norm(), model.length_scale);
}

void warn_of_unconverged_accelerations(const Model& model, const RunStatistics& statistics,
                                       std::vector<RunWarning>& warnings) {
  const std::vector<PointStatistics> all = statistics.point_statistics();
  std::vector<std::string> points;
  const PointStatistics* worst = nullptr;
  double worst_share = kUnconverged;
  for (const PointStatistics& point : all) {
    const double share =
        point.acceleration_error_rms / std::max(find_smallest_acceleration(model), point.acceleration_rms);
    if (!(share > kUnconverged)) continue;
    points.push_back(point.point);
    if (share < worst_share) continue;
    worst = &point;
    worst_share = share;
  }
  if (worst == nullptr) return;
  warnings.push_back(
      {.concerns = kSummary,
       .of = points,
       .text = fmt::format(
           "the accelerations are not converged: the estimated error of that of {} is {:.2g} m/s² "
           "r.m.s., where it has {:.3g} m/s² r.m.s.: vibration of stiff modes, which steps excite; take "
           "a smaller integrator.relative_tolerance, or fewer modes, or compare with "
           "another integrator.method",
           worst->point, worst->acceleration_error_rms, worst->acceleration_rms),
       .fails = true});
}

// Of accelerations that the outputs may have missed the peaks of.
void warn_of_coarse_outputs(const Model& model, const RunStatistics& statistics,
                            std::vector<RunWarning>& warnings) {
  const double floor = find_smallest_acceleration(model);
  const std::vector<PointStatistics> all = statistics.point_statistics();
  std::vector<std::string> points;
  std::string reason;
  double worst_missed = kMissedPeak, worst_roughness = kTooRough;
  for (const PointStatistics& point : all) {
    bool is_coarse = false;
    for (const std::size_t i : {0, 1}) {
      const SampleDensity& density = point.density[i];
      const double missed = density.missed(floor), roughness = density.roughness(floor);
      is_coarse = is_coarse || missed > kMissedPeak || roughness > kTooRough;
      const std::string which = fmt::format("that of {} along {}", point.point, i == 0 ? "x" : "y");
      if (missed > worst_missed) {
        worst_missed = missed;
        reason = fmt::format("{} reached {:.3g} m/s² in between, where they have {:.3g} to {:.3g} m/s²",
                             which, density.farthest_between(), density.smallest(), density.largest());
      } else if (worst_missed == kMissedPeak && roughness > worst_roughness) {
        worst_roughness = roughness;
        reason = fmt::format("{} differs at each by {:.3g} % r.m.s. from the curve through its neighbours",
                             which, 100.0 * roughness);
      }
    }
    if (is_coarse) points.push_back(point.point);
  }
  if (points.empty()) return;
  warnings.push_back(
      {kSummary, points,
       fmt::format(
           "values every {:.6g} s do not resolve the accelerations: {}; so their peaks, and those of "
           "forces and moments, may be wrong: take a smaller {}; where that does not help, the accelerations "
           "are errors of a large tolerance",
           statistics.stored_step(), reason,
           statistics.stored_step() > statistics.output_step() ? "step.points of [output]" : "output_step")});
}

// Of bending moments that the outputs may have missed the peaks of: one warning for each body.
void warn_of_coarse_moments(const RunStatistics& statistics, std::vector<RunWarning>& warnings) {
  const std::vector<BodySections>& bodies = statistics.sections().sections().bodies();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const MomentDensity& moments = statistics.moments()[b];
    const double floor = std::max(moments.floor(), statistics.sections().peaks()[b].rounding_moment());
    if (floor == 0.0) continue;
    const SampleDensity* most_missed = nullptr;
    double worst_roughness = 0.0;
    for (const SampleDensity& element : moments.elements()) {
      worst_roughness = std::max(worst_roughness, element.roughness_by_steps(floor));
      if (element.missed(floor) <= kMissedPeak) continue;
      if (most_missed == nullptr ||
          std::abs(element.farthest_between()) > std::abs(most_missed->farthest_between()))
        most_missed = &element;
    }
    std::string reason;
    if (most_missed != nullptr) {
      reason = fmt::format(
          "one changed by {:.3g} N·m in between, and by {:.3g} to {:.3g} N·m at them, since the start",
          most_missed->farthest_between(), most_missed->smallest(), most_missed->largest());
    } else if (worst_roughness > kTooRough) {
      reason = "one of them vibrates with fewer than five values in a period";
    } else {
      continue;
    }
    warnings.push_back(
        {kSummary,
         {bodies[b].name()},
         fmt::format("values every {:.6g} s do not resolve the bending moments of {}: {}; so the "
                     "largest loads of its sections, its stresses and its fatigue damage may be "
                     "too small: take a smaller output_step",
                     statistics.output_step(), bodies[b].name(), reason)});
  }
}

// A text with the name of the file alone in the place before it, `path:line:column: `, if it begins with one.
std::string remove_folders(const std::string& text) {
  for (auto end = text.find(": ", 1); end != std::string::npos; end = text.find(": ", end + 1)) {
    const auto before = text.find_last_not_of("0123456789", end - 1);
    if (before == std::string::npos || before + 1 == end || text[before] != ':') continue;
    const auto separator = text.rfind('/', before);
    return separator == std::string::npos ? text : text.substr(separator + 1);
  }
  return text;
}

}  // namespace

bool goes_to_stderr(const RunWarning& warning) {
  return warning.fails || warning.of == std::vector<std::string>{std::string(kComputation)};
}

bool is_converged(const std::vector<RunWarning>& warnings) {
  return std::none_of(warnings.begin(), warnings.end(),
                      [](const RunWarning& warning) { return warning.fails; });
}

std::string describe_far_movement(const Model& model, const AssemblyReport& assembly) {
  if (!(assembly.largest_movement > kFarMoved * model.length_scale)) return {};
  const bool was_open = assembly.widest_gap > kClosed * assembly.largest_movement;
  return fmt::format(
      "to {}, {} was moved by {:.3g} m; no point is farther than {:.3g} m from its body's origin: check {}",
      was_open
          ? fmt::format("close the joints, of which '{}' was {:.3g} m open", assembly.open_joint,
                        assembly.widest_gap)
          : "give the joints, which were closed, their angles and the values of their prescribed motions",
      assembly.moved_marker, assembly.largest_movement, model.length_scale,
      was_open ? "the positions of the bodies and the points of the joints"
               : "the angles of the bodies, and the motions at the start");
}

std::vector<RunWarning> list_model_warnings(const Model& model, const AssemblyReport& assembly,
                                            const State& start, const Equilibrium* equilibrium) {
  std::vector<RunWarning> warnings;
  const auto warn = [&](std::string text) {
    warnings.push_back({kSummary, {std::string(kComputation)}, std::move(text)});
  };
  const MotionGap& gap = assembly.motion_gap;
  if (gap.natural_size > kFarMotion && assembly.largest_movement <= model.length_scale) {
    warn(fmt::format(
        "the prescribed motion '{}' begins at a value {:.3g} {} {} than in the drawing, so that bodies were "
        "moved and turned to meet it, and what is \"as-drawn\" is as it is there; begin its function at "
        "the drawn value",
        gap.motion, std::abs(gap.above), gap.unit, gap.above > 0.0 ? "smaller" : "larger"));
  } else if (std::string moved = describe_far_movement(model, assembly); !moved.empty()) {
    warn(std::move(moved));
  }
  if (equilibrium && !equilibrium->stable && start.q == equilibrium->q) {
    warn(
        "the run starts in an unstable equilibrium: without a disturbance it stays there, and any "
        "disturbance grows; draw it slightly away, and the stable one is found");
  }
  if (model.length_scale < kSmallestScale) {
    warn(
        fmt::format("no point is farther than {:.1e} m from its body's origin; the dead band of switching "
                    "forces, 1e-9 m, is not small against that: use smaller units, as mm with g and ms",
                    model.length_scale));
  }
  return warnings;
}

std::vector<RunWarning> list_run_warnings(const Vehicle& vehicle, const Model& model,
                                          const RunStatistics& statistics,
                                          const TransientStatistics& transient,
                                          const AdaptivityOptions* adaptivity) {
  const JudgedQuantities& judged = vehicle.judged;
  std::vector<RunWarning> warnings;
  warn_of_energy(statistics, warnings);
  warn_of_unconverged_accelerations(model, statistics, warnings);
  if (adaptivity != nullptr && judged.points) {
    add_missing_modes_warning(model, statistics, transient, *adaptivity, warnings);
  }
  warn_of_coarse_outputs(model, statistics, warnings);
  if (judged.moments) warn_of_coarse_moments(statistics, warnings);
  add_remarks(list_missing_parts(statistics.sections(), judged), statistics, warnings);
  add_remarks(list_large_bending(statistics.bending()), statistics, warnings);
  if (judged.points) {
    add_remarks(list_missed_by_bases(statistics.certified()), statistics, warnings);
  }
  return warnings;
}

std::vector<RunWarning> list_file_warnings(const std::vector<std::string>& remarks) {
  std::vector<RunWarning> warnings;
  for (const std::string& remark : remarks)
    warnings.push_back({kSummary, {std::string(kComputation)}, remark});
  return warnings;
}

support::Json make_warnings_json(const std::vector<RunWarning>& warnings) {
  support::Json list = support::Json::array();
  for (const RunWarning& warning : warnings)
    list.push_back({{"concerns", warning.concerns}, {"of", warning.of}, {"text", warning.text}});
  return list;
}

void write_warnings(support::Hdf5Writer& file, const std::vector<RunWarning>& warnings) {
  std::vector<std::string> concerns, of, texts;
  for (const RunWarning& warning : warnings) {
    concerns.push_back(warning.concerns);
    of.push_back(fmt::format("{}", fmt::join(warning.of, ", ")));
    texts.push_back(remove_folders(warning.text));
  }
  file.write("/warnings/concerns", concerns);
  file.write("/warnings/of", of);
  file.write("/warnings/text", texts);
}

}  // namespace sprung::dynamics
