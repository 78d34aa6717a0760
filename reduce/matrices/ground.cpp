#include "reduce/matrices/ground.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "reduce/matrices/linear_motions.h"
#include "tools/support/errors/input_error.h"

namespace sprung::reduce {

namespace {

// Of the lowest elastic frequency. Elastic ω² change by its square at most.
constexpr double kHarmless = 1e-3;     // whatever the cause
constexpr double kUntold = 1e-4;       // of springs: below it nothing is said
constexpr double kNotable = 1e-2;      // of rounding: the user is told
constexpr double kMostRounding = 0.1;  // of rounding: refused
constexpr double kOfDoubles = 1e-14;   // forces below it, of those of single entries, are left

constexpr const char* kMotions[] = {"displacement along x", "displacement along y", "rotation"};

Eigen::MatrixXd calc_motions(const MatrixBody& body, const Eigen::Vector2d& origin) {
  const LinearMotions motions = make_linear_motions(body, origin);
  Eigen::MatrixXd R(motions.along_x.size(), 3);
  R << motions.along_x, motions.along_y, motions.rotation;
  return R;
}

Ground find_ground(const MatrixBody& body) {
  const Eigen::MatrixXd R = calc_motions(body, calc_middle(body));
  const Eigen::MatrixXd F = body.stiffness * R, momenta = body.mass * R;
  Ground ground;
  for (int motion = 0; motion < 3; ++motion) {
    const double stiffness = R.col(motion).dot(F.col(motion)), mass = R.col(motion).dot(momenta.col(motion));
    const double hz =
        mass > 0.0 ? std::sqrt(std::max(stiffness, 0.0) / mass) / (2.0 * std::numbers::pi) : 0.0;
    if (hz <= ground.frequency_hz) continue;
    ground.frequency_hz = hz;
    ground.stiffness = stiffness;
    ground.motion = motion;
    (F.col(motion).cwiseAbs() - body.rounding.col(motion)).maxCoeff(&ground.freedom);
  }
  ground.is_rounding = (F.cwiseAbs().array() <= body.rounding.array()).all();
  return ground;
}

int find_middle_node(const MatrixBody& body) {
  Eigen::Index node = 0;
  (body.node_positions.colwise() - calc_middle(body)).colwise().squaredNorm().minCoeff(&node);
  return static_cast<int>(node);
}

// "2e+06 N/m along y"
std::string describe_stiffness(const Ground& ground) {
  return fmt::format("{:.4g} {} against a {}", ground.stiffness, ground.motion == 2 ? "N·m" : "N/m",
                     kMotions[ground.motion]);
}

}  // namespace

void release_from_ground(MatrixBody& body) {
  body.ground = find_ground(body);
  const int c = find_middle_node(body);
  const Eigen::MatrixXd R = calc_motions(body, body.node_positions.col(c));
  const Eigen::MatrixXd F = body.stiffness * R;
  const Eigen::MatrixXd least = kOfDoubles * (body.stiffness.cwiseAbs() * R.cwiseAbs());
  const Eigen::Matrix3d S = R.transpose() * F;
  std::vector<Eigen::Triplet<double>> change;
  for (int i = 0; i < F.rows(); ++i) {
    for (int motion = 0; motion < 3; ++motion) {
      if (i / 3 == c || std::abs(F(i, motion)) <= least(i, motion)) continue;
      change.emplace_back(i, 3 * c + motion, -F(i, motion));
      change.emplace_back(3 * c + motion, i, -F(i, motion));
    }
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      change.emplace_back(3 * c + i, 3 * c + j,
                          0.5 * (S(i, j) + S(j, i)) - F(3 * c + i, j) - F(3 * c + j, i));
  Eigen::SparseMatrix<double> sum(F.rows(), F.rows());
  sum.setFromTriplets(change.begin(), change.end());
  sum += body.stiffness;
  body.stiffness.swap(sum);
}

void require_no_ground(const MatrixBody& body, double lowest_hz) {
  const Ground& ground = body.ground;
  const double share = ground.frequency_hz / lowest_hz;
  if (share <= kHarmless || (ground.is_rounding && share <= kMostRounding)) return;
  const std::string facts = fmt::format(
      "the stiffness resists rigid motion, by {}, on which the rigid body would vibrate at {:.4g} Hz; its "
      "lowest "
      "elastic frequency is {:.4g} Hz",
      describe_stiffness(ground), ground.frequency_hz, lowest_hz);
  if (ground.is_rounding) {
    throw support::InputError(
        {.path = body.stiffness_path},
        facts + ": the numbers have too few digits for a mesh as fine as this; write more");
  }
  throw support::InputError(
      {.path = body.stiffness_path},
      fmt::format(
          "{}: the digits of the files explain less; springs to the ground, as at {}, are a usual cause: "
          "leave them out of the matrices and put them into the vehicle file",
          facts, describe_freedom(body, ground.freedom)));
}

std::string remark_on_ground(const MatrixBody& body, double lowest_hz) {
  const Ground& ground = body.ground;
  if (ground.frequency_hz <= (ground.is_rounding ? kNotable : kUntold) * lowest_hz) return {};
  return fmt::format(
      "the stiffness resists rigid motion, by {}, on which the rigid body would vibrate at {:.3g} Hz{}; what "
      "it is "
      "reduced to is free",
      describe_stiffness(ground), ground.frequency_hz,
      ground.is_rounding ? ": the numbers have few digits" : ", more than the digits of the files explain");
}

}  // namespace sprung::reduce
