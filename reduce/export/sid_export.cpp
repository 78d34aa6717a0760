#include "reduce/export/sid_export.h"

#include <fmt/format.h>

#include "reduce/export/spatial_integrals.h"
#include "reduce/export/text_output.h"

namespace sprung::reduce {

namespace {

// A number with the exponent's letter of Fortran.
std::string format_exponent(double number) {
  std::string text = fmt::format("{:.16E}", number);
  text[text.find('E')] = 'D';
  return text;
}

// A matrix and its derivatives with the modal coordinates.
struct Taylor {
  Eigen::MatrixXd zero;
  std::vector<Eigen::MatrixXd> first = {};  // one for each mode, or none
};

class SidFile {
 public:
  explicit SidFile(const Superelement& s) : num_modes_(s.num_modes()) {
    line(fmt::format("{} {} : number of nodes, number of modes", s.num_nodes(), num_modes_));
  }
  void line(const std::string& text) { text_ += text + "\n"; }
  void taylor(const std::string& name, const Taylor& taylor) {
    line(name);
    line(fmt::format("order = {}", taylor.first.empty() ? 0 : 1));
    line(fmt::format("nrow = {}", taylor.zero.rows()));
    line(fmt::format("ncol = {}", taylor.zero.cols()));
    line(fmt::format("nq = {}", num_modes_));
    line("nqn = 0");
    line(fmt::format("structure = {}", taylor.zero.isZero(0.0) && taylor.first.empty() ? kZero : kFull));
    entries(taylor.zero, [](Eigen::Index i, Eigen::Index j) { return fmt::format("m0({},{})", i, j); });
    for (std::size_t k = 0; k < taylor.first.size(); ++k) {
      entries(taylor.first[k],
              [&](Eigen::Index i, Eigen::Index j) { return fmt::format("m1({},{},{})", i, k + 1, j); });
    }
    line("end " + name);
  }
  const std::string& text() const { return text_; }

 private:
  static constexpr int kZero = 0, kFull = 3;

  template <class Name>
  void entries(const Eigen::MatrixXd& matrix, Name&& name) {
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
      for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
        if (matrix(i, j) != 0.0)
          line(fmt::format("{} = {}", name(i + 1, j + 1), format_exponent(matrix(i, j))));
      }
    }
  }

  int num_modes_;
  std::string text_;
};

// A symmetric matrix of the lowest modes as one of all modes; zero where it is not known.
class Stiffening {
 public:
  explicit Stiffening(const Superelement& s) : s_(s) {}
  bool is_known() const { return s_.geometric_stiffness && s_.geometric_stiffness->num_modes() > 0; }
  Eigen::MatrixXd expand(const Eigen::MatrixXd& K) const {
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(s_.num_modes(), s_.num_modes());
    all.topLeftCorner(K.rows(), K.cols()) = K;
    return all;
  }
  const GeometricStiffness& matrices() const { return *s_.geometric_stiffness; }
  Eigen::MatrixXd centrifugal() const { return is_known() ? expand(matrices().centrifugal) : none(); }
  Eigen::MatrixXd angular() const { return is_known() ? expand(matrices().angular_acceleration) : none(); }
  Eigen::MatrixXd linear(std::size_t axis) const {
    return is_known() ? expand(matrices().acceleration[axis]) : none();
  }

 private:
  Eigen::MatrixXd none() const { return Eigen::MatrixXd::Zero(s_.num_modes(), s_.num_modes()); }
  const Superelement& s_;
};

void write_reference(const Superelement& s, SidFile& file) {
  file.line("refmod");
  file.line("mass = " + format_exponent(s.inertia.mass));
  file.line(fmt::format("nelastq = {}", s.num_modes()));
  for (int mode = 0; mode < s.num_modes(); ++mode) {
    file.line(fmt::format("ielastq ({}) = Eigen Mode {} : {} Hz", mode + 1, mode + 1,
                          format_real(s.frequency_hz(mode))));
  }
  file.line("end refmod");
}

