#include "reduce/export/mbdyn_export.h"

#include <fmt/format.h>

#include "reduce/export/spatial_integrals.h"
#include "reduce/export/text_output.h"

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

void write_nodes(const Superelement& s, RecordGroups& file) {
  file.begin(1, "HEADER");
  file.comment("REVISION, NODES, NORMAL, ATTACHMENT, CONSTRAINT, REJECTED MODES");
  file.line(fmt::format("REV0 {} {} 0 0 0", s.num_nodes(), s.num_modes()));
  file.begin(2, "FINITE ELEMENT NODE LIST");
  for (const std::int64_t id : s.node_ids) file.line(fmt::format("{}", id));
  file.begin(5, "NODAL X COORDINATES");
  file.rows(s.node_positions.row(0).transpose());
  file.begin(6, "NODAL Y COORDINATES");
  file.rows(s.node_positions.row(1).transpose());
  file.begin(7, "NODAL Z COORDINATES");
  file.rows(Eigen::VectorXd::Zero(s.num_nodes()));
}

void write_shapes(const Superelement& s, RecordGroups& file) {
  file.begin(8, "MODE SHAPES");
  for (Eigen::Index mode = 0; mode < s.num_modes(); ++mode) {
    file.comment(fmt::format("NORMAL MODE SHAPE # {}", mode + 1));
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(s.num_nodes(), 6);
    for (Eigen::Index node = 0; node < s.num_nodes(); ++node) {
      rows(node, 0) = s.shapes(3 * node, mode);
      rows(node, 1) = s.shapes(3 * node + 1, mode);
      rows(node, 5) = s.shapes(3 * node + 2, mode);
    }
    file.rows(rows);
  }
}

void write_matrices(const Superelement& s, RecordGroups& file) {
  file.begin(9, "MODAL MASS MATRIX");
  file.rows(s.mass);
  file.begin(10, "MODAL STIFFNESS MATRIX");
  file.rows(s.stiffness);
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

// ∫φ dm and ∫r×φ dm.
void write_momenta(const InertiaInvariants& inertia, RecordGroups& file) {
  const Eigen::Index n = inertia.P.cols();
  Eigen::MatrixXd momenta = Eigen::MatrixXd::Zero(3, n);
  momenta.topRows(2) = inertia.P;
  file.begin(14, "INVARIANT 3");
  file.rows(momenta);
  momenta.setZero();
  momenta.row(2) = inertia.c;
  file.begin(15, "INVARIANT 4");
  file.rows(momenta);
}

// ∫((r·φ) I − φ rᵀ) dm, a block of three columns for each mode.
void write_linear_products(const InertiaInvariants& inertia, RecordGroups& file) {
  const Eigen::Index n = inertia.P.cols();
  Eigen::MatrixXd blocks(3, 3 * n);
  for (Eigen::Index k = 0; k < n; ++k) blocks.middleCols<3>(3 * k) = calc_linear_products(inertia, k);
  file.begin(16, "INVARIANT 8");
  file.rows(blocks);
}

// ∫φᵢ×φⱼ dm, and ∫(φⱼ φᵢᵀ − (φᵢ·φⱼ) I) dm; j runs faster.
void write_quadratic_products(const InertiaInvariants& inertia, RecordGroups& file) {
  const Eigen::Index n = inertia.P.cols();
  Eigen::MatrixXd cross = Eigen::MatrixXd::Zero(3, n * n), blocks(3, 3 * n * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const Eigen::Index column = i * n + j;
      cross(2, column) = inertia.B(i, j);
      blocks.middleCols<3>(3 * column) = -calc_quadratic_products(inertia, i, j);
    }
  }
  file.begin(17, "INVARIANT 5");
  file.rows(cross);
  file.begin(18, "INVARIANT 9");
  file.rows(blocks);
}

}  // namespace

ExportReport export_mbdyn(const Superelement& s, const std::string& prefix) {
  RecordGroups file;
  write_nodes(s, file);
  write_shapes(s, file);
  write_matrices(s, file);
  write_momenta(s.inertia, file);
  write_linear_products(s.inertia, file);
  write_quadratic_products(s.inertia, file);
  file.line("**");
  ExportReport report{.paths = {prefix + ".fem"}, .left_out = {}};
  write_text_file(report.paths.front(), file.text());
  report.left_out = {
      "moments of inertia about x and y, which a body in the plane has not: each is half of that about z",
      "geometric stiffness, section loads, deflections under loads and the certificate"};
  return report;
}

}  // namespace sprung::reduce
