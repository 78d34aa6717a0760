#include "dynamics/linear/vehicle_modes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <complex>
#include <numbers>

#include "dynamics/linear/first_order_form.h"
#include "dynamics/linear/undamped_modes.h"
#include "tools/support/dense/dense_solvers.h"
#include "tools/support/dense/eigenproblems.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

using std::numbers::pi;

constexpr double kSameShape = 1e-9;   // difference of modal assurance criteria that counts as none
constexpr double kLeastNamed = 0.05;  // of the kinetic energy, of a body that is named

// Eigenvalues of the damped system with Im ≥ 0, and the positions of their eigenvectors in the undamped
// modes.
struct DampedModes {
  std::vector<std::complex<double>> eigenvalues;
  std::vector<Eigen::VectorXcd> shapes;  // of length 1

  // Removes and returns the eigenvalue whose shape is most similar to u by the modal assurance criterion.
  // Those of a motion that does not oscillate have equal shapes: the largest one is taken. One that
  // oscillates goes before the decay of an internal state with the same shape.
  std::complex<double> take_most_similar(const Eigen::VectorXcd& u) {
    if (shapes.empty()) throw support::NumericalError("modes: fewer damped modes than undamped ones");
    std::size_t best = 0;
    double most = -1.0;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      const double likeness = std::norm(shapes[i].dot(u));
      const auto rank = [&](std::size_t j) {
        return std::pair(eigenvalues[j].imag() > 0.0, std::abs(eigenvalues[j]));
      };
      if (likeness <= most + (rank(i) > rank(best) ? -kSameShape : kSameShape)) continue;
      best = i;
      most = likeness;
    }
    const std::complex<double> s = eigenvalues[best];
    eigenvalues.erase(eigenvalues.begin() + static_cast<std::ptrdiff_t>(best));
    shapes.erase(shapes.begin() + static_cast<std::ptrdiff_t>(best));
    return s;
  }
};

DampedModes calc_damped_modes(const FirstOrderForm& form) {
  const auto pairs = support::solve_general(form.A);
  if (!pairs) throw support::NumericalError("modes: no eigenvalues were found for the damped system");
  const double rounding = calc_eigenvalue_rounding(pairs->values);
  DampedModes modes;
  for (Eigen::Index k = 0; k < pairs->values.size(); ++k) {
    const std::complex<double> s = pairs->values[k];
    if (s.imag() < 0.0) continue;  // the conjugate of another
    const bool is_at_rest = std::abs(s) <= rounding;
    modes.eigenvalues.push_back(is_at_rest ? 0.0 : s);
    modes.shapes.emplace_back(
        form.calc_amplitudes(pairs->vector(k), is_at_rest ? 1.0 : s).col(0).normalized());
  }
  return modes;
}

// A mode of the system without damping.
struct UndampedMode {
  double omega = 0.0;                         // [rad/s]; 0 for a free mode
  Eigen::VectorXcd shape;                     // in the undamped modes of stiffness and mass alone
  double rounding = 0.0;                      // of ω² [rad²/s²]
  std::complex<double> damped_eigenvalue{0};  // [rad/s]
};

// The modes of M̂ and K̂, free ones first.
std::vector<UndampedMode> list_undamped_modes(const FirstOrderForm& form) {
  const Eigen::Index f = form.V.rows();
  std::vector<UndampedMode> modes;
  for (Eigen::Index k = 0; k < f; ++k) {
    modes.push_back({.omega = k < form.num_free ? 0.0 : form.scale[k - form.num_free],
                     .shape = Eigen::VectorXcd::Unit(f, k),
                     .rounding = form.rounding[k]});
  }
  return modes;
}

// The modes with Coriolis forces, the skew part of Ĉ. Their shapes are complex; each is taken at the phase
// with the most kinetic energy.
std::vector<UndampedMode> list_gyroscopic_modes(const FirstOrderForm& form) {
  const DampedModes complex_modes = calc_damped_modes(form);
  std::vector<UndampedMode> modes;
  for (std::size_t i = 0; i < complex_modes.shapes.size(); ++i) {
    const Eigen::VectorXcd& u = complex_modes.shapes[i];
    const std::complex<double> square = u.cwiseProduct(u).sum();
    modes.push_back({.omega = std::abs(complex_modes.eigenvalues[i]),
                     .shape = u * std::polar(1.0, -0.5 * std::arg(square))});
  }
  // Two free modes that Coriolis forces couple have one pair of eigenvalues here, since positions of free
  // modes are no states. The mode that is then missing is free.
  while (static_cast<Eigen::Index>(modes.size()) < form.V.rows()) {
    modes.push_back({.omega = 0.0, .shape = Eigen::VectorXcd::Unit(form.V.rows(), 0)});
  }
  return modes;
}

