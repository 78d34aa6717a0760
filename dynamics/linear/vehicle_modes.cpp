#include "dynamics/linear/vehicle_modes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <complex>
#include <numbers>

#include "tools/support/dense/dense_solvers.h"
#include "tools/support/dense/eigenproblems.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

using std::numbers::pi;

// Eigenvalues with Im ≥ 0 of the damped system and the position parts of their vectors.
struct DampedModes {
  std::vector<std::complex<double>> eigenvalues;
  std::vector<Eigen::VectorXcd> shapes;
};

DampedModes calc_damped_modes(const LinearisedSystem& system, const Eigen::MatrixXd& damping) {
  const Eigen::Index f = system.mass.rows();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * f, 2 * f);
  A.topRightCorner(f, f).setIdentity();
  A.bottomLeftCorner(f, f) = -support::solve_positive_definite(system.mass, system.stiffness);
  A.bottomRightCorner(f, f) = -support::solve_positive_definite(system.mass, damping);
  const auto pairs = support::solve_general(A);
  if (!pairs) throw support::NumericalError("modes: no eigenvalues were found for the damped system");
  DampedModes modes;
  for (Eigen::Index k = 0; k < 2 * f; ++k) {
    if (pairs->values[k].imag() < 0.0) continue;  // the conjugate of another
    modes.eigenvalues.push_back(pairs->values[k]);
    modes.shapes.emplace_back(pairs->vector(k).head(f));
  }
  return modes;
}

// M b.
Eigen::VectorXcd weigh(const Eigen::MatrixXd& mass, const Eigen::VectorXcd& b) {
  Eigen::VectorXcd weighed(b.size());
  weighed.real() = mass * b.real();
  weighed.imag() = mass * b.imag();
  return weighed;
}

// Shapes with what the modal assurance criterion in the mass metric takes of them.
struct WeighedShapes {
  WeighedShapes(const Eigen::MatrixXd& mass, const std::vector<Eigen::VectorXcd>& shapes) {
    for (const Eigen::VectorXcd& shape : shapes) {
      weighed.push_back(weigh(mass, shape));
      sizes.push_back(shape.dot(weighed.back()).real());
    }
  }
  // Modal assurance criterion, times the size of a.
  double likeness(const Eigen::VectorXcd& a, std::size_t i) const {
    return std::norm(a.dot(weighed[i])) / sizes[i];
  }

  std::vector<Eigen::VectorXcd> weighed;  // M b
  std::vector<double> sizes;              // bᴴ M b
};

// A mode of the system without damping, its shape in the independent coordinates.
struct UndampedMode {
  double omega = 0.0;  // [rad/s]
  Eigen::VectorXcd shape;
};

// By growing frequency; those that nothing holds have the smallest |ω²|.
std::vector<UndampedMode> calc_undamped_modes(const LinearisedSystem& system) {
  const auto pairs = support::solve_undamped(system.stiffness, system.mass);
  if (!pairs) throw support::NumericalError("modes: the mass matrix is not positive definite");
  std::vector<UndampedMode> modes;
  for (Eigen::Index k = 0; k < system.mass.rows(); ++k) {
    modes.push_back(
        {std::sqrt(std::abs(pairs->values[k])), pairs->vectors.col(k).cast<std::complex<double>>()});
  }
  return modes;
}

// With Coriolis forces, the skew part of Ĉ, shapes are complex: of each the phase with the most kinetic
// energy.
std::vector<UndampedMode> calc_gyroscopic_modes(const LinearisedSystem& system) {
  const DampedModes complex_modes =
      calc_damped_modes(system, 0.5 * (system.damping - system.damping.transpose()));
  std::vector<UndampedMode> modes;
  for (std::size_t i = 0; i < complex_modes.shapes.size(); ++i) {
    const Eigen::VectorXcd& u = complex_modes.shapes[i];
    const Eigen::VectorXcd mass_u = system.mass.cast<std::complex<double>>() * u;
    const std::complex<double> square = u.cwiseProduct(mass_u).sum();
    modes.push_back({std::abs(complex_modes.eigenvalues[i]), u * std::polar(1.0, -0.5 * std::arg(square))});
  }
  return modes;
}

