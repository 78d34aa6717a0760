#include "dynamics/output/run_histories.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "dynamics/section_loads/section_statistics.h"

namespace sprung::dynamics {

namespace {

void put(std::span<double> row, const Eigen::Ref<const Eigen::VectorXd>& values) {
  std::copy(values.data(), values.data() + values.size(), row.begin());
}

}  // namespace

RunHistories::RunHistories(const Vehicle& vehicle, const Model& model, const VehicleSections& sections,
                           const Model* full)
    : model_(&model), points_(list_points(vehicle)) {
  add("/time", 0, "s", [](const Snapshot& now, std::span<double> row) { row[0] = now.time; });
  add_points();
  add_bodies();
  if (full != nullptr) add_neglected(*full);
  add_joints();
  add_forces();
  add_sections(sections);
  begin({}, "");
  const auto add_energy = [this](const std::string& name, auto value) {
    add("/energy/" + name, 0, "J",
        [value](const Snapshot& now, std::span<double> row) { row[0] = value(now.energy); });
  };
  add_energy("kinetic", [](const EnergyBook& book) { return book.stored.kinetic; });
  add_energy("strain", [](const EnergyBook& book) { return book.stored.strain; });
  add_energy("gravity", [](const EnergyBook& book) { return book.stored.gravity; });
  add_energy("spring", [](const EnergyBook& book) { return book.stored.spring; });
  add_energy("dissipated", [](const EnergyBook& book) { return book.dissipated; });
  add_energy("input", [](const EnergyBook& book) { return book.input; });
}

// The histories that are added from now on belong to this object.
void RunHistories::begin(std::optional<StoredGroup> group, const std::string& object) {
  group_ = group;
  object_ = object;
}

History& RunHistories::add(const std::string& name, std::size_t columns, const std::string& unit,
                           std::function<void(const Snapshot&, std::span<double>)> fill) {
  using Kind = StoredHistory::Kind;
  const StoredHistory stored{.name = name,
                             .row_size = std::max<std::size_t>(columns, 1),
                             .group = group_,
                             .object = object_,
                             .kind = unit == "m" || unit == "rad" ? Kind::kPlace : Kind::kOther};
  histories_.push_back({stored, columns, unit, std::move(fill)});
  return histories_.back();
}

void RunHistories::add_motion(const std::string& name, std::size_t columns, const std::string& unit,
                              std::function<void(const Snapshot&, std::span<double>)> fill) {
  add(name, columns, unit, std::move(fill)).kind = StoredHistory::Kind::kMotion;
}

void RunHistories::add_marker_motion(const std::string& group, std::size_t marker) {
  const std::size_t i = marker;
  add_motion(group + "/position", 2, "m",
             [i](const Snapshot& now, std::span<double> row) { put(row, now.terms().markers()[i].r); });
  add_motion(group + "/velocity", 2, "m/s",
             [i](const Snapshot& now, std::span<double> row) { put(row, now.terms().markers()[i].v); });
  add(group + "/acceleration", 2, "m/s^2",
      [i](const Snapshot& now, std::span<double> row) { put(row, now.calc_acceleration(i)); });
}

void RunHistories::add_points() {
  for (std::size_t i = 0; i < model_->markers.size(); ++i) {
    const Marker& marker = model_->markers[i];
    if (marker.body == kGround || points_[i].kind == VehiclePoint::Kind::kCenterOfMass) continue;
    const std::string group = "/points/" + marker.name;
    const Body& body = model_->bodies[static_cast<std::size_t>(marker.body)];
    const int first = body.first_coordinate, size = body.num_coordinates();
    begin(StoredGroup::kPoints, marker.name);
    add_marker_motion(group, i);
    if (body.num_modes() == 0) continue;
    add_motion(group + "/deflection", 2, "m",
               [&marker, first, size](const Snapshot& now, std::span<double> row) {
                 put(row, calc_marker_deflection(marker, now.q.segment(first + 3, size - 3)));
               });
  }
}

void RunHistories::add_bodies() {
  std::vector<std::size_t> centers(model_->bodies.size());  // the points that are centres of mass
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (points_[i].kind == VehiclePoint::Kind::kCenterOfMass)
      centers[static_cast<std::size_t>(points_[i].body)] = i;
  }
  for (std::size_t b = 0; b < model_->bodies.size(); ++b) {
    const Body& body = model_->bodies[b];
    const std::string group = "/bodies/" + body.name;
    const int first = body.first_coordinate, n = body.num_modes();
    begin(StoredGroup::kBodies, body.name);
    add_motion(group + "/position", 3, "m, m, rad",
               [first](const Snapshot& now, std::span<double> row) { put(row, now.q.segment<3>(first)); });
    add_motion(group + "/velocity", 3, "m/s, m/s, rad/s",
               [first](const Snapshot& now, std::span<double> row) { put(row, now.v.segment<3>(first)); });
    add(group + "/acceleration", 3, "m/s^2, m/s^2, rad/s^2",
        [first](const Snapshot& now, std::span<double> row) { put(row, now.v_dot.segment<3>(first)); });
    begin(StoredGroup::kPoints, body.name + ".center_of_mass");
    add_marker_motion(group + "/center_of_mass", centers[b]);
    if (n == 0) continue;
    begin(StoredGroup::kBodies, body.name);
    const auto columns = static_cast<std::size_t>(n);
    add_motion(
        group + "/modal/amplitude", columns, "kg^0.5 m",
        [first, n](const Snapshot& now, std::span<double> row) { put(row, now.q.segment(first + 3, n)); });
    add_motion(
        group + "/modal/rate", columns, "kg^0.5 m/s",
        [first, n](const Snapshot& now, std::span<double> row) { put(row, now.v.segment(first + 3, n)); });
    add(group + "/modal/acceleration", columns, "kg^0.5 m/s^2",
        [first, n](const Snapshot& now, std::span<double> row) {
          put(row, now.v_dot.segment(first + 3, n));
        });
    add(group + "/modal/active", columns, "1", [first](const Snapshot& now, std::span<double> row) {
      for (std::size_t k = 0; k < row.size(); ++k) {
        const auto coordinate = static_cast<std::size_t>(first) + 3 + k;
        row[k] = now.modes && now.modes->options().changes && !now.modes->active()[coordinate] ? 0.0 : 1.0;
      }
    }).kind = StoredHistory::Kind::kFlags;
  }
}

