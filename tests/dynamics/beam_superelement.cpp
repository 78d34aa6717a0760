#include "tests/dynamics/beam_superelement.h"

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>

namespace sprung::test {

namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Eigen::Index;

// Gauss–Legendre with 4 points on [0, 1], exact to degree 7: the squares of cubic shape functions and x² of
// them. Source: [Abramowitz & Stegun 1964], table 25.4
constexpr std::array<double, 4> kAbscissa{0.5 - 0.5 * 0.861136311594052575, 0.5 - 0.5 * 0.339981043584856265,
                                          0.5 + 0.5 * 0.339981043584856265, 0.5 + 0.5 * 0.861136311594052575};
constexpr std::array<double, 4> kWeight{0.5 * 0.347854845137453857, 0.5 * 0.652145154862546143,
                                        0.5 * 0.652145154862546143, 0.5 * 0.347854845137453857};

struct BeamGeometry {
  double length;
  Eigen::Vector2d axis;
  Matrix6d to_local;  // element displacements in its own axes from (x, y, rotation) of both nodes
};

BeamGeometry measure(const BeamFrame& frame, const BeamFrame::Beam& beam) {
  const Eigen::Vector2d span = frame.nodes[static_cast<std::size_t>(beam.last)].position -
                               frame.nodes[static_cast<std::size_t>(beam.first)].position;
  BeamGeometry geometry{span.norm(), span.normalized(), Matrix6d::Zero()};
  for (Index end = 0; end < 2; ++end) {
    geometry.to_local.block<2, 2>(3 * end, 3 * end) << geometry.axis.x(), geometry.axis.y(),
        -geometry.axis.y(), geometry.axis.x();
    geometry.to_local(3 * end + 2, 3 * end + 2) = 1.0;
  }
  return geometry;
}

// Displacement along and across the beam at s from 0 to 1.
Eigen::Matrix<double, 2, 6> shape_functions(double s, double length) {
  Eigen::Matrix<double, 2, 6> N = Eigen::Matrix<double, 2, 6>::Zero();
  N(0, 0) = 1.0 - s;
  N(0, 3) = s;
  N(1, 1) = 1.0 - 3.0 * s * s + 2.0 * s * s * s;
  N(1, 2) = length * (s - 2.0 * s * s + s * s * s);
  N(1, 4) = 3.0 * s * s - 2.0 * s * s * s;
  N(1, 5) = length * (-s * s + s * s * s);
  return N;
}

Matrix6d local_stiffness(const BeamFrame::Beam& beam, double length) {
  const double a = beam.EA / length, b = beam.EI / (length * length * length);
  const double l = length;
  Matrix6d K;
  K << a, 0, 0, -a, 0, 0,                                         //
      0, 12 * b, 6 * b * l, 0, -12 * b, 6 * b * l,                //
      0, 6 * b * l, 4 * b * l * l, 0, -6 * b * l, 2 * b * l * l,  //
      -a, 0, 0, a, 0, 0,                                          //
      0, -12 * b, -6 * b * l, 0, 12 * b, -6 * b * l,              //
      0, 6 * b * l, 2 * b * l * l, 0, -6 * b * l, 4 * b * l * l;
  return K;
}

std::array<Index, 6> freedoms_of(const BeamFrame::Beam& beam) {
  const Index i = 3 * beam.first, j = 3 * beam.last;
  return {i, i + 1, i + 2, j, j + 1, j + 2};
}

// A Gauss point of a beam with the frame's displacement there per freedom of the beam's nodes.
struct BeamPoint {
  double dm;
  Eigen::Vector2d r;
  Eigen::Matrix<double, 2, 6> N;
  std::array<Index, 6> freedoms;
};

std::vector<BeamPoint> list_points(const BeamFrame& frame) {
  std::vector<BeamPoint> points;
  for (const BeamFrame::Beam& beam : frame.beams) {
    const BeamGeometry geometry = measure(frame, beam);
    Eigen::Matrix2d axes;
    axes << geometry.axis.x(), -geometry.axis.y(), geometry.axis.y(), geometry.axis.x();
    for (std::size_t g = 0; g < kAbscissa.size(); ++g) {
      const Eigen::Vector2d r = frame.nodes[static_cast<std::size_t>(beam.first)].position +
                                kAbscissa[g] * geometry.length * geometry.axis;
      points.push_back({beam.mass_per_length * geometry.length * kWeight[g], r,
                        axes * shape_functions(kAbscissa[g], geometry.length) * geometry.to_local,
                        freedoms_of(beam)});
    }
  }
  return points;
}

// Mass-normalised modes held at the reference node: frequencies squared and shapes over all freedoms.
void solve_modes(const BeamFrame& frame, const std::vector<BeamPoint>& points, int num_modes,
                 Eigen::VectorXd& omega_squared, Eigen::MatrixXd& shapes) {
  const Index size = 3 * static_cast<Index>(frame.nodes.size());
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(size, size), M = K;
  for (const BeamFrame::Beam& beam : frame.beams) {
    const BeamGeometry geometry = measure(frame, beam);
    const std::array<Index, 6> freedoms = freedoms_of(beam);
    K(freedoms, freedoms) +=
        geometry.to_local.transpose() * local_stiffness(beam, geometry.length) * geometry.to_local;
  }
  for (const BeamPoint& point : points) {
    M(point.freedoms, point.freedoms) += point.dm * point.N.transpose() * point.N;
  }
  std::vector<Index> free;
  for (Index i = 0; i < size; ++i) {
    if (i / 3 != frame.reference_node) free.push_back(i);
  }
  if (num_modes < 1 || num_modes > static_cast<int>(free.size())) {
    throw std::invalid_argument("make_beam_superelement: num_modes");
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(K(free, free), M(free, free));
  omega_squared = solver.eigenvalues().head(num_modes);
  shapes = Eigen::MatrixXd::Zero(size, num_modes);
  shapes(free, Eigen::all) = solver.eigenvectors().leftCols(num_modes);
}

reduce::InertiaInvariants sum_invariants(const std::vector<MassPoint>& points, int num_modes) {
  reduce::InertiaInvariants sum;
  const Index n = num_modes;
  sum.P = Eigen::Matrix2Xd::Zero(2, n);
  sum.x_phi_x = sum.x_phi_y = sum.y_phi_x = sum.y_phi_y = Eigen::RowVectorXd::Zero(n);
  sum.phi_x_phi_x = sum.phi_x_phi_y = sum.phi_y_phi_y = Eigen::MatrixXd::Zero(n, n);
  for (const MassPoint& point : points) {
    const Eigen::RowVectorXd phi_x = point.shape.row(0), phi_y = point.shape.row(1);
    sum.mass += point.dm;
    sum.first_moment += point.dm * point.r;
    sum.second_moment += point.dm * point.r.squaredNorm();
    sum.P += point.dm * point.shape;
    sum.x_phi_x += point.dm * point.r.x() * phi_x;
    sum.x_phi_y += point.dm * point.r.x() * phi_y;
    sum.y_phi_x += point.dm * point.r.y() * phi_x;
    sum.y_phi_y += point.dm * point.r.y() * phi_y;
    sum.phi_x_phi_x += point.dm * phi_x.transpose() * phi_x;
    sum.phi_x_phi_y += point.dm * phi_x.transpose() * phi_y;
    sum.phi_y_phi_y += point.dm * phi_y.transpose() * phi_y;
  }
  sum.c = sum.x_phi_y - sum.y_phi_x;
  sum.d = sum.x_phi_x + sum.y_phi_y;
  sum.M_ff = sum.phi_x_phi_x + sum.phi_y_phi_y;
  sum.B = sum.phi_x_phi_y - sum.phi_x_phi_y.transpose();
  return sum;
}

}  // namespace

BeamSuperelement make_beam_superelement(const BeamFrame& frame, int num_modes) {
  const std::vector<BeamPoint> beam_points = list_points(frame);
  Eigen::VectorXd omega_squared;
  BeamSuperelement result;
  reduce::Superelement& s = result.superelement;
  solve_modes(frame, beam_points, num_modes, omega_squared, s.shapes);
  for (const BeamPoint& point : beam_points) {
    result.points.push_back({point.dm, point.r, point.N * s.shapes(point.freedoms, Eigen::all)});
  }
  s.name = frame.name;
  s.node_positions.resize(2, static_cast<Index>(frame.nodes.size()));
  for (std::size_t i = 0; i < frame.nodes.size(); ++i) {
    s.node_ids.push_back(static_cast<std::int64_t>(i) + 1);
    s.node_positions.col(static_cast<Index>(i)) = frame.nodes[i].position;
    if (!frame.nodes[i].name.empty()) s.points.push_back({frame.nodes[i].name, static_cast<int>(i)});
  }
  s.elements.resize(2, static_cast<Index>(frame.beams.size()));
  for (std::size_t e = 0; e < frame.beams.size(); ++e) {
    s.elements.col(static_cast<Index>(e)) << frame.beams[e].first, frame.beams[e].last;
    s.element_sections.emplace_back("beam");
  }
  const Eigen::VectorXd omega = omega_squared.cwiseSqrt();
  s.frequency_hz = omega / (2.0 * std::numbers::pi);
  s.damping_ratio = Eigen::VectorXd::Constant(num_modes, frame.damping_ratio);
  s.cluster = Eigen::VectorXi::Ones(num_modes);
  for (Index k = 1; k < num_modes; ++k) {
    s.cluster[k] = s.cluster[k - 1] + (omega[k] - omega[k - 1] > 1e-6 * omega[k] ? 1 : 0);
  }
  s.num_elastic_dofs = 3 * (static_cast<std::int64_t>(frame.nodes.size()) - 1);
  s.stiffness = omega_squared.asDiagonal();
  s.mass = Eigen::MatrixXd::Identity(num_modes, num_modes);
  s.damping = (2.0 * frame.damping_ratio * omega).asDiagonal();
  s.inertia = sum_invariants(result.points, num_modes);
  s.resultants = Eigen::MatrixXd::Zero(6 * static_cast<Index>(frame.beams.size()), num_modes);
  return result;
}

BeamFrame make_straight_beam(const std::string& name, const std::vector<double>& positions, double EA,
                             double EI, double mass_per_length) {
  BeamFrame frame{.name = name, .nodes = {}, .beams = {}};
  for (const double x : positions) {
    if (x == 0.0) frame.reference_node = static_cast<int>(frame.nodes.size());
    frame.nodes.push_back({.position = {x, 0.0}});
  }
  for (int i = 0; i + 1 < static_cast<int>(positions.size()); ++i) {
    frame.beams.push_back({i, i + 1, EA, EI, mass_per_length});
  }
  return frame;
}

BeamFrame make_crooked_frame() {
  return {.name = "crooked",
          .nodes = {{{0.0, 0.0}},
                    {{0.5, 0.4}},
                    {{1.3, -0.1}, "tip"},
                    {{0.3, 1.1}, "elbow"},
                    {{-0.6, 0.8}, "foot"}},
          .beams = {{0, 1, 4.0e6, 900.0, 7.0},
                    {1, 2, 3.0e6, 500.0, 4.0},
                    {1, 3, 2.0e6, 700.0, 6.0},
                    {3, 4, 5.0e6, 300.0, 3.0}}};
}

}  // namespace sprung::test
