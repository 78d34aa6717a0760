#include "reduce/export/exudyn_export.h"

#include "reduce/export/csv_export.h"
#include "reduce/export/spatial_integrals.h"
#include "reduce/export/text_output.h"
#include "tools/support/hdf5/exchange_file.h"

namespace sprung::reduce {

namespace {

// A file of a Python dictionary: each value has its type as attribute.
class Dictionary {
 public:
  explicit Dictionary(const std::string& path) : file_(path) {}
  void number(const std::string& name, double value) {
    file_.write_number(name, value);
    set_type(name, "float64");
  }
  void integer(const std::string& name, std::int64_t value) {
    file_.write_integer(name, value);
    set_type(name, "int");
  }
  void text(const std::string& name, const std::string& value) {
    file_.write_text(name, value);
    set_type(name, "str");
  }
  void matrix(const std::string& name, const Eigen::MatrixXd& values) {
    file_.write_matrix(name, values);
    set_type(name, "ndarray");
  }
  void vector(const std::string& name, const Eigen::VectorXd& values) {
    file_.write_vector(name, values);
    set_type(name, "ndarray");
  }
  void integers(const std::string& name, const std::vector<std::int64_t>& values) {
    file_.write_long_integers(name, values);
    set_type(name, "ndarray");
  }
  void empty(const std::string& name, const std::string& type) {
    file_.make_group(name);
    set_type(name, type);
  }
  void commit() { file_.commit(); }

 private:
  void set_type(const std::string& name, const std::string& type) { file_.attribute(name, "datatype", type); }
  support::ExchangeFile file_;
};

void write_nodes(const Superelement& s, Dictionary& file) {
  file.matrix("modeBasis", expand_displacements(s));
  file.vector("xRef", expand_positions(s));
  file.empty("trigList", "list");
  file.empty("postProcessingModes", "dict");
}

void write_rigid(const InertiaInvariants& inertia, Dictionary& file) {
  const Eigen::Vector3d centre(inertia.first_moment.x() / inertia.mass,
                               inertia.first_moment.y() / inertia.mass, 0.0);
  file.number("totalMass", inertia.mass);
  file.matrix("Mtt", inertia.mass * Eigen::Matrix3d::Identity());
  file.vector("chiU", centre);
  file.matrix("chiUtilde", make_cross_matrix(centre));
  file.matrix("inertiaLocal", calc_inertia_tensor(inertia));
}

// Integrals with the modes (reduce/export, eqs. 13–16).
void write_coupling(const InertiaInvariants& inertia, Dictionary& file) {
  const Eigen::Index n = inertia.P.cols();
  Eigen::MatrixXd P = Eigen::MatrixXd::Zero(3, n), c = Eigen::MatrixXd::Zero(3, n),
                  cross = Eigen::MatrixXd::Zero(3, 3 * n), linear(3, 3 * n),
                  B = Eigen::MatrixXd::Zero(3 * n, n), quadratic(3 * n, 3 * n);
  P.topRows(2) = inertia.P;
  c.row(2) = -inertia.c;
  for (Eigen::Index k = 0; k < n; ++k) {
    cross.middleCols<3>(3 * k) = make_cross_matrix(P.col(k));
    linear.middleCols<3>(3 * k) = calc_linear_products(inertia, k);
    B.row(3 * k + 2) = -inertia.B.row(k);
    for (Eigen::Index j = 0; j < n; ++j)
      quadratic.block<3, 3>(3 * k, 3 * j) = calc_quadratic_products(inertia, k, j);
  }
  file.matrix("mPhitTPsi", P);
  file.matrix("mPhitTPsiTilde", cross);
  file.matrix("mXRefTildePsi", c);
  file.matrix("mXRefTildePsiTilde", linear);
  file.matrix("mPsiTildePsi", B);
  file.matrix("mPsiTildePsiTilde", quadratic);
}

}  // namespace

ExportReport export_exudyn(const Superelement& s, const std::string& prefix) {
  constexpr std::int64_t kFrameCoordinates = 7;  // place, and Euler parameters
  ExportReport report{.paths = {prefix + ".hdf5", prefix + "_nodes.csv"}, .left_out = {}};
  Dictionary file(report.paths.front().string());
  file.text("type", "ObjectFFRFreducedOrderInterface");
  file.integer("fileVersion", 1);
  file.text("rigidBodyNodeType", "NodeType.RotationEulerParameters");
  file.integers("infoList",
                {s.num_modes(), s.num_nodes(), 3, 4, kFrameCoordinates, kFrameCoordinates + s.num_modes()});
  write_nodes(s, file);
  file.matrix("massMatrixReduced", s.mass);
  file.matrix("stiffnessMatrixReduced", s.stiffness);
  write_rigid(s.inertia, file);
  write_coupling(s.inertia, file);
  TextFiles nodes;
  nodes.add(report.paths.back(), format_node_table(s));
  file.commit();
  nodes.commit();
  report.left_out = {
      "damping: Exudyn takes two factors, of the mass and of the stiffness",
      "rotations of the nodes: Exudyn's nodes of a flexible body have displacements alone",
      "moments of inertia about x and y, which a body in the plane has not: each is half of that about z",
      "geometric stiffness, section loads, deflections under loads and the certificate"};
  return report;
}

}  // namespace sprung::reduce