void RunHistories::add_neglected(const Model& full) {
  std::size_t first = 0;  // of the body's modes among all
  for (const Body& body : full.bodies) {
    if (body.num_modes() == 0) continue;
    const std::vector<int> numbers = body.mode_numbers;
    begin(StoredGroup::kBodies, body.name);
    add("/bodies/" + body.name + "/modal/neglected", 3, "1",
        [first, numbers](const Snapshot& now, std::span<double> row) {
          std::fill(row.begin(), row.end(), 0.0);
          double worst = 0.0;
          for (std::size_t k = 0; k < numbers.size(); ++k) {
            const ModeShare share = now.modes->indicator().calc_neglected(first + k);
            if (share.worst() <= worst) continue;
            worst = share.worst();
            row[0] = share.deflection;
            row[1] = share.acceleration;
            row[2] = numbers[k];
          }
        });
    first += numbers.size();
  }
}

void RunHistories::add_joints() {
  for (std::size_t j = 0; j < model_->joints.size(); ++j) {
    const Joint& joint = *model_->joints[j];
    const int row_of_joint = model_->joint_rows[j];
    begin(StoredGroup::kJoints, joint.name);
    // Reactions on the joint's points: −Gaᵀλ, −Gbᵀλ.
    for (const bool of_a : {true, false}) {
      const std::string dataset = "/joints/" + joint.name + (of_a ? "/reaction" : "/reaction_b");
      add(dataset, 3, "N, N, N m", [&joint, row_of_joint, of_a](const Snapshot& now, std::span<double> row) {
        JointJacobian Ga, Gb;
        const auto markers = now.terms().markers();
        joint.calc_jacobian(markers[static_cast<std::size_t>(joint.marker_a)],
                            markers[static_cast<std::size_t>(joint.marker_b)], Ga, Gb);
        const Eigen::Vector3d reaction =
            -(of_a ? Ga : Gb).transpose() * now.multipliers().segment(row_of_joint, joint.num_constraints());
        put(row, reaction);
      });
    }
    add_joint_coordinate(joint, row_of_joint);
  }
}

