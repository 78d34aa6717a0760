#include "reduce/export/mass_points.h"

#include <cmath>
#include <complex>
#include <optional>
#include <stdexcept>

#include "tools/support/dense/eigenproblems.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {

namespace {

using Complex = std::complex<double>;

constexpr double kRounding = 1e-13;  // eigenvalues below this share of the largest are rounding
constexpr double kNegative = 1e-9;   // and below minus this, of no mass

template <typename Pairs>
Pairs expect(std::optional<Pairs> pairs) {
  if (!pairs) throw support::NumericalError("mass points: a matrix of inertia has no eigenvalues");
  return *std::move(pairs);
}
support::SymmetricEigenpairs solve(const Eigen::MatrixXd& A) {
  return expect(support::solve_symmetric(A));
}
support::HermitianEigenpairs solve(const Eigen::MatrixXcd& A) {
  return expect(support::solve_hermitian(A));
}

// The eigenvalues above rounding, and their vectors, of a semidefinite matrix whose rows and columns are
// divided by `size`, so that its diagonal is 1.
template <typename Matrix>
struct ScaledPairs {
  Eigen::VectorXd size, values;
  Matrix vectors;
};

template <typename Matrix>
ScaledPairs<Matrix> solve_scaled(const Matrix& A) {
  const Eigen::VectorXd size =
      A.diagonal().real().unaryExpr([](double x) { return x > 0.0 ? std::sqrt(x) : 1.0; });
  const Matrix scaled = A.array() / (size * size.transpose()).array();
  const auto [values, vectors] = solve(scaled);  // ascending
  const double largest = values(values.size() - 1);
  if (values(0) < -kNegative * largest)
    throw std::domain_error("find_mass_points: no masses have these integrals");
  const Eigen::Index rank = (values.array() > kRounding * largest).count();
  return {.size = size, .values = values.tail(rank), .vectors = vectors.rightCols(rank)};
}

// W with A = W Wᴴ, all of whose entries in the first row are equal (reduce/export, eq. 3). A is Hermitian.
template <typename Matrix>
Matrix factor_with_equal_row(const Matrix& A) {
  using Scalar = typename Matrix::Scalar;
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
  const ScaledPairs<Matrix> pairs = solve_scaled(A);
  const Eigen::Index rank = pairs.values.size();
  Matrix W = pairs.vectors.array() * (pairs.size * pairs.values.cwiseSqrt().transpose()).array();
  // A reflection of the row onto equal entries. A common phase makes the product of both real.
  const Vector equal = Vector::Constant(rank, W.row(0).norm() / std::sqrt(static_cast<double>(rank)));
  const Scalar product = (W.row(0) * equal).value();
  if (std::abs(product) > 0.0) W *= std::abs(product) / product;
  const Vector v = W.row(0).adjoint() - equal;
  if (v.norm() > kRounding * equal.norm()) W -= (W * v).eval() * (2.0 / v.squaredNorm()) * v.adjoint();
  return W;
}

// The moment of inertia of rotary inertia alone, which the integrals do not tell: at least `least`, what the
// others need, and at most what leaves enough to the masses (reduce/export, eq. 5).
double choose_rotary_inertia(const InertiaInvariants& inertia, double least, const Eigen::MatrixXcd& A) {
  // What the masses need, which are displaced by 1 and by the modes as the body is.
  Eigen::MatrixXcd others(A.rows() - 1, A.cols() - 1);
  others(0, 0) = A(0, 0);
  others.row(0).tail(A.cols() - 2) = A.row(0).tail(A.cols() - 2);
  others.col(0).tail(A.rows() - 2) = A.col(0).tail(A.rows() - 2);
  others.bottomRightCorner(A.rows() - 2, A.cols() - 2) = A.bottomRightCorner(A.rows() - 2, A.cols() - 2);
  Eigen::VectorXcd moments(A.rows() - 1);
  moments << A(0, 1), A.col(1).tail(A.rows() - 2);
  const ScaledPairs<Eigen::MatrixXcd> pairs = solve_scaled(others);
  moments.array() /= pairs.size.array();
  const double needed =
      ((pairs.vectors.adjoint() * moments).cwiseAbs2().array() / pairs.values.array()).sum();
  return least + std::max(0.5 * (inertia.second_moment - least - needed), kNegative * inertia.second_moment);
}

// The transpose of the integrals of (1, r, φ), of complex numbers x + i y (reduce/export, eqs. 1, 2); J₀ as
// if there was no rotary inertia.
Eigen::MatrixXcd make_products(const InertiaInvariants& inertia) {
  const Eigen::Index n = inertia.P.cols();
  const Complex i(0.0, 1.0);
  Eigen::MatrixXcd H = Eigen::MatrixXcd::Zero(2 + n, 2 + n);
  H(0, 0) = inertia.mass;
  H(1, 1) = inertia.second_moment;
  H(0, 1) = Complex(inertia.first_moment.x(), inertia.first_moment.y());
  H.row(0).tail(n) = inertia.P.row(0) + i * inertia.P.row(1);
  H.row(1).tail(n) = inertia.d + i * (inertia.x_phi_y - inertia.y_phi_x);
  H.bottomRightCorner(n, n) = inertia.phi_x_phi_x + inertia.phi_y_phi_y + i * inertia.B;
  H.col(0).tail(n + 1) = H.row(0).tail(n + 1).adjoint();
  H.col(1).tail(n) = H.row(1).tail(n).adjoint();
  return H.transpose();
}

// The integrals of (1, ψ) over rotary inertia (reduce/export, eq. 4), with the least moment of inertia; empty
// without rotary inertia.
Eigen::MatrixXd make_rotary_products(const InertiaInvariants& inertia) {
  const Eigen::Index n = inertia.P.cols();
  const Eigen::MatrixXd R = inertia.M_ff - inertia.phi_x_phi_x - inertia.phi_y_phi_y;
  const Eigen::RowVectorXd momentum = inertia.c - (inertia.x_phi_y - inertia.y_phi_x);
  if (R.norm() <= 1e-12 * inertia.M_ff.norm()) return {};
  const auto [values, vectors] = solve(R);
  const Eigen::VectorXd share = vectors.transpose() * momentum.transpose();
  double least = 0.0;
  for (Eigen::Index k = 0; k < n; ++k) {
    if (values(k) > kRounding * values(n - 1)) least += share(k) * share(k) / values(k);
  }
  Eigen::MatrixXd products(n + 1, n + 1);
  products << least, momentum, momentum.transpose(), R;
  return products;
}

}  // namespace

MassPoints find_mass_points(const InertiaInvariants& inertia) {
  const Eigen::Index n = inertia.P.cols();
  Eigen::MatrixXcd A = make_products(inertia);
  Eigen::MatrixXd rotary = make_rotary_products(inertia);
  MassPoints points;
  if (rotary.size() > 0) {
    rotary(0, 0) = choose_rotary_inertia(inertia, rotary(0, 0), A);
    A(1, 1) -= rotary(0, 0);
    const Eigen::MatrixXd W = factor_with_equal_row(rotary);
    points.inertia = W.row(0).array().square().transpose();
    points.rotation = (W.bottomRows(n) / W(0, 0)).transpose();
  } else {
    points.rotation.resize(0, n);
  }
  const Eigen::MatrixXcd W = factor_with_equal_row(A);
  const double root = W(0, 0).real();
  points.mass = Eigen::VectorXd::Constant(W.cols(), root * root);
  points.position.resize(2, W.cols());
  points.position << W.row(1).real() / root, W.row(1).imag() / root;
  points.shape_x = W.bottomRows(n).real().transpose() / root;
  points.shape_y = W.bottomRows(n).imag().transpose() / root;
  return points;
}

}  // namespace sprung::reduce
