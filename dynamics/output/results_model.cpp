#include "dynamics/output/results_model.h"

#include "dynamics/output/choice_report.h"
#include "dynamics/output/moving_bodies.h"
#include "dynamics/output/resolved_model.h"
#include "dynamics/output/resting_forces.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace sprung::dynamics {

namespace {

void write_road(support::Hdf5Writer& file, const ResultsHeader& header) {
  const RoadSamples samples = sample_road(header);
  file.write("/model/road/distance", samples.distance, "m");
  file.write("/model/road/height", samples.height, "m");
  file.attribute("/model/road", "shape", header.run.road.shape);
  file.attribute("/model/road", "direction", header.road.direction);
  file.attribute("/model/road", "origin", header.road.origin);
}

void write_bodies(support::Hdf5Writer& file, const ResultsHeader& header) {
  std::vector<std::vector<const Marker*>> markers(header.model.bodies.size());  // on each body
  for (const Marker& marker : header.model.markers) {
    if (marker.body != kGround) markers[static_cast<std::size_t>(marker.body)].push_back(&marker);
  }
  for (std::size_t b = 0; b < header.model.bodies.size(); ++b) {
    const Body& body = header.model.bodies[b];
    const std::string group = "/model/bodies/" + body.name;
    file.make_group(group);
    file.attribute(group, "mass", body.mass);
    file.attribute(group, "inertia", body.second_moment);
    file.attribute(group, "superelement", header.vehicle.bodies[b].superelement);
    file.attribute(group, "num_modes", std::int64_t{body.num_modes()});
    std::vector<std::string> names;
    Eigen::MatrixXd positions(static_cast<Eigen::Index>(markers[b].size()), 2);
    for (const Marker* marker : markers[b]) {
      positions.row(static_cast<Eigen::Index>(names.size())) = marker->p_BP.transpose();
      names.push_back(marker->name);
    }
    file.write(group + "/point_names", names);
    file.write(group + "/point_positions", positions, "m");
  }
}

void write_superelements(support::Hdf5Writer& file, const Vehicle& vehicle) {
  for (const auto& [name, superelement] : vehicle.superelements) {
    const std::string group = "/model/superelements/" + name;
    file.write(group + "/node_positions", Eigen::MatrixXd(superelement.node_positions.transpose()), "m");
    std::vector<std::int64_t> elements;
    for (Eigen::Index e = 0; e < superelement.elements.cols(); ++e) {
      elements.push_back(superelement.elements(0, e));
      elements.push_back(superelement.elements(1, e));
    }
    file.write(group + "/elements", elements, {elements.size() / 2, 2});
    file.write(group + "/frequency", superelement.frequency_hz, "Hz");
    file.write(group + "/damping_ratio", superelement.damping_ratio, "1");
    const auto nodes = static_cast<std::size_t>(superelement.num_nodes());
    const auto modes = static_cast<std::size_t>(superelement.num_modes());
    std::vector<std::string> kinds;
    for (int k = 0; k < superelement.num_modes(); ++k) kinds.push_back(superelement.kind_of(k));
    file.write(group + "/kind", kinds);
    std::vector<double> shapes;
    for (Eigen::Index row = 0; row < superelement.shapes.rows(); ++row) {
      for (Eigen::Index k = 0; k < superelement.shapes.cols(); ++k)
        shapes.push_back(superelement.shapes(row, k));
    }
    file.write(group + "/shapes", shapes, {nodes, 3, modes}, "m, m, rad per unit amplitude");
    file.attribute(group, "content_hash", superelement.content_hash);
    file.attribute(group, "program_version", superelement.provenance.program_version);
  }
}

void write_resting_forces(support::Hdf5Writer& file, const Model& model, const Eigen::VectorXd& q) {
  const RestingForces resting(model, q);
  for (std::size_t f = 0; f < model.forces.size(); ++f) {
    const std::string group = "/model/equilibrium/forces/" + model.forces[f]->name;
    file.make_group(group);
    const std::vector<double> values = resting.calc_channels(f);
    for (std::size_t c = 0; c < values.size(); ++c)
      file.attribute(group, std::string(model.forces[f]->channels()[c].name), values[c]);
  }
}

void write_equilibrium(support::Hdf5Writer& file, const ResultsHeader& header) {
  const Model& model = header.model;
  const Eigen::VectorXd& q = header.equilibrium ? header.equilibrium->q : header.start.q;
  SystemTerms terms(model);
  terms.update_positions(0.0, q);
  for (const Body& body : model.bodies) {
    const Eigen::VectorXd position = q.segment(body.first_coordinate, 3);
    file.write("/model/equilibrium/bodies/" + body.name, position, "m, m, rad");
    if (body.num_modes() == 0) continue;
    const Eigen::VectorXd amplitude = q.segment(body.first_coordinate + 3, body.num_modes());
    file.write("/model/equilibrium/modal/" + body.name, amplitude, "kg^0.5 m");
  }
  for (std::size_t i = 0; i < model.markers.size(); ++i) {
    if (model.markers[i].body == kGround) continue;
    const Eigen::VectorXd position = terms.markers()[i].r;
    file.write("/model/equilibrium/points/" + model.markers[i].name, position, "m");
  }
  file.attribute("/model/equilibrium", "is_static_equilibrium", std::int64_t{header.equilibrium != nullptr});
  file.write("/model/equilibrium/neutral",
             header.equilibrium ? header.equilibrium->describe_neutral() : std::vector<std::string>{});
  if (header.equilibrium) write_resting_forces(file, header.balance_model, q);
}

void write_modes(support::Hdf5Writer& file, const ResultsHeader& header) {
  std::vector<double> undamped, damped, ratio;
  std::vector<std::string> participants;
  Eigen::MatrixXd shapes(header.model.num_coordinates, static_cast<Eigen::Index>(header.modes.size()));
  for (std::size_t k = 0; k < header.modes.size(); ++k) {
    const VehicleMode& mode = header.modes[k];
    undamped.push_back(mode.undamped_frequency_hz);
    damped.push_back(mode.damped_frequency_hz);
    ratio.push_back(mode.damping_ratio);
    participants.push_back(describe_moving_bodies(header.model, header.vehicle, mode));
    shapes.col(static_cast<Eigen::Index>(k)) = mode.shape;
  }
  std::vector<std::string> coordinates;
  for (int i = 0; i < header.model.num_coordinates; ++i)
    coordinates.push_back(header.model.coordinate_name(i));
  file.write("/model/modes/undamped_frequency", undamped, "Hz");
  file.write("/model/modes/damped_frequency", damped, "Hz");
  file.write("/model/modes/damping_ratio", ratio, "1");
  file.write("/model/modes/participants", participants);
  file.write("/model/modes/coordinates", coordinates);
  file.write("/model/modes/shapes", shapes, "mass-normalised");
}

void write_section_peaks(support::Hdf5Writer& file, const SectionStatistics& statistics) {
  for (std::size_t b = 0; b < statistics.peaks().size(); ++b) {
    const BodySections& body = statistics.sections().bodies()[b];
    const SectionPeaks& peaks = statistics.peaks()[b];
    const std::string group = "/summary/sections/" + body.name();
    file.make_group(group);
    for (std::size_t i = 0; i < kQuantityNames.size(); ++i) {
      const auto write = [&](bool is_known, const char* ending, const SectionPeak& peak) {
        if (!is_known) return;
        const std::string name = std::string(kQuantityNames[i]) + ending;
        file.attribute(group, name, peak.value);
        file.attribute(group, name + "_station", std::int64_t{peak.station});
        file.attribute(group, name + "_time", peak.time);
      };
      write(body.has_modes(), "", peaks.from_modes[i]);
      write(body.has_loads(), "_from_loads", peaks.from_loads[i]);
      write(body.has_modes() && body.has_loads(), "_difference", peaks.difference[i]);
    }
    if (!body.has_missing()) continue;
    file.attribute(group, "missing_moment_share", peaks.missing_moment_share());
    file.attribute(group, "missing_moment_time", peaks.missing_moment.time);
    file.attribute(group, "missing_deflection_share", peaks.missing_deflection_share());
    file.attribute(group, "missing_deflection_time", peaks.missing_deflection.time);
    if (body.points().empty()) continue;
    const int place = peaks.missing_deflection.station;
    file.attribute(group, "missing_deflection_point", body.points()[static_cast<std::size_t>(place / 3)]);
    file.attribute(group, "missing_deflection_axis", std::string(place % 3 == 0 ? "x" : "y"));
  }
}

}  // namespace

