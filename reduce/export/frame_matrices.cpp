#include "reduce/export/frame_matrices.h"

#include <fmt/format.h>

#include "fem/assembly.h"
#include "reduce/export/text_output.h"

namespace sprung::reduce {

namespace {

std::string format_freedoms(const fem::Mesh& mesh) {
  std::string text = "node,direction\n";
  for (const std::int64_t id : mesh.node_ids) text += fmt::format("{0},x\n{0},y\n{0},rz\n", id);
  return text;
}

std::string format_nodes(const fem::Mesh& mesh) {
  std::string text = "node,x,y\n";
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    text += fmt::format("{},{},{}\n", mesh.node_ids[static_cast<std::size_t>(node)],
                        format_real(mesh.node_positions(0, node)), format_real(mesh.node_positions(1, node)));
  }
  return text;
}

}  // namespace

std::vector<std::filesystem::path> write_frame_matrices(const Design& design,
                                                        const std::filesystem::path& file,
                                                        const std::string& prefix) {
  if (design.matrices) {
    throw support::InputError({.path = design.matrices->stiffness_path},
                              fmt::format("'{}' has no beams: its matrices are there already", design.name));
  }
  if (!design.model.couplings.empty()) {
    throw support::InputError({.path = file.string()},
                              "has points that follow others ([[rigid_offsets]], [[averages]]); they have no "
                              "freedoms in the matrices of the whole frame");
  }
  const fem::AssembledMatrices matrices = fem::assemble(design.model);
  const std::pair<const char*, std::string> files[] = {
      {"_stiffness.mtx", format_symmetric_matrix_market(matrices.stiffness, "stiffness, N/m, N, N·m")},
      {"_mass.mtx", format_symmetric_matrix_market(matrices.mass, "mass, kg, kg·m, kg·m²")},
      {"_freedoms.csv", format_freedoms(design.model.mesh)},
      {"_nodes.csv", format_nodes(design.model.mesh)}};
  std::vector<std::filesystem::path> paths;
  TextFiles written;
  for (const auto& [ending, text] : files) {
    paths.emplace_back(prefix + ending);
    written.add(paths.back(), text);
  }
  written.commit();
  return paths;
}

}  // namespace sprung::reduce