void RunHistories::add_joint_coordinate(const Joint& joint, int row_of_joint) {
  const std::optional<RelativeCoordinate> coordinate = joint.coordinate();
  if (!coordinate) return;
  const std::string group = "/joints/" + joint.name, unit = coordinate->is_angle() ? "rad" : "m";
  const auto a = static_cast<std::size_t>(joint.marker_a), b = static_cast<std::size_t>(joint.marker_b);
  add(group + "/coordinate", 0, unit, [=](const Snapshot& now, std::span<double> row) {
    const auto markers = now.terms().markers();
    row[0] = coordinate->value(markers[a], markers[b]);
  });
  add(group + "/rate", 0, unit + "/s", [=](const Snapshot& now, std::span<double> row) {
    const auto markers = now.terms().markers();
    row[0] = coordinate->rate(markers[a], markers[b]);
  });
  if (!joint.is_motion()) return;
  // The work of the constraint is −λ δφ with φ = coordinate − f(t), so −λ drives the coordinate.
  add(group + "/drive", 0, coordinate->is_angle() ? "N m" : "N",
      [row_of_joint](const Snapshot& now, std::span<double> row) {
        row[0] = -now.multipliers()[row_of_joint];
      });
}

void RunHistories::add_forces() {
  for (std::size_t f = 0; f < model_->forces.size(); ++f) {
    const ForceElement& force = *model_->forces[f];
    begin(StoredGroup::kForces, force.name);
    const auto first = static_cast<std::size_t>(model_->force_branches[f]);
    const auto count = static_cast<std::size_t>(force.num_branches());
    // The first of an element's histories computes the values of all its channels.
    channels_.emplace_back(force.channels().size());
    const std::span<double> values = channels_.back();
    for (std::size_t c = 0; c < force.channels().size(); ++c) {
      const Channel& channel = force.channels()[c];
      const std::string dataset = fmt::format("/forces/{}/{}", force.name, channel.name);
      add(dataset, 0, std::string(channel.unit),
          [&force, f, first, count, c, values](const Snapshot& now, std::span<double> row) {
            if (c == 0)
              force.calc_channels(now.terms().instant_of(f), now.branches.subspan(first, count), values);
            row[0] = values[c];
          })
          .role = role_name(channel.role);
    }
    add_wrenches(f);
    add_states(f);
  }
}

void RunHistories::add_states(std::size_t f) {
  const int count = model_->force_states[f + 1] - model_->force_states[f];
  if (count == 0) return;
  begin(StoredGroup::kForces, model_->forces[f]->name);
  const int first = model_->force_states[f] - model_->num_states();  // from the end of the velocities
  add(fmt::format("/forces/{}/state", model_->forces[f]->name), static_cast<std::size_t>(count), "J^0.5",
      [first, count](const Snapshot& now, std::span<double> row) {
        put(row, now.v.segment(now.v.size() + first, count));
      });
}

void RunHistories::add_wrenches(std::size_t f) {
  const ForceElement& force = *model_->forces[f];
  const std::vector<int> markers = force.markers();
  const std::vector<std::string> roles = force.describe().points;
  wrenches_.resize(model_->markers.size());
  begin(StoredGroup::kWrenches, force.name);
  for (std::size_t p = 0; p < markers.size(); ++p) {
    const auto marker = static_cast<std::size_t>(markers[p]);
    // The first of an element's histories computes all its wrenches.
    add(fmt::format("/forces/{}/on_{}", force.name, roles[p]), 3, "N, N, N m",
        [this, &force, f, markers, marker, p](const Snapshot& now, std::span<double> row) {
          if (p == 0) {
            for (const int one : markers) wrenches_[static_cast<std::size_t>(one)] = {};
            force.add_wrenches(now.terms().instant_of(f), model_->branches_of(f, now.branches), wrenches_);
          }
          const Wrench& wrench = wrenches_[marker];
          put(row, Eigen::Vector3d(wrench.force.x(), wrench.force.y(), wrench.torque));
        });
  }
}

void RunHistories::add_sections(const VehicleSections& sections) {
  constexpr std::array<const char*, 3> kUnits{"N", "N", "N m"};
  for (const BodySections& body : sections.bodies()) {
    begin(StoredGroup::kRecovery, body.name());
    const std::string group = "/recovery/" + body.name() + "/";
    const auto add_all = [&](const std::string& ending, const Eigen::Matrix3Xd& values) {
      for (Eigen::Index i = 0; i < 3; ++i) {
        const auto quantity = static_cast<std::size_t>(i);
        add(group + kQuantityNames[quantity] + ending, static_cast<std::size_t>(values.cols()),
            kUnits[quantity], [&values, i](const Snapshot&, std::span<double> row) {
              for (Eigen::Index k = 0; k < values.cols(); ++k)
                row[static_cast<std::size_t>(k)] = values(i, k);
            });
      }
    };
    if (body.has_modes()) add_all("", body.from_modes());
    if (body.has_loads()) add_all("_from_loads", body.from_loads());
  }
}

}  // namespace sprung::dynamics
