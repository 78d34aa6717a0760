#include "reduce/export/mbdyn_export.h"

#include <fmt/format.h>

#include <stdexcept>

#include "reduce/export/mass_points.h"
#include "reduce/export/text_output.h"
#include "tools/support/errors/input_error.h"

namespace sprung::reduce {

namespace {

// A file of numbered record groups. MBDyn finds a group by the beginning of its heading.
class RecordGroups {
 public:
  void begin(int number, const std::string& title) {
    text_ += fmt::format("**\n** RECORD GROUP {}, {}\n", number, title);
  }
  void comment(const std::string& text) { text_ += fmt::format("** {}\n", text); }
  void line(const std::string& text) { text_ += text + "\n"; }
  void rows(const Eigen::MatrixXd& matrix) {
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
      for (Eigen::Index j = 0; j < matrix.cols(); ++j)
        text_ += fmt::format("{}{}", j == 0 ? "" : " ", format_real(matrix(i, j)));
      text_ += "\n";
    }
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_ = "** MBDyn MODAL DATA FILE\n** NODE SET \"ALL\"\n";
};

// Nodes of the frame, then the points with masses, then those with moments of inertia.
struct FileNodes {
  std::vector<std::string> labels;
  Eigen::Matrix2Xd position;
  Eigen::MatrixXd shapes;  // rows x, y, rotation of each
  Eigen::MatrixXd lumped;  // mass and inertia in columns
};

FileNodes make_nodes(const Superelement& s) {
  const MassPoints points = find_mass_points(s.inertia);
  const Eigen::Index N = s.num_nodes(), K = points.mass.size(), L = points.inertia.size();
  FileNodes nodes{.labels = {},
                  .position = Eigen::Matrix2Xd::Zero(2, N + K + L),
                  .shapes = Eigen::MatrixXd::Zero(3 * (N + K + L), s.num_modes()),
                  .lumped = Eigen::MatrixXd::Zero(N + K + L, 2)};
  for (const std::int64_t id : s.node_ids) nodes.labels.push_back(fmt::format("{}", id));
  nodes.position.leftCols(N) = s.node_positions;
  nodes.shapes.topRows(3 * N) = s.shapes;
  nodes.position.middleCols(N, K) = points.position;
  for (Eigen::Index k = 0; k < K; ++k) {
    nodes.labels.push_back(fmt::format("mass{}", k + 1));
    nodes.shapes.row(3 * (N + k)) = points.shape_x.row(k);
    nodes.shapes.row(3 * (N + k) + 1) = points.shape_y.row(k);
    nodes.lumped(N + k, 0) = points.mass(k);
  }
  for (Eigen::Index l = 0; l < L; ++l) {
    nodes.labels.push_back(fmt::format("inertia{}", l + 1));
    nodes.shapes.row(3 * (N + K + l) + 2) = points.rotation.row(l);
    nodes.lumped(N + K + l, 1) = points.inertia(l);
  }
  return nodes;
}

void write_nodes(const FileNodes& nodes, RecordGroups& file) {
  const auto count = static_cast<Eigen::Index>(nodes.labels.size());
  file.begin(1, "HEADER");
  file.comment("REVISION, NODES, NORMAL, ATTACHMENT, CONSTRAINT, REJECTED MODES");
  file.line(fmt::format("REV0 {} {} 0 0 0", count, nodes.shapes.cols()));
  file.begin(2, "FINITE ELEMENT NODE LIST");
  for (const std::string& label : nodes.labels) file.line(label);
  file.begin(5, "NODAL X COORDINATES");
  file.rows(nodes.position.row(0).transpose());
  file.begin(6, "NODAL Y COORDINATES");
  file.rows(nodes.position.row(1).transpose());
  file.begin(7, "NODAL Z COORDINATES");
  file.rows(Eigen::VectorXd::Zero(count));
}

void write_shapes(const FileNodes& nodes, RecordGroups& file) {
  file.begin(8, "MODE SHAPES");
  for (Eigen::Index mode = 0; mode < nodes.shapes.cols(); ++mode) {
    file.comment(fmt::format("NORMAL MODE SHAPE # {}", mode + 1));
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(nodes.lumped.rows(), 6);
    for (Eigen::Index node = 0; node < rows.rows(); ++node) {
      rows(node, 0) = nodes.shapes(3 * node, mode);
      rows(node, 1) = nodes.shapes(3 * node + 1, mode);
      rows(node, 5) = nodes.shapes(3 * node + 2, mode);
    }
    file.rows(rows);
  }
}

void write_matrices(const Superelement& s, const FileNodes& nodes, RecordGroups& file) {
  file.begin(9, "MODAL MASS MATRIX");
  file.rows(s.mass);
  file.begin(10, "MODAL STIFFNESS MATRIX");
  file.rows(s.stiffness);
  file.begin(11, "DIAGONAL OF LUMPED MASS MATRIX");
  for (Eigen::Index node = 0; node < nodes.lumped.rows(); ++node) {
    const double mass = nodes.lumped(node, 0);
    file.rows(Eigen::Matrix<double, 1, 6>{{mass, mass, mass, 0.0, 0.0, nodes.lumped(node, 1)}});
  }
  // About the centre of mass. A body in a plane has half of its moment about each axis in it, for want of
  // better.
  const Eigen::Vector2d centre = s.inertia.first_moment / s.inertia.mass;
  const double J = s.inertia.second_moment - s.inertia.mass * centre.squaredNorm();
  file.begin(12, "RIGID BODY INERTIA MATRIX");
  file.line(format_real(s.inertia.mass));
  file.rows(Eigen::RowVector3d(centre.x(), centre.y(), 0.0));
  file.rows(Eigen::Vector3d(0.5 * J, 0.5 * J, J).asDiagonal().toDenseMatrix());
  file.begin(13, "MODAL DAMPING MATRIX");
  file.rows(s.damping);
}

}  // namespace

ExportReport export_mbdyn(const Superelement& s, const std::string& prefix) {
  ExportReport report{.paths = {prefix + ".fem"}, .left_out = {}};
  FileNodes nodes;
  try {
    nodes = make_nodes(s);
  } catch (const std::domain_error&) {
    throw support::InputError({.path = report.paths.front().string()},
                              "no masses at points have the body's integrals, as MBDyn needs them. Those of "
                              "a body from matrices are not "
                              "exact: take a frame of more elements");
  }
  RecordGroups file;
  write_nodes(nodes, file);
  write_shapes(nodes, file);
  write_matrices(s, nodes, file);
  file.line("**");
  write_text_file(report.paths.front(), file.text());
  report.left_out = {
      "moments of inertia about x and y, which a body in the plane has not: each is half of that about z",
      "geometric stiffness, section loads, deflections under loads and the certificate"};
  return report;
}

}  // namespace sprung::reduce
