#include "dynamics/output/moving_bodies.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace sprung::dynamics {

namespace {

constexpr double kWorthNaming = 0.25;  // share of a body's energy from which one of its motions is named

// Bending or stretching, by the nodes' displacements across the body's longest direction and along it.
// @param number  1-based
const char* describe_shape(const reduce::Superelement& superelement, int number) {
  const Eigen::Matrix2Xd centred =
      superelement.node_positions.colwise() - superelement.node_positions.rowwise().mean();
  const Eigen::Matrix2d spread = centred * centred.transpose();
  const Eigen::Vector2d along = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).eigenvectors().col(1);
  const Eigen::MatrixXd shape =
      superelement.shapes.col(number - 1).reshaped(3, superelement.num_nodes()).topRows(2);
  const Eigen::RowVector2d across(-along.y(), along.x());
  return (across * shape).norm() >= (along.transpose() * shape).norm() ? "bending" : "stretching";
}

bool has_wheel(const Model& model, int body) {
  return std::any_of(model.forces.begin(), model.forces.end(), [&](const auto& force) {
    return force->kind() == "tyre" &&
           model.markers[static_cast<std::size_t>(force->markers().front())].body == body;
  });
}

// The motions of a body that moves as a whole, the one with the most energy first.
std::string describe_rigid_motion(const Model& model, const Participant& participant) {
  const Body& body = model.bodies[static_cast<std::size_t>(participant.body)];
  const bool rolls = has_wheel(model, participant.body);
  const Eigen::Vector3d& v = participant.motion;
  const double inertia =
      body.mass > 0.0 ? body.second_moment - body.first_moment.squaredNorm() / body.mass : body.second_moment;
  std::array<std::pair<const char*, double>, 3> energies{
      {{"fore-aft", body.mass * v.x() * v.x()},
       {rolls ? "hop" : "heave", body.mass * v.y() * v.y()},
       {rolls ? "turning" : "pitch", inertia * v.z() * v.z()}}};
  std::stable_sort(energies.begin(), energies.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  const double total = energies[0].second + energies[1].second + energies[2].second;
  std::vector<const char*> words;
  for (const auto& [word, energy] : energies) {
    if (total > 0.0 && energy >= kWorthNaming * total) words.push_back(word);
  }
  return words.empty() ? "at rest" : fmt::format("{}", fmt::join(words, " and "));
}

}  // namespace

std::string describe_moving_bodies(const Model& model, const Vehicle& vehicle, const VehicleMode& mode) {
  std::vector<std::string> texts;
  for (const Participant& participant : mode.participants) {
    const Body& body = model.bodies[static_cast<std::size_t>(participant.body)];
    const BodyDescription& description = *vehicle.find_body(body.name);
    const std::string words =
        participant.main_mode > 0
            ? describe_shape(*vehicle.superelement_of(description), participant.main_mode)
            : describe_rigid_motion(model, participant);
    texts.push_back(fmt::format("{} {}, {:.0f} %", body.name, words, 100.0 * participant.share));
  }
  return fmt::format("{}", fmt::join(texts, "; "));
}

}  // namespace sprung::dynamics
