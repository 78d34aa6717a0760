#include "reduce/reduction/mechanism.h"

#include <fmt/format.h>

#include "fem/beam_element.h"
#include "fem/coupling.h"
#include "reduce/modes/held_node.h"
#include "reduce/modes/rounding_error.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {

namespace {

constexpr double kMostOfTheEnergy = 0.9;

// Strain energy of each element, but for a factor.
Eigen::VectorXd calc_energies(const fem::BeamModel& model, const Eigen::MatrixXd& shape) {
  Eigen::VectorXd energies(model.mesh.num_elements());
  for (int e = 0; e < model.mesh.num_elements(); ++e) {
    const fem::Mesh::Element& nodes = model.mesh.elements[static_cast<std::size_t>(e)];
    Eigen::VectorXd ends(6);
    ends << shape.middleRows<3>(3 * nodes.first), shape.middleRows<3>(3 * nodes.second);
    energies(e) = ends.dot(fem::calc_stiffness(fem::make_element(model, e)) * ends);
  }
  return energies;
}

}  // namespace

double check_rounding(const Design& design, const Eigen::SparseMatrix<double>& stiffness,
                      const EigenPairs& modes) {
  double error = -1.0;
  Eigen::Index worst = 0;
  for (Eigen::Index i = 0; i < modes.omega_squared.size(); ++i) {
    const double found = estimate_rounding_error(stiffness, modes.vectors.col(i), modes.omega_squared(i));
    if (found <= error) continue;
    error = found;
    worst = i;
  }
  if (error <= kMaxRoundingError) return error;
  const double frequency_hz = calc_frequency_hz(modes.omega_squared(worst));
  const Eigen::MatrixXd shape = fem::move_followers(
      design.model.couplings, insert_node(modes.vectors.col(worst), design.reference_node));
  const Eigen::VectorXd energies = calc_energies(design.model, shape);
  Eigen::Index softest = 0;
  const double largest = energies.size() > 0 ? energies.maxCoeff(&softest) : 0.0;
  if (design.model.mesh.num_elements() > 2 && largest > kMostOfTheEnergy * energies.sum()) {
    const fem::Mesh& mesh = design.model.mesh;
    const fem::Mesh::Element& element = mesh.elements[static_cast<std::size_t>(softest)];
    throw support::NumericalError(
        fmt::format("the body has an internal mechanism: it gives way at {:.3g} Hz in the element of "
                    "section '{}' from {} to {}, so softly that rounding spoils the mode (relative error "
                    "of ω² {:.2g}, accepted is {:.0e}); make it two bodies with a joint, or stiffen the "
                    "section",
                    frequency_hz, mesh.section_names[static_cast<std::size_t>(element.section)],
                    fem::describe_node(mesh, element.first), fem::describe_node(mesh, element.second), error,
                    kMaxRoundingError));
  }
  throw support::NumericalError(fmt::format(
      "rounding spoils {} ({:.6g} Hz): its estimated relative error in ω² is {:.2g}, accepted "
      "is {:.0e}; refine the mesh less{} (the error grows with the fourth power of the number of elements)",
      worst == 0 ? "the lowest mode" : fmt::format("mode {}", worst + 1), frequency_hz, error,
      kMaxRoundingError, worst == 0 ? "" : " where this mode bends"));
}

}  // namespace sprung::reduce
