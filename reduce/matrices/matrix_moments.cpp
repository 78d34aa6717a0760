#include "reduce/matrices/matrix_moments.h"

#include <functional>
#include <vector>

#include "reduce/matrices/linear_motions.h"

namespace sprung::reduce {

namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

enum class Direction { kX, kY, kModal, kRotation, kAcross };

Direction direction_of(const MatrixBody& body, Eigen::Index freedom) {
  if (freedom >= 3 * (body.num_nodes() + body.num_pairs)) return Direction::kModal;
  if (freedom >= 3 * body.num_nodes()) return Direction::kAcross;
  return freedom % 3 == 0 ? Direction::kX : freedom % 3 == 1 ? Direction::kY : Direction::kRotation;
}

// The entries of a matrix times a factor that depends on their row and column.
SparseMatrix weigh(const SparseMatrix& matrix,
                   const std::function<double(Eigen::Index, Eigen::Index)>& weight) {
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index column = 0; column < matrix.outerSize(); ++column) {
    for (SparseMatrix::InnerIterator entry(matrix, column); entry; ++entry) {
      const double factor = weight(entry.row(), column);
      if (factor == 0.0) continue;
      entries.emplace_back(static_cast<int>(entry.row()), static_cast<int>(column), factor * entry.value());
    }
  }
  SparseMatrix result(matrix.rows(), matrix.cols());
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

// Whether each freedom moves no point in the plane: rotations whose inertia is coupled with no displacement,
// and motions across the plane.
std::vector<bool> find_separate(const MatrixBody& body) {
  std::vector<bool> separate(static_cast<std::size_t>(body.mass.cols()), false);
  for (Eigen::Index column = 0; column < body.mass.outerSize(); ++column) {
    const Direction direction = direction_of(body, column);
    bool coupled = direction < Direction::kRotation;
    for (SparseMatrix::InnerIterator entry(body.mass, column); entry && direction == Direction::kRotation;
         ++entry)
      coupled = coupled || direction_of(body, entry.row()) < Direction::kRotation;
    separate[static_cast<std::size_t>(column)] = !coupled;
  }
  return separate;
}

// The part of the mass that turns and does not move in the plane (reduce/matrices, eq. 5).
SparseMatrix split_rotary(const MatrixBody& body) {
  const std::vector<bool> separate = find_separate(body);
  return weigh(body.mass, [&](Eigen::Index i, Eigen::Index j) {
    return separate[static_cast<std::size_t>(i)] && separate[static_cast<std::size_t>(j)] ? 1.0 : 0.0;
  });
}

// S: every displacement turned by +90° (reduce/matrices, eq. 7), on freedoms of nodes.
SparseMatrix make_turn(const MatrixBody& body) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int node = 0; node < body.num_nodes(); ++node) {
    entries.emplace_back(3 * node, 3 * node + 1, -1.0);
    entries.emplace_back(3 * node + 1, 3 * node, 1.0);
  }
  SparseMatrix turn(body.mass.rows(), body.mass.cols());
  turn.setFromTriplets(entries.begin(), entries.end());
  return turn;
}

// The share of an entry of the translational mass that belongs to displacements along an axis.
double share_of(const MatrixBody& body, Direction axis, Eigen::Index row, Eigen::Index column) {
  const auto share = [&](Eigen::Index freedom) {
    const Direction direction = direction_of(body, freedom);
    return direction == axis ? 1.0 : direction == Direction::kX || direction == Direction::kY ? 0.0 : 0.5;
  };
  // A displacement says which axis it is; where only one of the two does, that one decides.
  const double a = share(row), b = share(column);
  if (a == 0.5) return b;
  if (b == 0.5) return a;
  return 0.5 * (a + b);
}

}  // namespace

fem::MassMoments calc_mass_moments(const MatrixBody& body, const Eigen::Vector2d& origin) {
  const SparseMatrix rotary = split_rotary(body), translation = body.mass - rotary;
  const LinearMotions motions = make_linear_motions(body, origin);
  const Eigen::VectorXd of_x = translation * motions.along_x, of_y = translation * motions.along_y;
  const Eigen::VectorXd of_places = translation * motions.places;

  // (x, 0), (0, x) and (y, 0); the last two turn the material by ½ and −½ (reduce/matrices, eq. 6).
  Eigen::VectorXd x_x = motions.places, x_y = Eigen::VectorXd::Zero(of_x.size()), y_x = x_y;
  for (int node = 0; node < body.num_nodes(); ++node) {
    const Eigen::Vector2d r = body.node_positions.col(node) - origin;
    x_x(3 * node + 1) = 0.0;
    x_y.segment<3>(3 * node) << 0.0, r.x(), 0.5;
    y_x.segment<3>(3 * node) << r.y(), 0.0, -0.5;
  }

  fem::MassMoments moments;
  moments.mass = motions.along_x.dot(of_x);
  // Of a body that was reduced elsewhere, the nodes tell rigid motions exactly, and the stretch does not.
  moments.first_moment = body.is_reduced
                             ? Eigen::Vector2d(of_y.dot(motions.rotation), -of_x.dot(motions.rotation))
                             : Eigen::Vector2d(of_x.dot(motions.places), of_y.dot(motions.places));
  moments.xx = x_x.dot(of_places);
  moments.yy = motions.places.dot(of_places) - moments.xx;
  moments.xy = x_y.dot(of_places);
  moments.rotary = motions.rotation.dot(body.mass * motions.rotation) - moments.xx - moments.yy;
  moments.N_x = of_x;
  moments.N_y = of_y;
  moments.x_N_x = translation * x_x;
  moments.y_N_y = of_places - moments.x_N_x;
  moments.x_N_y = translation * x_y;
  moments.y_N_x = translation * y_x;
  moments.rotary_N = rotary * motions.rotation;
  moments.NxNx =
      weigh(translation, [&](Eigen::Index i, Eigen::Index j) { return share_of(body, Direction::kX, i, j); });
  moments.NyNy = translation - moments.NxNx;
  moments.rotary_NN = rotary;
  // NxNy − NxNyᵀ = −½ (M S + S M), the skew part of the mass that turned displacements meet.
  const SparseMatrix turn = make_turn(body);
  const SparseMatrix skew = -0.5 * SparseMatrix(translation * turn + turn * translation);
  moments.NxNy = weigh(skew, [&](Eigen::Index i, Eigen::Index j) {
    const Direction a = direction_of(body, i), b = direction_of(body, j);
    if (a == Direction::kX && b == Direction::kY) return 1.0;
    return a == Direction::kY && b == Direction::kX ? 0.0 : 0.5;
  });
  return moments;
}

Eigen::SparseMatrix<double> calc_distance_weighted_mass(const MatrixBody& body,
                                                        const Eigen::Vector2d& origin) {
  const auto x = [&](Eigen::Index freedom) {
    return freedom < 3 * body.num_nodes() ? body.node_positions(0, freedom / 3) - origin.x() : 0.0;
  };
  const SparseMatrix translation = body.mass - split_rotary(body);
  return weigh(translation, [&](Eigen::Index i, Eigen::Index j) { return 0.5 * (x(i) + x(j)); });
}

}  // namespace sprung::reduce