RoadSamples sample_road(const ResultsHeader& header) {
  constexpr double kSpacing = 0.01;  // m
  constexpr double kMaxSamples = 20000;
  const Road& road = *header.road.road;
  double rearmost = 0.0, foremost = 0.0;
  for (const Body& body : header.model.bodies) {
    const double place = header.road.distance(header.start.q[body.first_coordinate]);
    rearmost = std::min(rearmost, place);
    foremost = std::max(foremost, place);
  }
  const double travel = 1.1 * header.run.speed * header.run.duration;  // a tenth more than at constant speed
  const double from = std::floor(rearmost + std::min(travel, 0.0)) - 2.0;
  const double to = std::ceil(foremost + std::max(travel, 0.0)) + 5.0;
  const double spacing = std::max(kSpacing, (to - from) / kMaxSamples);
  RoadSamples samples;
  std::vector<double>& distance = samples.distance;
  for (double s = from; s <= to; s += spacing) distance.push_back(s);
  for (int k = 0; k < road.num_segments() - 1; ++k) {
    if (road.segment_end(k) > from && road.segment_end(k) < to) distance.push_back(road.segment_end(k));
  }
  std::sort(distance.begin(), distance.end());
  distance.erase(std::unique(distance.begin(), distance.end()), distance.end());
  for (const double s : distance) samples.height.push_back(road.height(s));
  return samples;
}

