#include "dynamics/output/resolved_model.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "dynamics/output/parameter_writer.h"

namespace sprung::dynamics {

namespace {

const std::string kRoot = "/model/resolved";

void write_integrator(support::Hdf5Writer& file, const IntegratorSettings& settings) {
  const std::string group = kRoot + "/settings/integrator";
  const SteppingOptions& options = settings.options;
  file.make_group(group);
  file.attribute(group, "method", method_name(options.method));
  write_number(file, group, "relative_tolerance", options.relative_tolerance, "1");
  write_number(file, group, "largest_step", settings.largest_step, "s");
  if (options.method != SteppingMethod::kGeneralizedAlpha) return;
  write_number(file, group, "spectral_radius", options.generalized_alpha.spectral_radius, "1");
  write_number(file, group, "fixed_step", options.generalized_alpha.fixed_step, "s");
}

void write_adaptivity(support::Hdf5Writer& file, const AdaptivityOptions* adaptivity) {
  const std::string group = kRoot + "/settings/adaptivity";
  file.make_group(group);
  file.attribute(group, "enabled", std::int64_t{adaptivity != nullptr && adaptivity->changes});
  file.attribute(group, "indicator", std::int64_t{adaptivity != nullptr});
  if (adaptivity == nullptr) return;
  write_number(file, group, "recall", adaptivity->thresholds.recall, "1");
  write_number(file, group, "drop", adaptivity->thresholds.drop, "1");
  write_number(file, group, "residence", adaptivity->thresholds.residence, "s");
}

void write_settings(support::Hdf5Writer& file, const ResultsHeader& header) {
  const std::string group = kRoot + "/settings";
  const Run& run = header.run;
  file.make_group(group);
  write_number(file, group, "speed", run.speed, "m/s");
  write_number(file, group, "duration", run.duration, "s");
  write_number(file, group, "output_step", run.output_step, "s");
  write_number(file, group, "statistics_from", run.statistics_from, "s");
  write_number(file, group, "statistics_to", run.statistics_to, "s");
  file.attribute(group, "start", start_name(run.start));
  file.write(group + "/output_points", header.output_points);
  write_integrator(file, run.integrator);
  write_adaptivity(file, header.adaptivity);
}

void write_modes_of(support::Hdf5Writer& file, const std::string& group, const Body& body,
                    const AdaptivityOptions* adaptivity) {
  const int n = body.num_modes();
  std::vector<std::int64_t> active(static_cast<std::size_t>(n), 1);
  Eigen::VectorXd frequency(n), ratio(n);
  for (int k = 0; k < n; ++k) {
    const auto coordinate = static_cast<std::size_t>(body.first_coordinate + 3 + k);
    if (adaptivity != nullptr && adaptivity->changes) {
      active[static_cast<std::size_t>(k)] = adaptivity->active[coordinate] ? 1 : 0;
    }
    const double omega = std::sqrt(body.stiffness(k, k) / body.modal_mass[k]);
    frequency[k] = omega / (2.0 * std::numbers::pi);
    ratio[k] = 0.5 * body.damping(k, k) / (omega * body.modal_mass[k]);
  }
  const std::vector<std::int64_t> numbers(body.mode_numbers.begin(), body.mode_numbers.end());
  file.write(group + "/mode_number", numbers);
  file.write(group + "/active_at_start", active);
  file.write(group + "/frequency", frequency, "Hz");
  file.write(group + "/damping_ratio", ratio, "1");
}

void write_resolved_bodies(support::Hdf5Writer& file, const ResultsHeader& header) {
  for (std::size_t b = 0; b < header.model.bodies.size(); ++b) {
    const Body& body = header.model.bodies[b];
    const BodyDescription& description = header.vehicle.bodies[b];
    const std::string group = kRoot + "/bodies/" + body.name;
    file.make_group(group);
    // Without mass, it is the origin of the body's frame.
    const Eigen::Vector2d center =
        body.mass > 0.0 ? Eigen::Vector2d(body.first_moment / body.mass) : Eigen::Vector2d::Zero();
    write_number(file, group, "mass", body.mass, "kg");
    write_number(file, group, "inertia", body.second_moment - body.mass * center.squaredNorm(), "kg m^2");
    file.attribute(group, "superelement", description.superelement);
    file.attribute(group, "num_modes", std::int64_t{body.num_modes()});
    file.attribute(group, "is_stiffened", std::int64_t{body.stiffening.has_value()});
    file.write(group + "/center_of_mass", center, "m");
    const Eigen::Vector3d place(description.position.x(), description.position.y(), description.angle);
    file.write(group + "/position", place, "m, m, rad");
    if (body.num_modes() > 0) write_modes_of(file, group, body, header.adaptivity);
  }
}

void write_points(support::Hdf5Writer& file, const Model& model, const Vehicle& vehicle) {
  const std::vector<VehiclePoint> points = list_points(vehicle);  // of the markers
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Marker& marker = model.markers[i];
    const std::string group = kRoot + "/points/" + marker.name;
    file.make_group(group);
    file.write(group + "/position", marker.p_BP, "m");
    file.attribute(group, "node", std::int64_t{points[i].node});
    if (marker.body == kGround) {
      file.attribute(group, "body", kGroundName);
      continue;
    }
    file.attribute(group, "body", model.bodies[static_cast<std::size_t>(marker.body)].name);
    if (marker.Phi.cols() > 0) {
      file.write(group + "/shapes", Eigen::MatrixXd(marker.Phi), "m, m, rad per unit amplitude");
    }
  }
}

// Writes what joints and force elements have in common.
// place: from 1, among those of the vehicle file
template <typename Element>
void write_element(support::Hdf5Writer& file, const std::string& group, std::int64_t place,
                   const Element& element, std::span<const int> markers, const Model& model) {
  file.make_group(group);
  file.attribute(group, "place", place);
  file.attribute(group, "kind", element.kind());
  const ElementDescription description = element.describe();
  std::vector<std::string> points;
  for (const int marker : markers) points.push_back(model.markers[static_cast<std::size_t>(marker)].name);
  file.write(group + "/points", points);
  file.write(group + "/point_roles", description.points);
  write_description(file, group, description);
}

// The columns or the lines of its file that a road is the mean of.
std::vector<std::string> list_profiles(const RoadDescription& road) {
  std::vector<std::string> profiles;
  for (const RoadColumn& column : road.heights) profiles.push_back(column.name);
  for (const double lateral : road.lateral) profiles.push_back(fmt::format("{} m", lateral));
  return profiles;
}

void write_road(support::Hdf5Writer& file, const PlacedRoad& road, const RoadDescription& description) {
  const std::string group = kRoot + "/road";
  file.make_group(group);
  file.attribute(group, "shape", road.road->shape());
  file.attribute(group, "file", description.file.filename().string());
  file.attribute(group, "profiles", fmt::format("{}", fmt::join(list_profiles(description), ", ")));
  file.attribute(group, "direction", road.direction);
  write_number(file, group, "origin", road.origin, "m");
  write_description(file, group, road.road->describe());
}

void write_histories(support::Hdf5Writer& file, const std::vector<HistoryUse>& histories) {
  file.make_group(kRoot + "/histories");
  for (const HistoryUse& history : histories) {
    const std::string group = kRoot + "/histories/" + history.key;
    file.make_group(group);
    file.attribute(group, "file", std::filesystem::path(history.file).filename().string());
    file.attribute(group, "channel", history.channel);
    file.attribute(group, "unit", history.unit);
    file.attribute(group, "sha256", history.hash);
    file.attribute(group, "interpolation", history.interpolation);
    file.attribute(group, "scale", history.scale);
    file.attribute(group, "offset", history.offset);
    write_number(file, group, "from", history.from, "s");
    write_number(file, group, "to", history.to, "s");
    file.attribute(group, "before", history.before);
    file.attribute(group, "after", history.after);
  }
}

}  // namespace

void write_resolved_model(support::Hdf5Writer& file, const ResultsHeader& header) {
  const Model& model = header.model;
  file.make_group(kRoot);
  file.attribute(kRoot, "direction", header.vehicle.direction);
  file.write(kRoot + "/gravity", model.gravity, "m/s^2");
  write_settings(file, header);
  write_resolved_bodies(file, header);
  write_points(file, model, header.vehicle);
  for (const std::string kind : {"/joints", "/forces"}) file.make_group(kRoot + kind);
  std::int64_t place = 0;
  for (const auto& joint : model.joints) {
    const std::string group = kRoot + "/joints/" + joint->name;
    write_element(file, group, ++place, *joint, std::array{joint->marker_a, joint->marker_b}, model);
    file.attribute(group, "is_motion", std::int64_t{joint->is_motion()});
  }
  place = 0;
  for (const auto& force : model.forces) {
    write_element(file, kRoot + "/forces/" + force->name, ++place, *force, force->markers(), model);
  }
  write_road(file, header.road, header.run.road);
  write_histories(file, header.vehicle.histories);
}

}  // namespace sprung::dynamics