// −K_jx, −K_jy and −K_jψ of a node: how its displacements and its rotation change with the coordinates.
std::vector<Eigen::MatrixXd> find_point_stiffness(const Superelement& s, int node) {
  const Stiffening stiffening(s);
  if (!stiffening.is_known()) return {};
  for (std::size_t point = 0; point < s.points.size(); ++point) {
    if (s.points[point].node != node) continue;
    std::vector<Eigen::MatrixXd> found;
    for (const Eigen::MatrixXd& K : stiffening.matrices().point_loads[point])
      found.emplace_back(-stiffening.expand(K));
    return found;
  }
  return {};
}

void write_node(const Superelement& s, int node, SidFile& file) {
  const Eigen::Index n = s.num_modes();
  Taylor origin{.zero = Eigen::Vector3d::Zero()}, axes{.zero = Eigen::Matrix3d::Identity()};
  Taylor phi{.zero = Eigen::MatrixXd::Zero(3, n)}, psi{.zero = Eigen::MatrixXd::Zero(3, n)};
  origin.zero.topRows(2) = s.node_positions.col(node);
  phi.zero.topRows(2) = s.shapes.middleRows(3 * node, 2);
  psi.zero.row(2) = s.shapes.row(3 * node + 2);
  const std::vector<Eigen::MatrixXd> K = find_point_stiffness(s, node);
  for (Eigen::Index k = 0; k < n; ++k) {
    origin.first.emplace_back(phi.zero.col(k));
    axes.first.emplace_back(Eigen::Matrix3d::Zero());
    axes.first.back()(1, 0) = psi.zero(2, k);
    axes.first.back()(0, 1) = -psi.zero(2, k);
    if (K.empty()) continue;
    phi.first.emplace_back(Eigen::MatrixXd::Zero(3, n));
    phi.first.back().row(0) = K[0].row(k);
    phi.first.back().row(1) = K[1].row(k);
    psi.first.emplace_back(Eigen::MatrixXd::Zero(3, n));
    psi.first.back().row(2) = K[2].row(k);
  }
  file.line(fmt::format("new node = {}", s.node_ids[static_cast<std::size_t>(node)]));
  file.line("rframe = body ref");
  file.taylor("origin", origin);
  file.taylor("phi", phi);
  file.taylor("psi", psi);
  file.taylor("AP", axes);
  file.line("end node");
}

// xx, yy, zz, xy, xz, yz.
Eigen::MatrixXd pack_tensor(const Eigen::Matrix3d& tensor) {
  Eigen::MatrixXd packed(6, 1);
  packed << tensor.diagonal(), tensor(0, 1), tensor(0, 2), tensor(1, 2);
  return packed;
}

void write_rigid(const InertiaInvariants& inertia, SidFile& file) {
  const Eigen::Index n = inertia.P.cols();
  Taylor moment{.zero = Eigen::Vector3d(inertia.first_moment.x(), inertia.first_moment.y(), 0.0)};
  Taylor tensor{.zero = pack_tensor(calc_inertia_tensor(inertia))};
  for (Eigen::Index k = 0; k < n; ++k) {
    moment.first.emplace_back(Eigen::Vector3d(inertia.P(0, k), inertia.P(1, k), 0.0));
    const Eigen::Matrix3d products = calc_linear_products(inertia, k);
    tensor.first.push_back(pack_tensor(products + products.transpose()));
  }
  file.taylor("mdCM", moment);
  file.taylor("J", tensor);
}

