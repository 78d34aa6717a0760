#include "dynamics/statistics/missing_modes_warning.h"

#include <fmt/format.h>

#include <algorithm>

namespace sprung::dynamics {

namespace {

constexpr double kTellable = 1e-3;        // share of a single mode
constexpr double kTooMuchLeftOut = 0.05;  // share of the largest deflection or acceleration

// Of single modes by the forces on them: nothing where all do little by themselves, as where only their start
// differs.
std::string describe_largest(const WorstNeglect& worst, const Model& full) {
  if (worst.share() < kTellable) return "";
  const auto describe = [&](const LargestShare& largest, const char* of) {
    return fmt::format("{:.3g} % of the largest {} (at t = {:.3g} s)", 100.0 * largest.share, of,
                       largest.time);
  };
  const auto name = [&](const LargestShare& largest) {
    return largest.coordinate < 0 ? "each mode" : full.coordinate_name(largest.coordinate);
  };
  const std::string deflection = describe(worst.deflection, "deflection"),
                    acceleration = describe(worst.acceleration, "acceleration of the points asked for");
  if (worst.deflection.coordinate == worst.acceleration.coordinate)
    return fmt::format("{}, which was left out, would have reached {} and {}; ", name(worst.deflection),
                       deflection, acceleration);
  return fmt::format("{}, which was left out, would have reached {}, and {} {}; ", name(worst.deflection),
                     deflection, name(worst.acceleration), acceleration);
}

std::string describe_missing(const MissingAcceleration& missing, const AdaptivityOptions& adaptivity) {
  if (missing.point < 0) return "";
  return fmt::format(
      "{} {:.3g} % of the r.m.s. acceleration of {}, most of it along {}, and "
      "would change its largest by {:.3g} %{}; ",
      adaptivity.changes ? "all that held modes would add is" : "all modes left out together are",
      100.0 * missing.rms_share, name_missing_point(adaptivity, missing), missing.direction == 0 ? "x" : "y",
      100.0 * missing.peak_change, adaptivity.continues ? kHistoryUnknown : "");
}

std::vector<std::string> list_points(const AdaptivityOptions& adaptivity) {
  std::vector<std::string> names;
  for (const int marker : adaptivity.points)
    names.push_back(adaptivity.full->markers[static_cast<std::size_t>(marker)].name);
  return names;
}

}  // namespace

void add_missing_modes_warning(const Model& model, const RunStatistics& statistics,
                               const TransientStatistics& transient, const AdaptivityOptions& adaptivity,
                               std::vector<RunWarning>& warnings) {
  const WorstNeglect& worst = transient.worst_neglect;
  const MissingAcceleration& missing = transient.missing_acceleration;
  if (missing.growth > 0.0) {
    warnings.push_back(
        {.concerns = kSummary,
         .of = list_points(adaptivity),
         .text = fmt::format("what the modes left out would add to accelerations is {}: compare "
                             "the run with one with more modes",
                             describe_growth(missing))});
  }
  // Modes that can join do so before their deflection is missing.
  const bool is_deflection = !adaptivity.changes && worst.deflection.share > kTooMuchLeftOut;
  const bool is_acceleration = missing.point >= 0 && missing.worst() > kTooMuchLeftOut;
  if (worst.share() == 0.0 || (!is_deflection && !is_acceleration)) return;
  const bool is_stiffened = std::any_of(model.bodies.begin(), model.bodies.end(),
                                        [](const Body& body) { return body.stiffening.has_value(); });
  const std::string text =
      adaptivity.changes
          ? fmt::format("modes are missing: {}take a smaller adaptivity.recall, or modes that stay",
                        describe_missing(missing, adaptivity))
          : fmt::format("modes are missing: {}{}take more modes{}", describe_largest(worst, *adaptivity.full),
                        describe_missing(missing, adaptivity),
                        is_stiffened ? "" : ", or [adaptivity] enabled = true");  // together they are refused
  const int coordinate = is_deflection || worst.acceleration.coordinate < 0 ? worst.deflection.coordinate
                                                                            : worst.acceleration.coordinate;
  const auto place = static_cast<std::size_t>(adaptivity.full->body_coordinate(coordinate).body);
  const std::string& body = adaptivity.full->bodies[place].name;
  std::vector<std::string> rows = list_rows_of(body, statistics);
  if (missing.point >= 0) {
    const std::string named = name_missing_point(adaptivity, missing);
    if (std::find(rows.begin(), rows.end(), named) == rows.end()) rows.push_back(named);
  }
  warnings.push_back({kSummary, rows, text});
  warnings.push_back({kModes, {body}, text});
}

std::string name_missing_point(const AdaptivityOptions& adaptivity, const MissingAcceleration& missing) {
  const int marker = adaptivity.points[static_cast<std::size_t>(missing.point)];
  return adaptivity.full->markers[static_cast<std::size_t>(marker)].name;
}

std::string describe_growth(const MissingAcceleration& missing) {
  return fmt::format(
      "not estimated, because small motion about the start, with all modes and without stiffening, grows by "
      "itself ({:.3g} 1/s)",
      missing.growth);
}

}  // namespace sprung::dynamics