// Which bodies carry the kinetic energy of a shape, largest first; a body's own modes in brackets.
std::string describe_participants(const Model& model, const SystemTerms& terms,
                                  const Eigen::VectorXd& shape) {
  struct Share {
    std::string text;
    double value;
  };
  std::vector<Share> shares;
  double total = 0.0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const Eigen::VectorXd v = shape.segment(body.first_coordinate, body.num_coordinates());
    const double energy = v.dot(terms.mass(b) * v);
    total += energy;
    shares.push_back({body.name, energy});
    const Eigen::VectorXd modal = v.tail(body.num_modes());
    const double bending = modal.dot(body.M_ff * modal);
    if (bending <= 0.1 * energy) continue;
    Eigen::Index largest = 0;
    modal.cwiseAbs().maxCoeff(&largest);
    shares.back().text += fmt::format(" (mode {})", body.mode_numbers[static_cast<std::size_t>(largest)]);
  }
  std::stable_sort(shares.begin(), shares.end(),
                   [](const Share& a, const Share& b) { return a.value > b.value; });
  std::vector<std::string> words;
  for (const Share& share : shares) {
    if (share.value < 0.05 * total) break;
    words.push_back(fmt::format("{} {:.0f} %", share.text, 100.0 * share.value / total));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace

std::vector<VehicleMode> calc_vehicle_modes(const Model& model, const Equilibrium& equilibrium) {
  if (!equilibrium.stable) {
    throw support::NumericalError("modes: the equilibrium is unstable (a direction of negative stiffness)");
  }
  if (model.num_freedoms() == 0) return {};
  const LinearisedSystem& system = equilibrium.linearised;
  std::vector<UndampedMode> undamped =
      equilibrium.motion.omega != 0.0 ? calc_gyroscopic_modes(system) : calc_undamped_modes(system);
  std::stable_sort(undamped.begin(), undamped.end(),
                   [](const UndampedMode& a, const UndampedMode& b) { return a.omega < b.omega; });
  DampedModes damped = calc_damped_modes(system, system.damping);
  const std::size_t f = static_cast<std::size_t>(system.mass.rows()), num_rigid = equilibrium.neutral.size();
  // Of a neutral direction s = 0 comes twice, as a pair or as two real values.
  if (undamped.size() > f) {
    undamped.erase(undamped.begin(), undamped.begin() + static_cast<std::ptrdiff_t>(undamped.size() - f));
  }

  SystemTerms terms(model);
  terms.update_positions(0.0, equilibrium.q);
  terms.update_mass();

  WeighedShapes of_damped(system.mass, damped.shapes);
  std::vector<VehicleMode> modes;
  for (std::size_t k = 0; k < undamped.size(); ++k) {
    VehicleMode mode;
    const Eigen::VectorXd reduced_shape = undamped[k].shape.real();
    mode.shape =
        system.directions * reduced_shape / std::sqrt(reduced_shape.dot(system.mass * reduced_shape));
    mode.participants = describe_participants(model, terms, mode.shape);
    mode.is_rigid_body = k < num_rigid;
    if (mode.is_rigid_body) {
      modes.push_back(std::move(mode));
      continue;
    }
    mode.undamped_frequency_hz = undamped[k].omega / (2.0 * pi);
    std::size_t best = 0;
    double best_likeness = -1.0;
    for (std::size_t i = 0; i < damped.eigenvalues.size(); ++i) {
      const double value = of_damped.likeness(undamped[k].shape, i);
      if (value > best_likeness) {
        best_likeness = value;
        best = i;
      }
    }
    const std::complex<double> s = damped.eigenvalues[best];
    mode.damped_frequency_hz = s.imag() / (2.0 * pi);
    mode.damping_ratio =
        s.imag() > 0.0 ? -s.real() / std::abs(s) : -s.real() / (2.0 * pi * mode.undamped_frequency_hz);
    damped.eigenvalues.erase(damped.eigenvalues.begin() + static_cast<std::ptrdiff_t>(best));
    of_damped.weighed.erase(of_damped.weighed.begin() + static_cast<std::ptrdiff_t>(best));
    of_damped.sizes.erase(of_damped.sizes.begin() + static_cast<std::ptrdiff_t>(best));
    modes.push_back(std::move(mode));
  }
  return modes;
}

}  // namespace sprung::dynamics
