#include "dynamics/mode_choice/nonlinear_forces.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <cstddef>
#include <utility>

#include "dynamics/mode_choice/forcing_spectrum.h"
#include "dynamics/response/linear_outputs.h"
#include "dynamics/response/random_linearisation.h"

namespace sprung::dynamics {

namespace {

constexpr double kSmallMotion = 1e-3;  // of the motion at an instant: the difference is the linear law there
constexpr double kHardly = 0.1;        // of the element whose forces are the farthest from linear
constexpr double kLinear = 1e-6;       // of an element's forces: rounding

bool is_predictable(const LinearVehicle& vehicle, const ForceElement& force) {
  const Model& model = vehicle.model();
  for (const RoadInput& input : vehicle.inputs()) {
    if (model.forces[static_cast<std::size_t>(input.force)].get() == &force) return false;
  }
  return force.internal_states().empty() && force.time_functions().empty();
}

// One element, moved with its markers.
class MovedElement {
 public:
  MovedElement(const LinearVehicle& vehicle, std::size_t force)
      : model_(vehicle.model()),
        force_(*model_.forces[force]),
        at_rest_(vehicle.equations().terms().instant_of(force)),
        resting_branches_(model_.branches_of(force, vehicle.branches()).begin(),
                          model_.branches_of(force, vehicle.branches()).end()),
        markers_(at_rest_.markers.begin(), at_rest_.markers.end()),
        wrenches_(markers_.size()) {}

  // Forces and torques on its markers, 3 for each, at a motion δ away from rest: displacement, then rates of
  // each.
  Eigen::VectorXd calc(const Eigen::VectorXd& motion) {
    const std::vector<int> ends = force_.markers();
    for (std::size_t i = 0; i < ends.size(); ++i) {
      const auto end = static_cast<std::size_t>(ends[i]);
      const MarkerState& rest = at_rest_.markers[end];
      const auto part = motion.segment<6>(static_cast<Eigen::Index>(6 * i));
      markers_[end].r = rest.r + part.head<2>();
      markers_[end].angle = rest.angle + part[2];
      markers_[end].v = rest.v + part.segment<2>(3);
      markers_[end].omega = rest.omega + part[5];
      wrenches_[end] = {};
    }
    const Instant instant{.time = at_rest_.time, .markers = markers_};
    branches_ = resting_branches_;
    force_.choose_branches(instant, branches_);
    force_.add_wrenches(instant, branches_, wrenches_);
    Eigen::VectorXd values(static_cast<Eigen::Index>(3 * ends.size()));
    for (std::size_t i = 0; i < ends.size(); ++i) {
      const Wrench& wrench = wrenches_[static_cast<std::size_t>(ends[i])];
      values.segment<3>(static_cast<Eigen::Index>(3 * i)) << wrench.force, wrench.torque;
    }
    return values;
  }

 private:
  const Model& model_;
  const ForceElement& force_;
  Instant at_rest_;
  std::vector<int> resting_branches_, branches_;
  std::vector<MarkerState> markers_;
  std::vector<Wrench> wrenches_;
};

// Histories of the motion of an element's markers, as MovedElement::calc() takes it: 6 ends×n.
Eigen::MatrixXd calc_marker_motion(const LinearVehicle& vehicle, const std::vector<int>& ends,
                                   const Eigen::VectorXd& omega, const Eigen::MatrixXcd& forces,
                                   Eigen::Index n) {
  Eigen::MatrixXd motion = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(6 * ends.size()), n);
  const Eigen::RowVectorXcd rates = std::complex<double>(0.0, 1.0) * omega.transpose();
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (vehicle.model().markers[static_cast<std::size_t>(ends[i])].body == kGround) continue;
    const HarmonicSweep sweep(
        make_held_system(vehicle, make_point_outputs(vehicle, ends[i]).pick({0, 1, 2}), {}));
    const RowsXcd lines = sweep.respond(omega, forces);
    for (Eigen::Index c = 0; c < 3; ++c) {
      const Eigen::VectorXcd history = calc_histories(lines.row(c), lines.row(c).cwiseProduct(rates), n);
      motion.row(static_cast<Eigen::Index>(6 * i) + c) = history.real().transpose();
      motion.row(static_cast<Eigen::Index>(6 * i) + c + 3) = history.imag().transpose();
    }
  }
  return motion;
}

}  // namespace

NonlinearForces calc_nonlinear_forces(const LinearVehicle& vehicle, const Eigen::VectorXd& omega,
                                      const Eigen::MatrixXcd& forces, Eigen::Index num_lines) {
  NonlinearForces found;
  // The series of a kink falls with the square of the frequency, so that hardly any of it is folded back.
  const auto n = static_cast<Eigen::Index>(std::bit_ceil(static_cast<std::size_t>(2 * num_lines + 1)));
  const Model& model = vehicle.model();
  std::vector<double> sizes;
  for (std::size_t f = 0; f < model.forces.size(); ++f) {
    const ForceElement& force = *model.forces[f];
    if (!is_predictable(vehicle, force)) continue;
    const std::vector<int> ends = force.markers();
    const Eigen::MatrixXd motion = calc_marker_motion(vehicle, ends, omega, forces, n);
    MovedElement element(vehicle, f);
    const Eigen::VectorXd resting = element.calc(Eigen::VectorXd::Zero(motion.rows()));
    Eigen::MatrixXd beyond(resting.size(), n);
    double whole = 0.0;
    for (Eigen::Index j = 0; j < n; ++j) {
      const Eigen::VectorXd change = element.calc(motion.col(j)) - resting;
      const Eigen::VectorXd near = kSmallMotion * motion.col(j);
      beyond.col(j) = change - (element.calc(near) - element.calc(-near)) / (2.0 * kSmallMotion);
      whole += change.squaredNorm();
    }
    if (!(beyond.squaredNorm() > kLinear * kLinear * whole)) continue;
    sizes.push_back(beyond.squaredNorm());
    found.elements.push_back(force.name);
    if (found.forces.cols() == 0)
      found.forces = Eigen::MatrixXcd::Zero(vehicle.system().mass.rows(), num_lines);
    for (std::size_t i = 0; i < ends.size(); ++i) {
      const Eigen::MatrixXd gains = vehicle.system().directions.transpose() *
                                    calc_marker_jacobian(vehicle.equations().terms(), ends[i]).transpose();
      for (Eigen::Index c = 0; c < 3; ++c) {
        const auto row = static_cast<Eigen::Index>(3 * i) + c;
        const std::vector<double> samples(beyond.row(row).begin(), beyond.row(row).end());
        found.forces += gains.col(c) * calc_lines(samples, num_lines).transpose();
      }
    }
  }
  if (found.elements.empty()) return found;
  // Others, as springs that turn, hardly count.
  const double least = kHardly * kHardly * *std::max_element(sizes.begin(), sizes.end());
  for (std::size_t i = sizes.size(); i-- > 0;) {
    if (sizes[i] < least) found.elements.erase(found.elements.begin() + static_cast<std::ptrdiff_t>(i));
  }
  found.omega = omega[0] * Eigen::VectorXd::LinSpaced(num_lines, 1.0, static_cast<double>(num_lines));
  return found;
}

std::vector<std::string> list_unpredictable(const LinearVehicle& vehicle) {
  std::vector<std::string> elements;
  for (std::size_t f = 0; f < vehicle.model().forces.size(); ++f) {
    if (find_random_laws(vehicle, f).states) elements.push_back(vehicle.model().forces[f]->name);
  }
  return elements;
}

}  // namespace sprung::dynamics
