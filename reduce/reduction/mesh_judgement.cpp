#include "reduce/reduction/mesh_judgement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fem/mesh_error.h"
#include "reduce/reduction/superelement_checks.h"

namespace sprung::reduce {

namespace {

constexpr double kMostSaid = 0.3;  // beyond it the estimate says no more than that

std::string format_error(double error) {
  return error > kMostSaid ? fmt::format("more than {:g} %", 100.0 * kMostSaid)
                           : fmt::format("about {:.2g} %", 100.0 * error);
}

}  // namespace

double choose_judged_hz(const Design& design, const Superelement& s) {
  const double band_hz = s.certificate->highest_hz;
  const bool are_asked_for =
      design.reduction.basis == BasisKind::kClamped && !std::holds_alternative<AllModes>(design.modes.wanted);
  return are_asked_for ? std::max(band_hz, s.frequency_hz(s.num_modes() - 1)) : band_hz;
}

CheckResult make_mesh_check(const Design& design, double judged_hz) {
  return {.name = fmt::format("{} at {:.6g} Hz", kMeshCheck, judged_hz),
          .value = std::min(fem::estimate_mesh_error(design.model).at(judged_hz), kNoTolerance),
          .tolerance = kNoTolerance};
}

std::string describe_mesh(const Design& design, double judged_hz) {
  const fem::MeshError worst = fem::estimate_mesh_error(design.model);
  if (worst.element < 0) return {};
  return fmt::format(
      "mesh: its elements make frequencies too high by {} at {:.6g} Hz, and by at most {:g} % up to {:.3g} "
      "Hz "
      "(estimated)",
      format_error(worst.at(judged_hz)), judged_hz, 100.0 * fem::kCoarseMesh, worst.limit_hz());
}

std::string remark_on_mesh(const Design& design, double judged_hz) {
  const fem::BeamModel& model = design.model;
  const fem::MeshError worst = fem::estimate_mesh_error(model);
  if (!(worst.at(judged_hz) > fem::kCoarseMesh)) return {};
  const fem::Mesh::Element& element = model.mesh.elements[static_cast<std::size_t>(worst.element)];
  const int num_coarse = fem::count_coarse_elements(model, judged_hz);
  return fmt::format(
      "the mesh is too coarse for {:.6g} Hz: there the element of '{}' between {} and {} makes frequencies "
      "too "
      "high by {}, by an estimate; {} elements in its place keep within {:g} %{}",
      judged_hz, model.mesh.section_names[static_cast<std::size_t>(element.section)],
      fem::describe_node(model.mesh, element.first), fem::describe_node(model.mesh, element.second),
      format_error(worst.at(judged_hz)), fem::calc_num_parts(model, worst.element, judged_hz),
      100.0 * fem::kCoarseMesh,
      num_coarse == 1 ? std::string() : fmt::format("; {} elements are too long", num_coarse));
}

}  // namespace sprung::reduce
