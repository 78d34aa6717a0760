#include "dynamics/output/storage_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace sprung::dynamics {

namespace {

constexpr double kBytesOfDouble = 8.0;
constexpr double kBytesOfSingle = 2.9,
                 kBytesOfRounded = 2.4;    // compressed, measured on vehicles on rough roads
constexpr double kBytesOfDataset = 800.0;  // of HDF5's own, measured
constexpr double kCoarseStep = 0.01;       // s
constexpr double kMegabyte = 1e6;

}  // namespace

StoragePlan::StoragePlan(const OutputSettings& settings, const std::vector<StoredHistory>& histories,
                         StorageConditions conditions)
    : conditions_(std::move(conditions)), precision_(settings.precision.value_or(StoredPrecision::kDouble)) {
  for (std::size_t g = 0; g < choices_.size(); ++g) {
    const StorageRequest& request = settings.groups[g];
    choices_[g] = {request.which, {request.names.begin(), request.names.end()}, request.every.value_or(1)};
    if (request.which == StorageRequest::Which::kBySize) choices_[g].which = StorageRequest::Which::kAll;
  }
  size_ = estimate(histories);
  reduce(settings, histories);
}

void StoragePlan::reduce(const OutputSettings& settings, const std::vector<StoredHistory>& histories) {
  const auto too_large = [&] { return size_ > settings.size; };
  const auto accept = [&](std::string_view words) {
    const double before = size_;
    size_ = estimate(histories);
    if (size_ < before) reductions_.emplace_back(words);
  };
  const std::string interval = fmt::format(
      "every {:g} ms", 1e3 * conditions_.output_step * static_cast<double>(rows_between_coarse()));
  if (too_large() && settings.of(StoredGroup::kPoints).which == StorageRequest::Which::kBySize) {
    choice(StoredGroup::kPoints).which = StorageRequest::Which::kReported;
    accept("only points of the summary (the tools compute the others)");
  }
  if (too_large() && !settings.precision) {
    precision_ = StoredPrecision::kSingle;
    accept("single precision");
  }
  if (too_large() && !settings.precision) {
    precision_ = StoredPrecision::kRounded;
    accept("forces, accelerations and rates to five digits");
  }
  if (too_large() && thin_out(settings, StoredGroup::kRecovery)) accept("stress resultants " + interval);
  if (too_large()) {
    const bool joints = thin_out(settings, StoredGroup::kJoints);
    const bool wrenches = thin_out(settings, StoredGroup::kWrenches);
    if (joints || wrenches) accept("reactions of joints and loads of force elements " + interval);
  }
  if (too_large() && thin_out_motion(settings)) accept("positions and velocities " + interval);
}

// Outputs from one stored row to the next, about kCoarseStep apart.
long StoragePlan::rows_between_coarse() const {
  return std::lround(kCoarseStep / conditions_.output_step);
}

// Stores a group about every kCoarseStep, unless the run file says how often. @return whether that changes
// anything
bool StoragePlan::thin_out(const OutputSettings& settings, StoredGroup group) {
  const long every = rows_between_coarse();
  if (settings.of(group).every || every <= 1) return false;
  choice(group).every = every;
  return true;
}

// Stores positions and velocities of points and bodies about every kCoarseStep, unless the run file says how
// often.
// @return whether outputs are closer than that
bool StoragePlan::thin_out_motion(const OutputSettings& settings) {
  const long every = rows_between_coarse();
  if (every <= 1) return false;
  for (const StoredGroup group : {StoredGroup::kPoints, StoredGroup::kBodies}) {
    if (!settings.of(group).every) choice(group).motion_every = every;
  }
  return true;
}

double StoragePlan::estimate(const std::vector<StoredHistory>& histories) const {
  double bytes = 0.0;
  for (const StoredHistory& history : histories) {
    const long rows_between = every(history);
    if (rows_between == 0) continue;
    bytes += kBytesOfDataset;
    bytes += conditions_.num_outputs / static_cast<double>(rows_between) *
             static_cast<double>(history.row_size) * count_bytes(history);
  }
  return bytes / kMegabyte;
}

long StoragePlan::every(const StoredHistory& history) const {
  if (!history.group) return 1;
  const Choice& choice = choices_[static_cast<std::size_t>(*history.group)];
  const bool is_motion = history.kind == StoredHistory::Kind::kMotion;
  const long stored = is_motion && choice.motion_every > 0 ? choice.motion_every : choice.every;
  switch (choice.which) {
    case StorageRequest::Which::kNone:
      return 0;
    case StorageRequest::Which::kListed:
      return choice.names.contains(history.object) ? stored : 0;
    case StorageRequest::Which::kReported: {
      const std::vector<std::string>& reported = conditions_.reported;
      const bool is_reported = std::find(reported.begin(), reported.end(), history.object) != reported.end();
      const std::string body = body_of_point(history.object);
      return is_reported || conditions_.stiffened_bodies.contains(body) ? stored : 0;
    }
    default:
      return stored;
  }
}

// Of a value.
double StoragePlan::count_bytes(const StoredHistory& history) const {
  const StoredPrecision stored = precision(history);
  if (stored == StoredPrecision::kDouble) return kBytesOfDouble;
  if (history.kind == StoredHistory::Kind::kFlags) return 0.0;
  return stored == StoredPrecision::kRounded ? kBytesOfRounded : kBytesOfSingle;
}

StoredPrecision StoragePlan::precision(const StoredHistory& history) const {
  if (!history.group) return StoredPrecision::kDouble;
  const bool may_be_rounded = history.kind == StoredHistory::Kind::kOther;
  return precision_ == StoredPrecision::kRounded && !may_be_rounded ? StoredPrecision::kSingle : precision_;
}

std::string describe_storage(const StoragePlan& plan, const OutputSettings& settings) {
  std::string text = plan.size() < 0.1
                         ? "less than 0.1 MB"
                         : fmt::format("about {:.{}g} MB", plan.size(), plan.size() < 99.5 ? 2 : 4);
  if (plan.reductions().empty()) return text;
  return text + fmt::format("; for output.size = {:g} MB{}: {}", settings.size,
                            plan.size() > settings.size ? ", which is not reached" : "",
                            fmt::join(plan.reductions(), "; "));
}

support::Json make_storage_json(const StoragePlan& plan) {
  return {{"size", kMegabyte * plan.size()}, {"reductions", plan.reductions()}};
}

}  // namespace sprung::dynamics
