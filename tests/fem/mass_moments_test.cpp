#include "fem/mass_moments.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "fem/assembly.h"
#include "tests/catch.h"
#include "tests/fem/frames.h"
#include "tests/fem/rigid_motions.h"

namespace sprung::fem {

namespace {

constexpr double kRounding = 1e-13;  // relative, of sums over a few elements

// A beam from (0.4, −0.3) at an angle with cos 0.8, sin 0.6, length 2.5; ρA 3, ρI 0.7.
constexpr double kCos = 0.8, kSin = 0.6, kLength = 2.5, kMassPerLength = 3.0, kRotaryInertia = 0.7;
const Eigen::Vector2d kFrom(0.4, -0.3);

BeamModel make_tilted_beam(int num_elements) {
  BeamProperties properties = test::make_thin_properties();
  properties.mass_per_length = kMassPerLength;
  properties.rotary_inertia = kRotaryInertia;
  return test::make_straight_beam(kFrom, kFrom + kLength * Eigen::Vector2d(kCos, kSin), num_elements,
                                  properties);
}

// Nodal freedoms of the displacement u = a s along the beam and w = b s² + c s³ across it.
Eigen::VectorXd make_cubic_field(const BeamModel& model, double a, double b, double c) {
  Eigen::VectorXd q(3 * model.mesh.num_nodes());
  for (int node = 0; node < model.mesh.num_nodes(); ++node) {
    const double s = (model.mesh.node_positions.col(node) - kFrom).norm();
    const double u = a * s, w = b * s * s + c * s * s * s;
    q.segment<3>(3 * node) << kCos * u - kSin * w, kSin * u + kCos * w, 2.0 * b * s + 3.0 * c * s * s;
  }
  return q;
}

// ∫ s^n ds along the beam.
double integrate_power(int n) {
  return std::pow(kLength, n + 1) / (n + 1);
}

}  // namespace

TEST_CASE("A tilted beam has the mass moments calculated by hand, for any division into elements") {
  const Eigen::Vector2d origin(-0.2, 0.5);
  const double x0 = 0.6, y0 = -0.8;  // of the beam's beginning about the origin
  const double m = kMassPerLength * kLength, I1 = kMassPerLength * integrate_power(1),
               I2 = kMassPerLength * integrate_power(2);
  for (const int num_elements : {1, 4}) {
    const MassMoments moments = calc_mass_moments(make_tilted_beam(num_elements), origin);
    CHECK(moments.mass == Approx(m).epsilon(kRounding));
    CHECK(moments.first_moment.x() == Approx(m * x0 + I1 * kCos).epsilon(kRounding));
    CHECK(moments.first_moment.y() == Approx(m * y0 + I1 * kSin).epsilon(kRounding));
    CHECK(moments.xx == Approx(m * x0 * x0 + 2.0 * x0 * kCos * I1 + kCos * kCos * I2).epsilon(kRounding));
    CHECK(moments.xy ==
          Approx(m * x0 * y0 + (x0 * kSin + y0 * kCos) * I1 + kCos * kSin * I2).epsilon(kRounding));
    CHECK(moments.yy == Approx(m * y0 * y0 + 2.0 * y0 * kSin * I1 + kSin * kSin * I2).epsilon(kRounding));
    CHECK(moments.rotary == Approx(kRotaryInertia * kLength).epsilon(kRounding));
    CHECK(moments.second_moment() == Approx(moments.xx + moments.yy + 1.75).epsilon(kRounding));
  }
}

TEST_CASE("A displacement that the shape functions represent exactly has its analytic integrals") {
  // u = a s, w = b s² + c s³ about the beginning of the beam, so that x = s cos, y = s sin
  const double a = 0.31, b = -0.17, c = 0.23;
  for (const int num_elements : {1, 3}) {
    const BeamModel model = make_tilted_beam(num_elements);
    const MassMoments moments = calc_mass_moments(model, kFrom);
    const Eigen::VectorXd q = make_cubic_field(model, a, b, c);
    const auto power = [](int n) { return kMassPerLength * integrate_power(n); };
    const double U = a * power(1), W = b * power(2) + c * power(3);    // ∫u dm, ∫w dm
    const double sU = a * power(2), sW = b * power(3) + c * power(4);  // ∫s u dm, ∫s w dm
    const double UU = a * a * power(2), UW = a * b * power(3) + a * c * power(4);
    const double WW = b * b * power(4) + 2.0 * b * c * power(5) + c * c * power(6);
    CHECK(moments.N_x.dot(q) == Approx(kCos * U - kSin * W).epsilon(kRounding));
    CHECK(moments.N_y.dot(q) == Approx(kSin * U + kCos * W).epsilon(kRounding));
    CHECK(moments.x_N_x.dot(q) == Approx(kCos * (kCos * sU - kSin * sW)).epsilon(kRounding));
    CHECK(moments.x_N_y.dot(q) == Approx(kCos * (kSin * sU + kCos * sW)).epsilon(kRounding));
    CHECK(moments.y_N_x.dot(q) == Approx(kSin * (kCos * sU - kSin * sW)).epsilon(kRounding));
    CHECK(moments.y_N_y.dot(q) == Approx(kSin * (kSin * sU + kCos * sW)).epsilon(kRounding));
    const double c2 = kCos * kCos, s2 = kSin * kSin, cs = kCos * kSin;
    CHECK(q.dot(moments.NxNx * q) == Approx(c2 * UU - 2.0 * cs * UW + s2 * WW).epsilon(kRounding));
    CHECK(q.dot(moments.NxNy * q) == Approx(cs * UU + (c2 - s2) * UW - cs * WW).epsilon(kRounding));
    CHECK(q.dot(moments.NyNy * q) == Approx(s2 * UU + 2.0 * cs * UW + c2 * WW).epsilon(kRounding));
    // ψ = w' = 2bs + 3cs²
    CHECK(moments.rotary_N.dot(q) ==
          Approx(kRotaryInertia * (2.0 * b * integrate_power(1) + 3.0 * c * integrate_power(2)))
              .epsilon(kRounding));
    CHECK(q.dot(moments.rotary_NN * q) ==
          Approx(kRotaryInertia * (4.0 * b * b * integrate_power(2) + 12.0 * b * c * integrate_power(3) +
                                   9.0 * c * c * integrate_power(4)))
              .epsilon(kRounding));
  }
}

TEST_CASE("The products of shape functions add up to the assembled mass") {
  const BeamModel model = test::make_general_frame();
  const MassMoments moments = calc_mass_moments(model, {0.3, -1.1});
  const Eigen::MatrixXd sum =
      Eigen::MatrixXd(moments.NxNx) + Eigen::MatrixXd(moments.NyNy) + Eigen::MatrixXd(moments.rotary_NN);
  CHECK(test::calc_difference(sum, assemble(model).mass) < 1e-14);
}

TEST_CASE("An L frame's moments agree with quadrature of displaced material points") {
  // one shape of displacement, its moments from r and φ(r) at five Gauss points of each element
  const BeamModel model = test::make_general_frame();
  const Eigen::Vector2d origin(0.3, -1.1);
  const MassMoments moments = calc_mass_moments(model, origin);
  Eigen::VectorXd q(15);
  q << 0.3, -0.7, 0.2, 1.1, 0.4, -0.9, -0.5, 0.8, 0.6, 0.25, -0.35, 0.15, 0.95, -1.2, 0.45;
  Eigen::Matrix2d r_phi = Eigen::Matrix2d::Zero(), phi_phi = Eigen::Matrix2d::Zero();
  Eigen::Vector2d phi_sum = Eigen::Vector2d::Zero();
  double psi_sum = 0.0;
  const auto add = [&](double dm, double dJ, const Eigen::Vector2d& r, const Eigen::Vector2d& phi,
                       double psi) {
    phi_sum += dm * phi;
    r_phi += dm * r * phi.transpose();
    phi_phi += dm * phi * phi.transpose();
    psi_sum += dJ * psi;
  };
  for (int e = 0; e < model.mesh.num_elements(); ++e) {
    const BeamElement element = make_element(model, e);
    const Mesh::Element& nodes = model.mesh.elements[static_cast<std::size_t>(e)];
    const double L = (element.second - element.first).norm();
    const Eigen::Vector2d t = (element.second - element.first) / L, n(-t.y(), t.x());
    Eigen::Matrix<double, 6, 1> own;  // by hand, without the element's rotation
    own << t.dot(q.segment<2>(3 * nodes.first)), n.dot(q.segment<2>(3 * nodes.first)), q[3 * nodes.first + 2],
        t.dot(q.segment<2>(3 * nodes.second)), n.dot(q.segment<2>(3 * nodes.second)), q[3 * nodes.second + 2];
    for (const auto& [xi, weight] : test::make_quadrature()) {
      const Eigen::Vector3d uwpsi = calc_shape_functions(L, element.properties, xi) * own;
      add(weight * L * element.properties.mass_per_length, weight * L * element.properties.rotary_inertia,
          element.first + xi * L * t - origin, uwpsi[0] * t + uwpsi[1] * n, uwpsi[2]);
    }
  }
  for (const PointMass& point : model.point_masses) {
    add(point.mass, point.inertia, model.mesh.node_positions.col(point.node) - origin,
        q.segment<2>(3 * point.node), q[3 * point.node + 2]);
  }
  const Eigen::Vector2d sums(moments.N_x.dot(q), moments.N_y.dot(q));
  Eigen::Matrix2d products, squares;
  products << moments.x_N_x.dot(q), moments.x_N_y.dot(q), moments.y_N_x.dot(q), moments.y_N_y.dot(q);
  squares << q.dot(moments.NxNx * q), q.dot(moments.NxNy * q), q.dot(moments.NxNy * q),
      q.dot(moments.NyNy * q);
  CHECK(test::calc_difference(sums, phi_sum) < 1e-12);
  CHECK(test::calc_difference(products, r_phi) < 1e-12);
  CHECK(test::calc_difference(squares, phi_phi) < 1e-12);
  CHECK(moments.rotary_N.dot(q) == Approx(psi_sum).epsilon(1e-12));
}

TEST_CASE("For rigid motions, the moments with shape functions equal those without") {
  const BeamModel model = test::make_general_frame();
  const Eigen::Vector2d origin(0.3, -1.1);
  const MassMoments moments = calc_mass_moments(model, origin);
  const Eigen::MatrixXd R = test::calc_rigid_motions(model.mesh, origin);  // rotation: (−y, x)
  const double mass = moments.mass, Sx = moments.first_moment.x(), Sy = moments.first_moment.y();
  Eigen::MatrixXd found(7, 3), expected(7, 3);
  found << moments.N_x.transpose() * R, moments.N_y.transpose() * R, moments.x_N_x.transpose() * R,
      moments.x_N_y.transpose() * R, moments.y_N_x.transpose() * R, moments.y_N_y.transpose() * R,
      moments.rotary_N.transpose() * R;
  expected << mass, 0, -Sy,  //
      0, mass, Sx,           //
      Sx, 0, -moments.xy,    //
      0, Sx, moments.xx,     //
      Sy, 0, -moments.yy,    //
      0, Sy, moments.xy,     //
      0, 0, moments.rotary;
  CHECK(test::calc_difference(found, expected) < kRounding);
  // and the skew part ∫(N_xᵀN_y − N_yᵀN_x) dm: translation against translation gives the mass
  const Eigen::MatrixXd NxNy = moments.NxNy;
  const Eigen::Matrix3d B = R.transpose() * (NxNy - NxNy.transpose()) * R;
  Eigen::Matrix3d expected_B;
  expected_B << 0, mass, Sx, -mass, 0, Sy, -Sx, -Sy, 0;
  CHECK(test::calc_difference(B, expected_B) < kRounding);
}

TEST_CASE("Moments about two origins obey the parallel-axis rules") {
  const BeamModel model = test::make_general_frame();
  const Eigen::Vector2d origin(0.3, -1.1), shift(1.7, 0.6);
  const MassMoments a = calc_mass_moments(model, origin), b = calc_mass_moments(model, origin + shift);
  const double dx = shift.x(), dy = shift.y();
  CHECK(b.mass == Approx(a.mass).epsilon(kRounding));
  CHECK(test::calc_difference(b.first_moment, a.first_moment - a.mass * shift) < kRounding);
  CHECK(b.xx == Approx(a.xx - 2.0 * dx * a.first_moment.x() + dx * dx * a.mass).epsilon(kRounding));
  CHECK(b.yy == Approx(a.yy - 2.0 * dy * a.first_moment.y() + dy * dy * a.mass).epsilon(kRounding));
  CHECK(
      b.xy ==
      Approx(a.xy - dx * a.first_moment.y() - dy * a.first_moment.x() + dx * dy * a.mass).epsilon(kRounding));
  CHECK(b.rotary == Approx(a.rotary).epsilon(kRounding));
  CHECK(test::calc_difference(b.x_N_x, a.x_N_x - dx * a.N_x) < kRounding);
  CHECK(test::calc_difference(b.x_N_y, a.x_N_y - dx * a.N_y) < kRounding);
  CHECK(test::calc_difference(b.y_N_x, a.y_N_x - dy * a.N_x) < kRounding);
  CHECK(test::calc_difference(b.y_N_y, a.y_N_y - dy * a.N_y) < kRounding);
  CHECK(test::calc_difference(b.NxNy, a.NxNy) < kRounding);
  CHECK(test::calc_difference(b.rotary_N, a.rotary_N) < kRounding);
}

TEST_CASE("Renumbering the nodes permutes the moments") {
  const std::vector<int> order = {2, 4, 1, 0, 3};
  const BeamModel model = test::make_general_frame();
  const MassMoments a = calc_mass_moments(model, {0.3, -1.1});
  const MassMoments b = calc_mass_moments(test::renumber(model, order), {0.3, -1.1});
  std::vector<Eigen::Index> dofs;
  for (const int node : order) {
    for (int i = 0; i < 3; ++i) dofs.push_back(3 * node + i);
  }
  CHECK(b.second_moment() == Approx(a.second_moment()).epsilon(kRounding));
  CHECK(test::calc_difference(b.x_N_y(dofs), a.x_N_y) < 1e-15);
  CHECK(test::calc_difference(Eigen::MatrixXd(b.NxNy)(dofs, dofs), a.NxNy) < 1e-15);
  CHECK(test::calc_difference(Eigen::MatrixXd(b.rotary_NN)(dofs, dofs), a.rotary_NN) < 1e-15);
}

TEST_CASE("An inconsistent model or origin is refused") {
  BeamModel model = test::make_general_frame();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  test::check_contains(test::message_of<std::invalid_argument>([&] {
                         calc_mass_moments(model, {nan, 0.0});
                       }),
                       "calc_mass_moments: origin is not finite");
  model.sections.clear();
  test::check_contains(test::message_of<std::invalid_argument>([&] {
                         calc_mass_moments(model, {0.0, 0.0});
                       }),
                       "calc_mass_moments: sections has 0 entries");
}

}  // namespace sprung::fem