// The modes without damping, free ones first, and without internal states of force elements, which are no
// motion: these damp and stiffen the modes. @param form  of the damped system, in whose V the shapes are
// given
std::vector<UndampedMode> list_modes(const LinearisedSystem& system, Eigen::Index num_states, bool turns,
                                     const FirstOrderForm& form) {
  if (!turns && num_states == 0) return list_undamped_modes(form);
  const Eigen::Index n = system.mass.rows() - num_states;  // states are the last freedoms
  const auto motion = [n](const Eigen::MatrixXd& A) -> Eigen::MatrixXd { return A.topLeftCorner(n, n); };
  const FirstOrderForm undamped =
      make_first_order_form(motion(system.mass), 0.5 * motion(system.damping - system.damping.transpose()),
                            motion(system.stiffness), motion(system.stiffness_rounding));
  std::vector<UndampedMode> modes = turns ? list_gyroscopic_modes(undamped) : list_undamped_modes(undamped);
  std::stable_sort(modes.begin(), modes.end(),
                   [](const UndampedMode& a, const UndampedMode& b) { return a.omega < b.omega; });
  // A motion that does not oscillate has two real eigenvalues.
  const auto count = static_cast<std::size_t>(n);
  if (modes.size() > count) modes.erase(modes.begin(), modes.end() - static_cast<std::ptrdiff_t>(count));
  const Eigen::MatrixXd to_form = form.V.transpose() * system.mass.leftCols(n) * undamped.V;
  for (UndampedMode& mode : modes) mode.shape = to_form * mode.shape;
  return modes;
}

// Each mode with stiffness takes the eigenvalue of the most similar shape. An oscillation that is left then,
// as internal states can hold a motion that no other element resists, or resist it more than the others,
// belongs to the most similar mode of those that do not oscillate otherwise.
void assign_damped(DampedModes damped, std::vector<UndampedMode>& modes) {
  for (UndampedMode& mode : modes)
    if (mode.omega > 0.0) mode.damped_eigenvalue = damped.take_most_similar(mode.shape);
  for (std::size_t i = 0; i < damped.eigenvalues.size(); ++i) {
    if (!(damped.eigenvalues[i].imag() > 0.0)) continue;
    UndampedMode* best = nullptr;
    double most = 0.0;
    for (UndampedMode& mode : modes) {
      const double likeness = std::norm(damped.shapes[i].dot(mode.shape));
      if (mode.damped_eigenvalue.imag() > 0.0 || likeness <= most) continue;
      best = &mode;
      most = likeness;
    }
    if (best != nullptr) best->damped_eigenvalue = damped.eigenvalues[i];
  }
}

// The bodies with the most kinetic energy, the largest share first. A body whose own modes have more than a
// tenth of its energy has a main mode.
std::vector<Participant> find_participants(const Model& model, const SystemTerms& terms,
                                           const Eigen::VectorXd& q, const Eigen::VectorXd& shape) {
  std::vector<Participant> participants;
  double total = 0.0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const Eigen::VectorXd v = shape.segment(body.first_coordinate, body.num_coordinates());
    const double energy = v.dot(terms.mass(b) * v);
    total += energy;
    Participant one{.body = static_cast<int>(b), .share = energy, .motion = v.head<3>()};
    if (body.mass > 0.0) {
      const Eigen::Vector2d arm =
          Eigen::Rotation2Dd(q[body.first_coordinate + 2]) * body.first_moment / body.mass;
      one.motion.head<2>() += v[2] * Eigen::Vector2d(-arm.y(), arm.x());
    }
    const Eigen::VectorXd modal = v.tail(body.num_modes());
    if (modal.dot(body.M_ff * modal) > 0.1 * energy) {
      Eigen::Index largest = 0;
      modal.cwiseAbs().maxCoeff(&largest);
      one.main_mode = body.mode_numbers[static_cast<std::size_t>(largest)];
    }
    participants.push_back(one);
  }
  std::stable_sort(participants.begin(), participants.end(),
                   [](const Participant& a, const Participant& b) { return a.share > b.share; });
  std::erase_if(participants, [&](const Participant& one) { return one.share < kLeastNamed * total; });
  for (Participant& one : participants) one.share /= total;
  return participants;
}

}  // namespace

std::vector<VehicleMode> calc_vehicle_modes(const Model& model, const Equilibrium& equilibrium) {
  if (!equilibrium.stable) {
    throw support::NumericalError("modes: the equilibrium is unstable (a direction of negative stiffness)");
  }
  if (model.num_freedoms() == 0) return {};
  const LinearisedSystem& system = equilibrium.linearised;
  const FirstOrderForm form =
      make_first_order_form(system.mass, system.damping, system.stiffness, system.stiffness_rounding);
  std::vector<UndampedMode> undamped =
      list_modes(system, model.num_states(), equilibrium.motion.omega != 0.0, form);
  assign_damped(calc_damped_modes(form), undamped);

  SystemTerms terms(model);
  terms.update_positions(0.0, equilibrium.q);
  terms.update_mass();

  std::vector<VehicleMode> modes;
  for (const UndampedMode& one : undamped) {
    VehicleMode mode;
    mode.shape = system.directions * (form.V * one.shape.real().normalized());
    mode.participants = find_participants(model, terms, equilibrium.q, mode.shape);
    mode.is_rigid_body = one.omega == 0.0;
    mode.undamped_frequency_hz = one.omega / (2.0 * pi);
    mode.largest_frequency_hz = std::sqrt(one.omega * one.omega + one.rounding) / (2.0 * pi);
    const std::complex<double> s = one.damped_eigenvalue;
    if (s.imag() > 0.0) {
      mode.damped_frequency_hz = s.imag() / (2.0 * pi);
      mode.damping_ratio = -s.real() / std::abs(s);
    } else if (!mode.is_rigid_body) {
      const double decay = -s.real();
      mode.decay_rate = decay;
      if (decay != 0.0) mode.damping_ratio = 0.5 * (decay / one.omega + one.omega / decay);
    }
    modes.push_back(std::move(mode));
  }
  return modes;
}

}  // namespace sprung::dynamics
