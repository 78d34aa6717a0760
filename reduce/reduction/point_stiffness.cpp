#include "reduce/reduction/point_stiffness.h"

#include <algorithm>

#include "fem/assembly.h"
#include "fem/axial_force.h"
#include "fem/geometric_stiffness.h"
#include "reduce/modes/held_node.h"

namespace sprung::reduce {

namespace {

constexpr Eigen::Index kLoadsAtOnce = 96;
constexpr Eigen::Index kValuesAtOnce = 60'000;  // of the elements' matrices: they stay in the cache

// The lower triangle of a symmetric m×m matrix as a column: SᵀS of four rows S, and back.
Eigen::Index count_entries(Eigen::Index m) {
  return m * (m + 1) / 2;
}
void pack_square(const Eigen::Matrix<double, 4, Eigen::Dynamic>& S, double* column) {
  const Eigen::Matrix<double, Eigen::Dynamic, 4> rows = S.transpose();
  const Eigen::Index m = rows.rows();
  const double *a = rows.data(), *b = a + m, *c = b + m, *d = c + m;
  for (Eigen::Index j = 0; j < m; ++j) {
    for (Eigen::Index i = j; i < m; ++i) *column++ = a[i] * a[j] + b[i] * b[j] + c[i] * c[j] + d[i] * d[j];
  }
}
Eigen::MatrixXd unpack(const Eigen::VectorXd& column, Eigen::Index m) {
  Eigen::MatrixXd matrix(m, m);
  Eigen::Index at = 0;
  for (Eigen::Index j = 0; j < m; ++j) {
    matrix.col(j).tail(m - j) = column.segment(at, m - j);
    matrix.row(j).tail(m - j) = column.segment(at, m - j).transpose();
    at += m - j;
  }
  return matrix;
}

// Φᵀ K_G Φ of elements `begin` … `begin + count` under unit axial forces, packed: one column each.
Eigen::MatrixXd calc_element_stiffness(const fem::BeamModel& model, const TallMatrix& shapes,
                                       Eigen::Index begin, Eigen::Index count) {
  Eigen::MatrixXd packed(count_entries(shapes.cols()), count);
  Eigen::Matrix<double, 6, Eigen::Dynamic> ends(6, shapes.cols());
  Eigen::Matrix<double, 4, Eigen::Dynamic> slopes(4, shapes.cols());
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto e = static_cast<int>(begin + i);
    const fem::Mesh::Element& nodes = model.mesh.elements[static_cast<std::size_t>(e)];
    ends << shapes.middleRows<3>(3 * nodes.first), shapes.middleRows<3>(3 * nodes.second);
    slopes.noalias() = fem::calc_scaled_slopes(fem::make_element(model, e)).lazyProduct(ends);
    pack_square(slopes, packed.col(i).data());
  }
  return packed;
}

// Axial forces of the elements under unit forces and a unit moment on each named point, three columns for
// each.
Eigen::MatrixXd calc_point_forces(const fem::BeamModel& model, int reference_node,
                                  const StiffnessFactor& factor) {
  const std::vector<fem::Mesh::NamedNode>& points = model.mesh.named_nodes;
  const auto num_loads = static_cast<Eigen::Index>(3 * points.size());
  Eigen::MatrixXd forces(model.mesh.num_elements(), num_loads);
  for (Eigen::Index begin = 0; begin < num_loads; begin += kLoadsAtOnce) {
    const Eigen::Index width = std::min(kLoadsAtOnce, num_loads - begin);
    Eigen::MatrixXd loads = Eigen::MatrixXd::Zero(3 * model.mesh.num_nodes(), width);
    for (Eigen::Index i = 0; i < width; ++i) {
      const auto point = static_cast<std::size_t>((begin + i) / 3);
      loads(3 * points[point].node + (begin + i) % 3, i) = 1.0;
    }
    loads = fem::move_loads_to_leaders(model.couplings, std::move(loads));
    const Eigen::MatrixXd displacements = fem::move_followers(
        model.couplings, insert_node(factor.solve(remove_node(loads, reference_node)), reference_node));
    forces.middleCols(begin, width) = fem::calc_axial_forces(model, displacements);
  }
  return forces;
}

// K_G is linear in the axial forces: the matrices of the elements are made once for all loads.
PointStiffness calc_by_loads(const fem::BeamModel& model, int reference_node, const StiffnessFactor& factor,
                             const TallMatrix& shapes) {
  const Eigen::MatrixXd forces = calc_point_forces(model, reference_node, factor);
  const Eigen::Index m = shapes.cols(), num_elements = model.mesh.num_elements();
  Eigen::MatrixXd packed = Eigen::MatrixXd::Zero(count_entries(m), forces.cols());
  const Eigen::Index at_once =
      std::max<Eigen::Index>(1, kValuesAtOnce / std::max<Eigen::Index>(1, packed.rows()));
  for (Eigen::Index begin = 0; begin < num_elements && forces.cols() > 0; begin += at_once) {
    const Eigen::Index count = std::min(at_once, num_elements - begin);
    add_combinations(calc_element_stiffness(model, shapes, begin, count), forces.middleRows(begin, count),
                     packed, is_tall(num_elements));
  }
  PointStiffness stiffness;
  for (Eigen::Index load = 0; load < forces.cols(); load += 3) {
    stiffness.push_back(
        {unpack(packed.col(load), m), unpack(packed.col(load + 1), m), unpack(packed.col(load + 2), m)});
  }
  return stiffness;
}

// The same where there are more loads than pairs of modes. The axial forces are N = Tᵀ K⁻¹ f, so that the
// entry i, j for a load f is fᵀ K⁻¹ g with g = Σ_elements T_e φᵢᵀ K_e φⱼ: a solution for each pair, of which
// the points' rows are taken.
PointStiffness calc_by_pairs(const fem::BeamModel& model, int reference_node, const StiffnessFactor& factor,
                             const TallMatrix& shapes) {
  const Eigen::Index m = shapes.cols();
  const std::vector<fem::Mesh::NamedNode>& points = model.mesh.named_nodes;
  const auto num_elements = static_cast<std::size_t>(model.mesh.num_elements());
  std::vector<fem::Matrix6> stiffness(num_elements);
  std::vector<Eigen::Matrix<double, 1, 6>> axial(num_elements);
  for (std::size_t e = 0; e < num_elements; ++e) {
    const fem::BeamElement element = fem::make_element(model, static_cast<int>(e));
    stiffness[e] = fem::calc_geometric_stiffness(element, {.constant = 1.0});
    axial[e] = fem::calc_axial_row(element);
  }
  const std::array<Eigen::MatrixXd, 3> zero{Eigen::MatrixXd(m, m), Eigen::MatrixXd(m, m),
                                            Eigen::MatrixXd(m, m)};
  PointStiffness found(points.size(), zero);
  Eigen::MatrixXd ends(6, m);
  for (Eigen::Index j = 0; j < m; ++j) {
    const Eigen::Index height = m - j;
    Eigen::MatrixXd g = Eigen::MatrixXd::Zero(shapes.rows(), height);
    for (std::size_t e = 0; e < num_elements; ++e) {
      const fem::Mesh::Element& nodes = model.mesh.elements[e];
      ends << shapes.middleRows<3>(3 * nodes.first), shapes.middleRows<3>(3 * nodes.second);
      const Eigen::RowVectorXd pairs = (stiffness[e] * ends.col(j)).transpose() * ends.rightCols(height);
      g.middleRows<2>(3 * nodes.first) += axial[e].segment<2>(0).transpose() * pairs;
      g.middleRows<2>(3 * nodes.second) += axial[e].segment<2>(3).transpose() * pairs;
    }
    g = fem::move_loads_to_leaders(model.couplings, std::move(g));
    const Eigen::MatrixXd solution = fem::move_followers(
        model.couplings, insert_node(factor.solve(remove_node(g, reference_node)), reference_node));
    for (std::size_t p = 0; p < points.size(); ++p) {
      for (std::size_t freedom = 0; freedom < 3; ++freedom) {
        const auto row = solution.row(3 * points[p].node + static_cast<Eigen::Index>(freedom));
        found[p][freedom].col(j).tail(height) = row.transpose();
        found[p][freedom].row(j).tail(height) = row;
      }
    }
  }
  return found;
}

}  // namespace

PointStiffness calc_point_stiffness(const fem::BeamModel& model, int reference_node,
                                    const StiffnessFactor& factor, const TallMatrix& shapes) {
  const auto num_loads = static_cast<Eigen::Index>(3 * model.mesh.named_nodes.size());
  return num_loads > count_entries(shapes.cols()) ? calc_by_pairs(model, reference_node, factor, shapes)
                                                  : calc_by_loads(model, reference_node, factor, shapes);
}

}  // namespace sprung::reduce
