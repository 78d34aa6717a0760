#include "dynamics/output/storage_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace sprung::dynamics {

namespace {

constexpr double kBytesOfDouble = 8.0;
constexpr double kBytesOfSingle = 2.9;  // compressed, measured on vehicles on rough roads
constexpr double kCoarseStep = 0.01;    // s
constexpr double kMegabyte = 1e6;

// The group that a history belongs to, and the point, body, joint or force that it is of.
struct Subject {
  StoredGroup group;
  std::string object;
};

// None for histories that are always stored.
std::optional<Subject> find_subject(const std::string& history) {
  const std::size_t first = history.find('/', 1);
  if (first == std::string::npos) return std::nullopt;
  const std::size_t second = history.find('/', first + 1);
  if (second == std::string::npos) return std::nullopt;
  const std::string group = history.substr(1, first - 1);
  const std::string object = history.substr(first + 1, second - first - 1);
  const std::string rest = history.substr(second + 1);
  if (group == "bodies" && rest.starts_with("center_of_mass/"))
    return Subject{StoredGroup::kPoints, object + ".center_of_mass"};
  if (group == "forces" && rest.starts_with("on_")) return Subject{StoredGroup::kWrenches, object};
  const auto* const name = std::find(kStoredGroupNames.begin(), kStoredGroupNames.end(), group);
  if (name == kStoredGroupNames.end()) return std::nullopt;
  return Subject{static_cast<StoredGroup>(name - kStoredGroupNames.begin()), object};
}

// Whether a history of a point or a body follows from its accelerations, so that it is smooth.
bool is_integrated(const std::string& history) {
  constexpr std::array<std::string_view, 5> kEndings{"/position", "/velocity", "/deflection", "/amplitude",
                                                     "/rate"};
  return std::any_of(kEndings.begin(), kEndings.end(),
                     [&](std::string_view ending) { return history.ends_with(ending); });
}

}  // namespace

StoragePlan::StoragePlan(const OutputSettings& settings, const std::vector<HistorySize>& histories,
                         StorageConditions conditions)
    : conditions_(std::move(conditions)), is_single_(settings.is_single.value_or(false)) {
  for (std::size_t g = 0; g < choices_.size(); ++g) {
    const StorageRequest& request = settings.groups[g];
    choices_[g] = {request.which, {request.names.begin(), request.names.end()}, request.every.value_or(1)};
    if (request.which == StorageRequest::Which::kBySize) choices_[g].which = StorageRequest::Which::kAll;
  }
  size_ = estimate(histories);
  reduce(settings, histories);
}

void StoragePlan::reduce(const OutputSettings& settings, const std::vector<HistorySize>& histories) {
  const auto too_large = [&] { return size_ > settings.size; };
  const auto accept = [&](std::string_view words) {
    const double before = size_;
    size_ = estimate(histories);
    if (size_ < before) reductions_.emplace_back(words);
  };
  const std::string interval = fmt::format("every {:g} ms", 1e3 * kCoarseStep);
  if (too_large() && settings.of(StoredGroup::kPoints).which == StorageRequest::Which::kBySize) {
    choice(StoredGroup::kPoints).which = StorageRequest::Which::kReported;
    accept("only points of the summary (the tools compute the others)");
  }
  if (too_large() && !settings.is_single) {
    is_single_ = true;
    accept("single precision");
  }
  if (too_large() && thin_out(settings, StoredGroup::kRecovery)) accept("stress resultants " + interval);
  if (too_large()) {
    const bool joints = thin_out(settings, StoredGroup::kJoints);
    const bool wrenches = thin_out(settings, StoredGroup::kWrenches);
    if (joints || wrenches) accept("reactions of joints and loads of force elements " + interval);
  }
  if (too_large() && thin_out_motion(settings)) accept("positions and velocities " + interval);
}

// Stores a group every kCoarseStep, unless the run file says how often. @return whether that changes anything
bool StoragePlan::thin_out(const OutputSettings& settings, StoredGroup group) {
  const long every = std::lround(kCoarseStep / conditions_.output_step);
  if (settings.of(group).every || every <= 1) return false;
  choice(group).every = every;
  return true;
}

// Stores positions and velocities of points and bodies every kCoarseStep, unless the run file says how often.
// @return whether that changes anything
bool StoragePlan::thin_out_motion(const OutputSettings& settings) {
  const long every = std::lround(kCoarseStep / conditions_.output_step);
  if (every <= 1) return false;
  for (const StoredGroup group : {StoredGroup::kPoints, StoredGroup::kBodies}) {
    if (!settings.of(group).every) choice(group).motion_every = every;
  }
  return true;
}

double StoragePlan::estimate(const std::vector<HistorySize>& histories) const {
  double bytes = 0.0;
  for (const HistorySize& history : histories) {
    const long rows_between = every(history.name);
    // Flags that hardly ever change take nothing when they are compressed.
    const bool is_constant = is_single(history.name) && history.name.ends_with("/modal/active");
    if (rows_between == 0 || is_constant) continue;
    bytes += conditions_.num_outputs / static_cast<double>(rows_between) *
             static_cast<double>(history.columns) *
             (is_single(history.name) ? kBytesOfSingle : kBytesOfDouble);
  }
  return bytes / kMegabyte;
}

long StoragePlan::every(const std::string& history) const {
  const std::optional<Subject> subject = find_subject(history);
  if (!subject) return 1;
  const Choice& choice = choices_[static_cast<std::size_t>(subject->group)];
  const long stored = choice.motion_every > 0 && is_integrated(history) ? choice.motion_every : choice.every;
  switch (choice.which) {
    case StorageRequest::Which::kNone:
      return 0;
    case StorageRequest::Which::kListed:
      return choice.names.contains(subject->object) ? stored : 0;
    case StorageRequest::Which::kReported: {
      const std::vector<std::string>& reported = conditions_.reported;
      const bool is_reported = std::find(reported.begin(), reported.end(), subject->object) != reported.end();
      const std::string body = body_of_point(subject->object);
      return is_reported || conditions_.stiffened_bodies.contains(body) ? stored : 0;
    }
    default:
      return stored;
  }
}

bool StoragePlan::is_single(const std::string& history) const {
  return is_single_ && find_subject(history).has_value();
}

std::string describe_storage(const StoragePlan& plan, const OutputSettings& settings) {
  std::string text = plan.size() < 0.1 ? "less than 0.1 MB" : fmt::format("about {:.2g} MB", plan.size());
  if (plan.reductions().empty()) return text;
  return text +
         fmt::format("; for output.size = {:g} MB: {}", settings.size, fmt::join(plan.reductions(), "; "));
}

}  // namespace sprung::dynamics
