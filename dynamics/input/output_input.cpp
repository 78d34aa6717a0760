#include "dynamics/input/output_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sprung::dynamics {

namespace {

const std::vector<std::string> kStoredGroupKeys(kStoredGroupNames.begin(), kStoredGroupNames.end());

std::vector<PointReference> read_reported(const support::TomlTable& table) {
  std::vector<PointReference> points;
  if (const std::optional<support::TomlValue> list = table.find("points")) {
    for (const support::TomlValue& item : list->items()) points.push_back(read_point(item));
    if (points.empty()) {
      throw list->error(
          "must name at least one point \"body.point\"; leave it out for those of the vehicle's 'monitor'");
    }
  }
  return points;
}

void read_which(const support::TomlValue& value, bool of_points, StorageRequest& request) {
  if (value.is_array()) {
    request.which = StorageRequest::Which::kListed;
    for (const support::TomlValue& item : value.items()) {
      request.names.push_back(item.string());
      request.locations.push_back(item.location());
    }
    return;
  }
  static const std::vector<std::string> kWords{"all", "none"}, kPointWords{"all", "none", "reported"};
  const std::string& word = value.one_of(of_points ? kPointWords : kWords);
  request.which = word == "all"    ? StorageRequest::Which::kAll
                  : word == "none" ? StorageRequest::Which::kNone
                                   : StorageRequest::Which::kReported;
}

// Outputs from one stored row to the next.
long read_every(const support::TomlValue& value, double output_step) {
  const double step = value.number(support::positive("s"));
  const double every = std::round(step / output_step);
  if (!(every >= 1.0) || !(std::abs(step - every * output_step) <= 1e-6 * output_step) || !(every <= 1e7)) {
    throw value.error(
        fmt::format("must be a multiple of the output_step of {} s, got {} s", output_step, step));
  }
  return static_cast<long>(every);
}

bool has_name(const std::vector<std::string>& known, const std::string& name) {
  return std::find(known.begin(), known.end(), name) != known.end();
}

std::vector<std::string> list_names(StoredGroup group, const Vehicle& vehicle) {
  if (group == StoredGroup::kPoints) return point_names(vehicle);
  std::vector<std::string> names;
  if (group == StoredGroup::kBodies || group == StoredGroup::kRecovery) return vehicle.body_names();
  if (group == StoredGroup::kJoints) {
    for (const JointDescription& joint : vehicle.joints) names.push_back(joint.name);
    for (const MotionDescription& motion : vehicle.motions) names.push_back(motion.name);
  } else {
    for (const ForceDescription& force : vehicle.forces) names.push_back(force.name);
  }
  return names;
}

}  // namespace

OutputSettings read_output(const support::TomlTable& table, double output_step) {
  OutputSettings settings;
  settings.points = read_reported(table);
  settings.size = table.number_or("size", settings.size, support::positive("MB"));
  if (const std::optional<support::TomlValue> precision = table.find("precision")) {
    static const std::vector<std::string> kPrecisions{"double", "single", "rounded"};
    const auto found = std::find(kPrecisions.begin(), kPrecisions.end(), precision->one_of(kPrecisions));
    settings.precision = static_cast<StoredPrecision>(found - kPrecisions.begin());
  }
  const std::optional<support::TomlTable> store = table.find_table("store"), steps = table.find_table("step");
  for (std::size_t g = 0; g < kStoredGroupKeys.size(); ++g) {
    StorageRequest& request = settings.groups[g];
    if (store) {
      if (const auto which = store->find(kStoredGroupKeys[g])) {
        read_which(*which, static_cast<StoredGroup>(g) == StoredGroup::kPoints, request);
      }
    }
    if (steps) {
      if (const auto step = steps->find(kStoredGroupKeys[g])) request.every = read_every(*step, output_step);
    }
  }
  if (store) store->reject_unknown_keys();
  if (steps) steps->reject_unknown_keys();
  table.reject_unknown_keys();
  return settings;
}

void check_stored_names(const OutputSettings& settings, const Vehicle& vehicle) {
  for (std::size_t g = 0; g < kStoredGroupKeys.size(); ++g) {
    const StorageRequest& request = settings.groups[g];
    const std::vector<std::string> known = list_names(static_cast<StoredGroup>(g), vehicle);
    for (std::size_t i = 0; i < request.names.size(); ++i) {
      if (has_name(known, request.names[i])) continue;
      throw support::InputError(
          request.locations[i],
          fmt::format("'output.store.{}' names '{}', which the vehicle does not have{}", kStoredGroupKeys[g],
                      request.names[i], support::nearest_name_hint(request.names[i], known)));
    }
  }
}

}  // namespace sprung::dynamics