void write_results_model(support::Hdf5Writer& file, const ResultsHeader& header) {
  file.write("/model/run_text", std::vector<std::string>{header.run.text});
  file.write("/model/vehicle_text", std::vector<std::string>{header.vehicle.text});
  file.write("/model/overrides", header.overrides);
  file.attribute("/model", "speed", header.run.speed);
  file.attribute("/model", "duration", header.run.duration);
  file.attribute("/model", "output_step", header.run.output_step);
  file.attribute("/model", "integrator", std::string(method_name(header.run.integrator.options.method)));
  file.attribute("/model", "relative_tolerance", header.run.integrator.options.relative_tolerance);
  write_resolved_model(file, header);
  write_bodies(file, header);
  write_superelements(file, header.vehicle);
  write_road(file, header);
  write_equilibrium(file, header);
  write_modes(file, header);
  if (header.choice != nullptr) write_choice(file, "/model/mode_choice", *header.choice);
}

void write_results_summary(support::Hdf5Writer& file, const RunStatistics& statistics,
                           const TransientStatistics& transient) {
  file.make_group("/summary");
  for (const PointStatistics& point : statistics.point_statistics()) {
    const std::string group = "/summary/points/" + point.point;
    file.make_group(group);
    const auto write = [&](const std::string& name, const SampleStatistics& sample) {
      file.attribute(group, name + "_min", sample.minimum);
      file.attribute(group, name + "_max", sample.maximum);
      file.attribute(group, name + "_rms", sample.rms);
    };
    write("displacement", point.displacement);
    write("acceleration", point.acceleration);
  }
  write_section_peaks(file, statistics.sections());
  for (const BodyBending& body : statistics.bending()) {
    const std::string group = "/summary/bending/" + body.name();
    file.make_group(group);
    file.attribute(group, "deflection", body.deflection_share());
    file.attribute(group, "deflection_time", body.deflection_time());
    file.attribute(group, "axial_effect", body.axial_effect());
  }
  file.attribute("/summary", "constraint_violation", statistics.constraint_violation());
  file.attribute("/summary", "velocity_violation", transient.stepper.velocity_violation);
  file.attribute("/summary", "energy_closure", statistics.energy_closure());
  file.attribute("/summary", "num_samples", std::int64_t{statistics.num_samples()});
  file.attribute("/summary", "steps", std::int64_t{transient.stepper.integrator.steps});
  file.attribute("/summary", "evaluations", std::int64_t{transient.stepper.evaluations});
  file.attribute("/summary", "output_evaluations", std::int64_t{transient.output_evaluations});
  file.attribute("/summary", "switches", std::int64_t{transient.switches});
  file.attribute("/summary", "repartitions", std::int64_t{transient.stepper.repartitions});
}

}  // namespace sprung::dynamics
