#include "tests/dynamics/chains.h"

#include <cmath>
#include <numbers>
#include <string>

#include "tests/dynamics/small_models.h"

namespace sprung::test {

namespace {

constexpr double kLength = 0.2;    // m, of a link
constexpr double kMass = 3.0;      // kg
constexpr double kInertia = 0.02;  // kg·m²

// A bar with its frame in the middle, between two points. @return its coordinates
Eigen::Vector3d place_between(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const Eigen::Vector2d middle = 0.5 * (from + to), along = to - from;
  return {middle.x(), middle.y(), std::atan2(along.y(), along.x())};
}

Chain make_links(const std::vector<Eigen::Vector2d>& corners) {
  Chain chain;
  chain.model.gravity = {0.0, -9.81};
  const std::size_t count = corners.size() - 1;
  chain.state.q.resize(static_cast<Eigen::Index>(3 * count));
  int last_end = add_marker(chain.model, dynamics::kGround, corners[0]);
  for (std::size_t i = 0; i < count; ++i) {
    const std::string name = "link " + std::to_string(i + 1);
    const int link = add_body(chain.model, dynamics::make_rigid_body(name, kMass, kInertia));
    const double half = 0.5 * (corners[i + 1] - corners[i]).norm();
    add_pin(chain.model, name + " pin", last_end,
            add_marker(chain.model, link, {-half, 0.0}, name + " begin"));
    last_end = add_marker(chain.model, link, {half, 0.0}, name + " end");
    chain.state.q.segment<3>(static_cast<Eigen::Index>(3 * i)) = place_between(corners[i], corners[i + 1]);
  }
  return chain;
}

void complete(Chain& chain) {
  number_model(chain.model);
  chain.state.v = Eigen::VectorXd::Zero(chain.model.num_coordinates);
  chain.state.branches.assign(static_cast<std::size_t>(chain.model.num_branches), 0);
}

}  // namespace

Chain make_open_chain(int num_links) {
  std::vector<Eigen::Vector2d> corners{Eigen::Vector2d::Zero()};
  for (int i = 0; i < num_links; ++i) {
    const double angle = -0.3 + 0.4 * std::sin(0.7 * i);
    corners.push_back(corners.back() + kLength * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  Chain chain = make_links(corners);
  complete(chain);
  return chain;
}

Chain make_closed_chain(int num_links) {
  std::vector<Eigen::Vector2d> corners;
  const double radius = 0.5 * kLength / std::sin(std::numbers::pi / num_links);
  for (int i = 0; i <= num_links; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i % num_links) / num_links;
    corners.push_back(radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  Chain chain = make_links(corners);
  dynamics::Model& model = chain.model;
  const int last_end = static_cast<int>(model.markers.size()) - 1;
  add_pin(model, "closing pin", last_end, add_marker(model, dynamics::kGround, corners[0], "closing"));
  for (int i = 0; i < num_links; i += 5) {
    const std::string name = "spring " + std::to_string(i + 1);
    const Eigen::Vector2d middle = chain.state.q.segment<2>(3 * i);
    const int link = add_marker(model, i, Eigen::Vector2d::Zero(), name + " link");
    add_spring(model, name, link, add_marker(model, dynamics::kGround, 1.1 * middle, name + " ground"),
               0.1 * radius, 2e3, 20.0);
  }
  complete(chain);
  return chain;
}

}  // namespace sprung::test
