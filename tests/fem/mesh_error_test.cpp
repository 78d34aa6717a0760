#include "fem/mesh_error.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "fem/assembly.h"
#include "tests/catch.h"

namespace sprung::fem {

namespace {

using std::numbers::pi;

constexpr double kMassPerLength = 12.0, kBending = 3.1e4, kAxial = 4.4e7, kLength = 2.7;

BeamModel make_beam(int num_elements, const BeamProperties& section) {
  BeamModel model;
  model.sections = {section};
  model.mesh.section_names = {"beam"};
  model.mesh.node_positions.resize(2, num_elements + 1);
  for (int i = 0; i <= num_elements; ++i) {
    model.mesh.node_ids.push_back(i + 1);
    model.mesh.node_positions.col(i) << kLength * i / num_elements, 0.0;
    if (i > 0) model.mesh.elements.push_back({.first = i - 1, .second = i, .section = 0});
  }
  return model;
}

BeamProperties make_section(double shear = std::numeric_limits<double>::infinity(), double rotary = 0.0) {
  return {.axial_rigidity = kAxial,
          .bending_rigidity = kBending,
          .shear_rigidity = shear,
          .mass_per_length = kMassPerLength,
          .rotary_inertia = rotary};
}

// ω of the mesh, ascending, of the freedoms at all nodes given by their place in (x, y, rotation), without
// `held` ones.
Eigen::VectorXd calc_omega(const BeamModel& model, const std::vector<int>& freedoms,
                           const std::vector<int>& held) {
  const AssembledMatrices matrices = assemble(model);
  std::vector<int> kept;
  for (int node = 0; node < model.mesh.num_nodes(); ++node) {
    for (const int freedom : freedoms) {
      if (std::find(held.begin(), held.end(), 3 * node + freedom) == held.end())
        kept.push_back(3 * node + freedom);
    }
  }
  const Eigen::MatrixXd K = Eigen::MatrixXd(matrices.stiffness)(kept, kept);
  const Eigen::MatrixXd M = Eigen::MatrixXd(matrices.mass)(kept, kept);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(K, M, Eigen::EigenvaluesOnly);
  return solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
}

// Estimate over true error.
double compare(const BeamModel& model, double omega_mesh, double omega) {
  return estimate_mesh_error(model).at(omega / (2.0 * pi)) / (omega_mesh / omega - 1.0);
}

// Solutions of cos x cosh x = 1 above 0, by Newton's method from (i + 1/2) π.
double calc_free_root(int mode) {
  double x = (mode + 0.5) * pi;
  for (int i = 0; i < 8; ++i)
    x -= (std::cos(x) - 1.0 / std::cosh(x)) / (std::tanh(x) / std::cosh(x) - std::sin(x));
  return x;
}

}  // namespace

// Closed form: ω = (nπ/L)² √(EI/ρA).
TEST_CASE(
    "The error of pinned beams is estimated to a factor of 1.65 at modes of up to a half wave an element") {
  for (int n = 1; n <= 8; ++n) {
    const BeamModel model = make_beam(n, make_section());
    const Eigen::VectorXd omega = calc_omega(model, {1, 2}, {1, 3 * n + 1});
    for (int mode = 1; mode <= n; ++mode) {
      const double exact = std::pow(mode * pi / kLength, 2) * std::sqrt(kBending / kMassPerLength);
      CAPTURE(n, mode);
      CHECK(compare(model, omega(mode - 1), exact) > 1.0 / 1.65);
      CHECK(compare(model, omega(mode - 1), exact) < 1.3);
    }
  }
}

// Closed form: cos x cosh x = 1, ω = (x/L)² √(EI/ρA). Mode n − 1 of n elements is ten times better than
// others.
TEST_CASE(
    "The error of free beams is never estimated too small where it exceeds 2 %, and to a factor of 2 at most "
    "modes") {
  for (int n = 1; n <= 8; ++n) {
    const BeamModel model = make_beam(n, make_section());
    const Eigen::VectorXd omega = calc_omega(model, {1, 2}, {}).tail(2 * n);
    for (int mode = 1; mode <= 2 * n; ++mode) {
      const double exact = std::pow(calc_free_root(mode) / kLength, 2) * std::sqrt(kBending / kMassPerLength);
      const double ratio = compare(model, omega(mode - 1), exact);
      CAPTURE(n, mode, ratio);
      CHECK(ratio > 0.8);
      if (mode <= n && mode != n - 1) CHECK(ratio < 2.0);
      if (mode == n - 1) CHECK(ratio < 10.0);
    }
  }
}

// Closed form of Timoshenko's pinned beam, w = sin βx, ψ = a cos βx:
// (ρA ω² − κGA β²)(ρI ω² − κGA − EI β²) = (κGA β)².
TEST_CASE("The error of beams that shear is estimated to a factor of 2 up to a third of a wave an element") {
  const double shear = 2e4, rotary = 0.04;
  for (const double I : {0.0, rotary}) {
    for (const int n : {3, 6, 12}) {
      const BeamModel model = make_beam(n, make_section(shear, I));
      const Eigen::VectorXd omega = calc_omega(model, {1, 2}, {1, 3 * n + 1});
      for (int mode = 1; mode <= 2 * n / 3; ++mode) {
        const double b2 = std::pow(mode * pi / kLength, 2), stiff = shear + kBending * b2;
        double exact = 0.0;
        if (I == 0.0) {
          exact = std::sqrt((shear * b2 - shear * shear * b2 / stiff) / kMassPerLength);
        } else {
          const double a = kMassPerLength * I, b = kMassPerLength * stiff + I * shear * b2;
          exact = std::sqrt(2.0 * shear * b2 * kBending * b2 /
                            (b + std::sqrt(b * b - 4.0 * a * shear * b2 * kBending * b2)));
        }
        CAPTURE(I, n, mode);
        CHECK(compare(model, omega(mode - 1), exact) > 0.5);
        CHECK(compare(model, omega(mode - 1), exact) < 2.0);
      }
    }
  }
}

// Closed form of a rod held at one end: ω = (n − ½) π/L √(EA/ρA). Made soft, so that axial motion is the
// worst.
TEST_CASE("The error of rods is estimated to a factor of 1.3 up to a quarter of a wave an element") {
  for (int n = 1; n <= 8; ++n) {
    BeamProperties section = make_section();
    section.axial_rigidity = 1e3;
    const BeamModel model = make_beam(n, section);
    const Eigen::VectorXd omega = calc_omega(model, {0}, {0});
    for (int mode = 1; 2 * mode <= n + 1; ++mode) {
      const double exact = (mode - 0.5) * pi / kLength * std::sqrt(section.axial_rigidity / kMassPerLength);
      CAPTURE(n, mode);
      CHECK(compare(model, omega(mode - 1), exact) == Approx(1.0).epsilon(0.3));
    }
  }
}

TEST_CASE(
    "A mesh is as good as it says up to its limit, and divided as it says up to the frequency asked for") {
  for (const double shear : {2e4, std::numeric_limits<double>::infinity()}) {
    const BeamModel model = make_beam(2, make_section(shear));
    const MeshError error = estimate_mesh_error(model);
    CHECK(error.at(error.limit_hz()) == Approx(kCoarseMesh));
    CHECK(count_coarse_elements(model, 0.99 * error.limit_hz()) == 0);
    CHECK(calc_num_parts(model, 0, 0.99 * error.limit_hz()) == 1);
    const double wanted_hz = 40.0 * error.limit_hz();
    CHECK(count_coarse_elements(model, wanted_hz) == 2);
    const int parts = calc_num_parts(model, 0, wanted_hz);
    CHECK(estimate_mesh_error(make_beam(2 * parts, make_section(shear))).at(wanted_hz) <= kCoarseMesh);
    CHECK(estimate_mesh_error(make_beam(2 * parts - 2, make_section(shear))).at(wanted_hz) > kCoarseMesh);
  }
}

TEST_CASE("Elements without mass and bushings add no error") {
  BeamProperties section = make_section();
  section.mass_per_length = 0.0;
  CHECK(estimate_mesh_error(make_beam(1, section)).element == -1);
  CHECK(estimate_mesh_error(make_beam(1, section)).at(1e9) == 0.0);
  CHECK(std::isinf(estimate_mesh_error(make_beam(1, section)).limit_hz()));
  section.mass_per_length = kMassPerLength;
  section.bushing = Bushing{};
  CHECK(calc_error_per_omega_squared(kLength, section) == 0.0);
}

}  // namespace sprung::fem