void write_coupling(const Superelement& s, SidFile& file) {
  const InertiaInvariants& inertia = s.inertia;
  const Stiffening stiffening(s);
  const Eigen::Index n = s.num_modes();
  Taylor Ct{.zero = Eigen::MatrixXd::Zero(n, 3)}, Cr{.zero = Eigen::MatrixXd::Zero(n, 3)};
  Ct.zero.leftCols(2) = inertia.P.transpose();
  Cr.zero.col(2) = inertia.c.transpose();
  const Eigen::MatrixXd Kx = stiffening.linear(0), Ky = stiffening.linear(1), Ka = stiffening.angular();
  for (Eigen::Index k = 0; k < n; ++k) {
    if (stiffening.is_known()) {
      Ct.first.emplace_back(Eigen::MatrixXd::Zero(n, 3));
      Ct.first.back().leftCols(2) << Kx.col(k), Ky.col(k);
    }
    Cr.first.emplace_back(Eigen::MatrixXd::Zero(n, 3));
    Cr.first.back().col(2) = inertia.B.row(k).transpose() + Ka.col(k);
  }
  file.taylor("Ct", Ct);
  file.taylor("Cr", Cr);
  file.taylor("Me", {.zero = s.mass});
}

void write_velocity_terms(const Superelement& s, bool by_mode, SidFile& file) {
  const InertiaInvariants& inertia = s.inertia;
  const Eigen::Index n = s.num_modes();
  Taylor Gr{.zero = Eigen::MatrixXd::Zero(3, 3 * n)}, Ge{.zero = Eigen::MatrixXd::Zero(n, 3 * n)},
      Oe{.zero = Eigen::MatrixXd::Zero(n, 6)};
  const Eigen::MatrixXd &xx = inertia.phi_x_phi_x, &xy = inertia.phi_x_phi_y, &yy = inertia.phi_y_phi_y;
  const Eigen::MatrixXd K = Stiffening(s).centrifugal();
  // Of ω_x², ω_y², ω_z², ω_xω_y, ω_yω_z, ω_xω_z.
  Oe.zero.leftCols(4) << -inertia.y_phi_y.transpose(), -inertia.x_phi_x.transpose(), -inertia.d.transpose(),
      (inertia.y_phi_x + inertia.x_phi_y).transpose();
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::Matrix3d products = 2.0 * calc_linear_products(inertia, k);
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      Gr.zero.col(by_mode ? 3 * k + axis : axis * n + k) = products.col(axis);
    Ge.zero.col(by_mode ? 3 * k + 2 : 2 * n + k) = -2.0 * inertia.B.col(k);
    // ∫(φ_kₓ φ_ky + φ_ky φ_kₓ): of rows j and the coordinate k.
    Oe.first.emplace_back(Eigen::MatrixXd::Zero(n, 6));
    Oe.first.back().leftCols(4) << -yy.col(k), -xx.col(k), K.col(k) - xx.col(k) - yy.col(k),
        xy.col(k) + xy.row(k).transpose();
  }
  file.taylor("Gr", Gr);
  file.taylor("Ge", Ge);
  file.taylor("Oe", Oe);
}

}  // namespace

ExportReport export_sid(const Superelement& s, const std::string& prefix, bool by_mode) {
  SidFile file(s);
  file.line("part");
  file.line("new modal = " + s.name);
  write_reference(s, file);
  file.line("frame");
  for (int node = 0; node < s.num_nodes(); ++node) write_node(s, node, file);
  file.line("end frame");
  write_rigid(s.inertia, file);
  write_coupling(s, file);
  write_velocity_terms(s, by_mode, file);
  file.taylor("ksigma", {.zero = Eigen::VectorXd::Zero(s.num_modes())});
  file.taylor("Ke", {.zero = s.stiffness});
  file.taylor("De", {.zero = s.damping});
  file.line("end modal");
  file.line("end part");
  ExportReport report{.paths = {prefix + ".SID_FEM"}, .left_out = {}};
  write_text_file(report.paths.front(), file.text());
  report.left_out = {
      "moments of inertia about x and y, which a body in the plane has not: each is half of that about z",
      "section loads (no stress matrix), deflections under loads and the certificate"};
  return report;
}

}  // namespace sprung::reduce
