#include "dynamics/output/results_writer.h"

#include <fmt/format.h>

#include <algorithm>

#include "dynamics/output/partial_results.h"
#include "dynamics/output/results_model.h"

namespace sprung::dynamics {

namespace {

constexpr std::int64_t kResultsVersion = 2;

constexpr std::size_t kMostBuffered = std::size_t{1} << 28U;  // bytes of rows that are not written yet
constexpr std::size_t kRowsAtOnce = 1024;                     // whole chunks of most histories

void put(std::vector<double>& row, const Eigen::Ref<const Eigen::VectorXd>& values) {
  std::copy(values.data(), values.data() + values.size(), row.begin());
}

}  // namespace

ResultsWriter::ResultsWriter(const std::filesystem::path& path, const ResultsHeader& header)
    : model_(&header.model), points_(list_points(header.vehicle)), file_(path, partial_name(path)) {
  file_.attribute("/", "format", kResultsFormat);
  file_.attribute("/", "version", kResultsVersion);
  file_.attribute("/", "title", header.vehicle.name);
  file_.attribute("/", "units", "SI");
  file_.attribute("/", "program_version", SPRUNG_VERSION);
  file_.attribute("/", "complete", std::int64_t{0});
  write_results_model(file_, header);

  add_series("/time", 0, "s", [](const Snapshot& now, std::vector<double>& row) { row[0] = now.time; });
  add_point_series();
  add_body_series();
  if (header.adaptivity) add_neglected_series(*header.adaptivity->full);
  add_joint_series();
  add_force_series();
  add_recovery_series(header.vehicle);
  const auto add_energy = [this](const std::string& name, auto value) {
    add_series("/energy/" + name, 0, "J",
               [value](const Snapshot& now, std::vector<double>& row) { row[0] = value(now.energy); });
  };
  add_energy("kinetic", [](const EnergyBook& book) { return book.stored.kinetic; });
  add_energy("strain", [](const EnergyBook& book) { return book.stored.strain; });
  add_energy("gravity", [](const EnergyBook& book) { return book.stored.gravity; });
  add_energy("spring", [](const EnergyBook& book) { return book.stored.spring; });
  add_energy("dissipated", [](const EnergyBook& book) { return book.dissipated; });
  add_energy("input", [](const EnergyBook& book) { return book.input; });
  make_datasets(header);
  make_last_state();
  make_event_datasets(header.adaptivity ? *header.adaptivity->full : header.model);
}

ResultsWriter::Series& ResultsWriter::add_series(
    const std::string& dataset, std::size_t columns, const std::string& unit,
    std::function<void(const Snapshot&, std::vector<double>&)> fill) {
  series_.push_back({.name = dataset,
                     .columns = columns,
                     .unit = unit,
                     .row = std::vector<double>(std::max<std::size_t>(columns, 1)),
                     .fill = std::move(fill)});
  return series_.back();
}

// Makes the datasets of the histories that are stored, and forgets the others.
void ResultsWriter::make_datasets(const ResultsHeader& header) {
  const double num_outputs = header.run.duration / header.run.output_step + 1.0;
  StorageConditions conditions{.num_outputs = num_outputs,
                               .output_step = header.run.output_step,
                               .reported = header.output_points,
                               .stiffened_bodies = {}};
  for (const Body& body : model_->bodies) {
    if (body.stiffening) conditions.stiffened_bodies.insert(body.name);
  }
  std::vector<HistorySize> histories;
  for (const Series& series : series_) histories.push_back({series.name, series.row.size()});
  storage_ = std::make_unique<StoragePlan>(header.run.output, histories, std::move(conditions));
  std::erase_if(series_, [&](const Series& series) { return storage_->every(series.name) == 0; });
  std::size_t row_size = 0;  // of all histories
  for (const Series& series : series_) row_size += series.row.size() * sizeof(double);
  const std::size_t most_rows = kMostBuffered / row_size;
  for (Series& series : series_) {
    using support::Hdf5Precision;
    series.every = storage_->every(series.name);
    series.dataset = &file_.make_growing(
        series.name, series.columns, series.unit,
        storage_->is_single(series.name) ? Hdf5Precision::kCompressedSingle : Hdf5Precision::kDouble,
        std::min(num_rows(series, static_cast<std::size_t>(num_outputs)), most_rows));
    if (!series.role.empty()) file_.attribute(series.name, "role", series.role);
    if (series.every > 1) file_.attribute(series.name, "every", std::int64_t{series.every});
  }
}

std::size_t ResultsWriter::num_rows(const Series& series, std::size_t num_outputs) const {
  const auto every = static_cast<std::size_t>(series.every);
  return (num_outputs + every - 1) / every;
}

void ResultsWriter::make_last_state() {
  last_ = {.q = Eigen::VectorXd::Zero(model_->num_coordinates),
           .v = Eigen::VectorXd::Zero(model_->num_coordinates),
           .branches = {}};
  file_.write("/last_state/time", std::vector<double>{0.0}, "s");
  file_.write("/last_state/coordinates", last_.q, "m, rad, kg^0.5 m");
  file_.write("/last_state/velocities", last_.v, "m/s, rad/s, kg^0.5 m/s");
}

void ResultsWriter::write_last_state() {
  file_.overwrite("/last_state/time", std::vector<double>{last_.time});
  const auto size = static_cast<std::size_t>(last_.q.size());
  file_.overwrite("/last_state/coordinates", {last_.q.data(), size});
  file_.overwrite("/last_state/velocities", {last_.v.data(), size});
}

void ResultsWriter::add_marker_motion(const std::string& group, std::size_t marker) {
  const std::size_t i = marker;
  add_series(group + "/position", 2, "m",
             [i](const Snapshot& now, std::vector<double>& row) { put(row, now.terms().markers()[i].r); });
  add_series(group + "/velocity", 2, "m/s",
             [i](const Snapshot& now, std::vector<double>& row) { put(row, now.terms().markers()[i].v); });
  add_series(group + "/acceleration", 2, "m/s^2",
             [i](const Snapshot& now, std::vector<double>& row) { put(row, now.calc_acceleration(i)); });
}

void ResultsWriter::add_point_series() {
  for (std::size_t i = 0; i < model_->markers.size(); ++i) {
    const Marker& marker = model_->markers[i];
    if (marker.body == kGround || points_[i].kind == VehiclePoint::Kind::kCenterOfMass) continue;
    const std::string group = "/points/" + marker.name;
    const Body& body = model_->bodies[static_cast<std::size_t>(marker.body)];
    const int first = body.first_coordinate, size = body.num_coordinates();
    add_marker_motion(group, i);
    if (body.num_modes() == 0) continue;
    add_series(group + "/deflection", 2, "m",
               [&marker, first, size](const Snapshot& now, std::vector<double>& row) {
                 put(row, calc_marker_deflection(marker, now.q.segment(first + 3, size - 3)));
               });
  }
}

void ResultsWriter::add_body_series() {
  for (std::size_t b = 0; b < model_->bodies.size(); ++b) {
    const Body& body = model_->bodies[b];
    const std::string group = "/bodies/" + body.name;
    const int first = body.first_coordinate, n = body.num_modes();
    file_.make_group(group);
    add_series(group + "/position", 3, "m, m, rad",
               [first](const Snapshot& now, std::vector<double>& row) { put(row, now.q.segment<3>(first)); });
    add_series(group + "/velocity", 3, "m/s, m/s, rad/s",
               [first](const Snapshot& now, std::vector<double>& row) { put(row, now.v.segment<3>(first)); });
    add_series(
        group + "/acceleration", 3, "m/s^2, m/s^2, rad/s^2",
        [first](const Snapshot& now, std::vector<double>& row) { put(row, now.v_dot.segment<3>(first)); });
    const auto center = std::find_if(points_.begin(), points_.end(), [b](const VehiclePoint& point) {
      return point.kind == VehiclePoint::Kind::kCenterOfMass && point.body == static_cast<int>(b);
    });
    add_marker_motion(group + "/center_of_mass", static_cast<std::size_t>(center - points_.begin()));
    if (n == 0) continue;
    const auto columns = static_cast<std::size_t>(n);
    const std::vector<std::int64_t> numbers(body.mode_numbers.begin(), body.mode_numbers.end());
    file_.write(group + "/modal/mode_number", numbers);
    add_series(
        group + "/modal/amplitude", columns, "kg^0.5 m",
        [first, n](const Snapshot& now, std::vector<double>& row) { put(row, now.q.segment(first + 3, n)); });
    add_series(
        group + "/modal/rate", columns, "kg^0.5 m/s",
        [first, n](const Snapshot& now, std::vector<double>& row) { put(row, now.v.segment(first + 3, n)); });
    add_series(group + "/modal/acceleration", columns, "kg^0.5 m/s^2",
               [first, n](const Snapshot& now, std::vector<double>& row) {
                 put(row, now.v_dot.segment(first + 3, n));
               });
    add_series(group + "/modal/active", columns, "1", [first](const Snapshot& now, std::vector<double>& row) {
      for (std::size_t k = 0; k < row.size(); ++k) {
        const auto coordinate = static_cast<std::size_t>(first) + 3 + k;
        row[k] = now.modes && now.modes->options().changes && !now.modes->active()[coordinate] ? 0.0 : 1.0;
      }
    });
  }
}

void ResultsWriter::add_neglected_series(const Model& full) {
  for (const Body& body : full.bodies) {
    if (body.num_modes() == 0) continue;
    const int first = body.first_coordinate + 3, last = first + body.num_modes() - 1;
    const std::vector<int> numbers = body.mode_numbers;
    add_series("/bodies/" + body.name + "/modal/neglected", 3, "1",
               [first, last, numbers](const Snapshot& now, std::vector<double>& row) {
                 std::fill(row.begin(), row.end(), 0.0);
                 const ModeIndicator& indicator = now.modes->indicator();
                 double worst = 0.0;
                 for (std::size_t j = 0; j < indicator.num_modes(); ++j) {
                   const int coordinate = indicator.modal_coordinates()[j];
                   const ModeShare& share = indicator.neglected()[j];
                   if (coordinate < first || coordinate > last || share.worst() <= worst) continue;
                   worst = share.worst();
                   row = {share.deflection, share.acceleration,
                          static_cast<double>(numbers[static_cast<std::size_t>(coordinate - first)])};
                 }
               });
  }
}

void ResultsWriter::add_joint_series() {
  for (std::size_t j = 0; j < model_->joints.size(); ++j) {
    const Joint& joint = *model_->joints[j];
    const int row_of_joint = model_->joint_rows[j];
    // Reactions on the joint's points: −Gaᵀλ, −Gbᵀλ.
    for (const bool of_a : {true, false}) {
      const std::string dataset = "/joints/" + joint.name + (of_a ? "/reaction" : "/reaction_b");
      add_series(dataset, 3, "N, N, N m",
                 [&joint, row_of_joint, of_a](const Snapshot& now, std::vector<double>& row) {
                   JointJacobian Ga, Gb;
                   const auto markers = now.terms().markers();
                   joint.calc_jacobian(markers[static_cast<std::size_t>(joint.marker_a)],
                                       markers[static_cast<std::size_t>(joint.marker_b)], Ga, Gb);
                   const Eigen::Vector3d reaction =
                       -(of_a ? Ga : Gb).transpose() *
                       now.multipliers().segment(row_of_joint, joint.num_constraints());
                   put(row, reaction);
                 });
    }
    file_.make_group("/joints/" + joint.name);
    file_.attribute("/joints/" + joint.name, "kind", joint.kind());
    add_joint_coordinate(joint, row_of_joint);
  }
}

void ResultsWriter::add_joint_coordinate(const Joint& joint, int row_of_joint) {
  const std::optional<RelativeCoordinate> coordinate = joint.coordinate();
  if (!coordinate) return;
  const std::string group = "/joints/" + joint.name, unit = coordinate->is_angle() ? "rad" : "m";
  const auto a = static_cast<std::size_t>(joint.marker_a), b = static_cast<std::size_t>(joint.marker_b);
  add_series(group + "/coordinate", 0, unit, [=](const Snapshot& now, std::vector<double>& row) {
    const auto markers = now.terms().markers();
    row[0] = coordinate->value(markers[a], markers[b]);
  });
  add_series(group + "/rate", 0, unit + "/s", [=](const Snapshot& now, std::vector<double>& row) {
    const auto markers = now.terms().markers();
    row[0] = coordinate->rate(markers[a], markers[b]);
  });
  if (!joint.is_motion()) return;
  // The work of the constraint is −λ δφ with φ = coordinate − f(t), so −λ drives the coordinate.
  add_series(group + "/drive", 0, coordinate->is_angle() ? "N m" : "N",
             [row_of_joint](const Snapshot& now, std::vector<double>& row) {
               row[0] = -now.multipliers()[row_of_joint];
             });
}

void ResultsWriter::add_force_series() {
  for (std::size_t f = 0; f < model_->forces.size(); ++f) {
    const ForceElement& force = *model_->forces[f];
    const auto first = static_cast<std::size_t>(model_->force_branches[f]);
    const auto count = static_cast<std::size_t>(force.num_branches());
    // The first of an element's series computes the values of all its channels.
    channels_.emplace_back(force.channels().size());
    const std::span<double> values = channels_.back();
    for (std::size_t c = 0; c < force.channels().size(); ++c) {
      const Channel& channel = force.channels()[c];
      const std::string dataset = fmt::format("/forces/{}/{}", force.name, channel.name);
      add_series(dataset, 0, std::string(channel.unit),
                 [&force, first, count, c, values](const Snapshot& now, std::vector<double>& row) {
                   if (c == 0)
                     force.calc_channels(now.terms().instant(), now.branches.subspan(first, count), values);
                   row[0] = values[c];
                 })
          .role = role_name(channel.role);
    }
    file_.make_group("/forces/" + force.name);
    file_.attribute("/forces/" + force.name, "kind", force.kind());
    add_wrench_series(f);
  }
}

void ResultsWriter::add_wrench_series(std::size_t f) {
  const ForceElement& force = *model_->forces[f];
  const std::vector<int> markers = force.markers();
  const std::vector<std::string> roles = force.describe().points;
  wrenches_.resize(model_->markers.size());
  for (std::size_t p = 0; p < markers.size(); ++p) {
    const auto marker = static_cast<std::size_t>(markers[p]);
    // The first of an element's series computes all its wrenches.
    add_series(fmt::format("/forces/{}/on_{}", force.name, roles[p]), 3, "N, N, N m",
               [this, &force, f, markers, marker, p](const Snapshot& now, std::vector<double>& row) {
                 if (p == 0) {
                   for (const int one : markers) wrenches_[static_cast<std::size_t>(one)] = {};
                   force.add_wrenches(now.terms().instant(), model_->branches_of(f, now.branches), wrenches_);
                 }
                 const Wrench& wrench = wrenches_[marker];
                 row = {wrench.force.x(), wrench.force.y(), wrench.torque};
               });
  }
}

void ResultsWriter::add_recovery_series(const Vehicle& vehicle) {
  for (std::size_t b = 0; b < model_->bodies.size(); ++b) {
    const Body& body = model_->bodies[b];
    const reduce::Superelement* superelement = vehicle.superelement_of(vehicle.bodies[b]);
    if (!superelement || body.num_modes() == 0) continue;
    recoveries_.push_back(std::make_unique<ResultantRecovery>(*superelement, body));
    const ResultantRecovery* recovery = recoveries_.back().get();
    const std::string group = "/recovery/" + body.name;
    const auto stations = static_cast<std::size_t>(recovery->num_stations());
    const int first = body.first_coordinate + 3, n = body.num_modes();
    file_.write(group + "/station", recovery->positions(), "m");
    const auto add = [&](const std::string& name, const std::string& unit, auto resultant) {
      add_series(group + "/" + name, stations, unit,
                 [recovery, first, n, resultant](const Snapshot& now, std::vector<double>& row) {
                   put(row, (recovery->*resultant)(now.q.segment(first, n)));
                 });
    };
    add("axial", "N", &ResultantRecovery::axial);
    add("shear", "N", &ResultantRecovery::shear);
    add("moment", "N m", &ResultantRecovery::moment);
  }
}

void ResultsWriter::add(const Snapshot& snapshot) {
  for (Series& series : series_) {
    if (extent_.rows % static_cast<std::size_t>(series.every) != 0) continue;
    series.fill(snapshot, series.row);
    file_.append(*series.dataset, series.row);
  }
  last_.time = snapshot.time;
  last_.q = snapshot.q;
  last_.v = snapshot.v;
  ++extent_.rows;
}

void ResultsWriter::make_event_datasets(const Model& full) {
  constexpr std::size_t kKindSize = 16, kTextSize = 120;
  std::size_t object_size = 1;
  for (const auto& force : full.forces) object_size = std::max(object_size, force->name.size());
  for (int i = 0; i < full.num_coordinates; ++i)
    object_size = std::max(object_size, full.coordinate_name(i).size());
  event_time_ = &file_.make_growing("/events/time", 0, "s");
  event_kind_ = &file_.make_growing_texts("/events/kind", kKindSize);
  event_object_ = &file_.make_growing_texts("/events/object", object_size);
  event_text_ = &file_.make_growing_texts("/events/text", kTextSize);
}

void ResultsWriter::add(const Event& event) {
  file_.append(*event_time_, std::vector{event.time});
  file_.append_text(*event_kind_, event.kind);
  file_.append_text(*event_object_, event.object);
  file_.append_text(*event_text_, event.text);
  ++extent_.events;
}

void ResultsWriter::take_over(const PartialResults& partial, const ResultsExtent& extent,
                              const Checkpoint& checkpoint) {
  const support::Hdf5Reader& earlier = partial.file();
  for (const Series& series : series_) {
    const std::size_t rows = num_rows(series, extent.rows);
    for (std::size_t row = 0; row < rows; row += kRowsAtOnce) {
      file_.append(*series.dataset, earlier.real_rows(series.name, row, std::min(kRowsAtOnce, rows - row)));
    }
  }
  extent_.rows = extent.rows;
  last_ = checkpoint.state;
  for (const Event& event : partial.read_events(extent.events)) add(event);
}

void ResultsWriter::write_checkpoint(const Checkpoint& checkpoint, const RunStatistics& statistics) {
  write_summary(statistics, checkpoint.statistics);
  const std::string bytes = pack_run_state(checkpoint, extent_, statistics);
  file_.checkpoint(std::string(kCheckpointDataset),
                   std::span(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()));
  has_checkpoint_ = true;
}

void ResultsWriter::write_summary(const RunStatistics& statistics, const TransientStatistics& transient) {
  write_results_summary(file_, statistics, transient);
  write_last_state();
}

void ResultsWriter::finish(const RunStatistics& statistics, const TransientStatistics& transient,
                           const std::vector<RunWarning>& warnings) {
  write_summary(statistics, transient);
  write_warnings(file_, warnings);
  if (has_checkpoint_) file_.remove(std::string(kCheckpointDataset));
  file_.attribute("/", "complete", std::int64_t{1});
  file_.commit();
}

std::filesystem::path ResultsWriter::abandon() {
  file_.keep_partial();
  return file_.partial();
}

}  // namespace sprung::dynamics
