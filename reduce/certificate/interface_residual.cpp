#include "reduce/certificate/interface_residual.h"

#include <Eigen/Cholesky>
#include <complex>
#include <utility>

#include "reduce/modes/dense_eigen_solver.h"
#include "tools/support/dense/dense_solvers.h"

namespace sprung::reduce {

namespace {

Eigen::MatrixXd symmetrise(const Eigen::MatrixXd& matrix) {
  return 0.5 * (matrix + matrix.transpose());
}

// [A b; bᵀ c] in place of A.
void border(Eigen::MatrixXd& matrix, const Eigen::MatrixXd& side, const Eigen::MatrixXd& corner) {
  const Eigen::Index old = matrix.rows(), added = corner.rows();
  matrix.conservativeResize(old + added, old + added);
  matrix.topRightCorner(old, added) = side;
  matrix.bottomLeftCorner(added, old) = side.transpose();
  matrix.bottomRightCorner(added, added) = symmetrise(corner);
}

void append_columns(Eigen::MatrixXd& matrix, Eigen::MatrixXd columns) {
  if (matrix.cols() == 0) {  // long ones are not copied
    matrix.swap(columns);
    return;
  }
  matrix.conservativeResize(columns.rows(), matrix.cols() + columns.cols());
  matrix.rightCols(columns.cols()) = columns;
}

void append_rows(Eigen::MatrixXd& matrix, const Eigen::MatrixXd& rows) {
  matrix.conservativeResize(matrix.rows() + rows.rows(), rows.cols());
  matrix.bottomRows(rows.rows()) = rows;
}

void append(Eigen::VectorXd& vector, const Eigen::VectorXd& values) {
  vector.conservativeResize(vector.size() + values.size());
  vector.tail(values.size()) = values;
}

// Makes room for columns, half as many again where there is too little: long ones are seldom copied.
void make_room(Eigen::MatrixXd& matrix, Eigen::Index num_columns) {
  if (num_columns > matrix.cols()) matrix.conservativeResize(Eigen::NoChange, num_columns + num_columns / 2);
}

// Brings vectors to unit strain energy. @param forces  their K u, scaled with them
void normalise(Eigen::MatrixXd& vectors, Eigen::MatrixXd& forces) {
  const Eigen::VectorXd scale =
      vectors.cwiseProduct(forces).colwise().sum().transpose().cwiseSqrt().cwiseInverse();
  vectors *= scale.asDiagonal();
  forces *= scale.asDiagonal();
}

// Combines vectors of unit strain energy so that none shares strain energy with another: many that are added
// together depend on each other nearly, and rounding would spoil their modes. They stay as they are where
// they depend on each other to rounding. @param forces  their K u, combined with them
void separate(Eigen::MatrixXd& vectors, Eigen::MatrixXd& forces) {
  if (vectors.cols() < 2) return;
  const Eigen::LLT<Eigen::MatrixXd> factor(symmetrise(multiply_transposed(vectors, forces)));
  if (factor.info() != Eigen::Success) return;
  factor.matrixU().solveInPlace<Eigen::OnTheRight>(vectors);
  factor.matrixU().solveInPlace<Eigen::OnTheRight>(forces);
}

}  // namespace

InterfaceResidual::InterfaceResidual(const ModalProblem& problem, const StiffnessFactor& factor,
                                     const EigenPairs& exact, const Eigen::MatrixXd& loads)
    : problem_(&problem), factor_(&factor), exact_(exact.vectors), exact_omega_squared_(exact.omega_squared) {
  const Eigen::Index n = problem.size();
  if (exact_.cols() == 0) exact_.resize(n, 0);
  exact_momenta_ = exact_.cols() > 0 ? problem.times_mass(exact_) : exact_;
  loads_.resize(n, 0);
  flexible_.resize(n, 0);
  room_for_vectors_.resize(n, 0);
  room_for_second_.resize(n, 0);
  add_loads(loads);
}

void InterfaceResidual::add_loads(Eigen::MatrixXd loads) {
  const Eigen::MatrixXd share = multiply_transposed(exact_, loads);
  add_combinations(exact_momenta_, -share, loads);
  Eigen::MatrixXd flexible = loads.cols() > 0 ? factor_->solve(loads) : loads;
  const Eigen::VectorXd work = loads.cwiseProduct(flexible).colwise().sum();
  Eigen::VectorXd flexibility = work;
  for (Eigen::Index i = 0; i < exact_.cols(); ++i)
    flexibility += share.row(i).cwiseAbs2().transpose() / exact_omega_squared_(i);
  append(load_work_, work);
  append(static_flexibility_, flexibility);
  append_rows(BU_, multiply_transposed(loads, vectors()));
  append_rows(BT_, multiply_transposed(loads, second()));
  append_columns(loads_, std::move(loads));
  append_columns(flexible_, std::move(flexible));
  update_ritz();
}

void InterfaceResidual::add(Eigen::MatrixXd added) {
  add_combinations(exact_, -multiply_transposed(exact_momenta_, added), added);
  Eigen::MatrixXd forces = multiply_transposed(problem_->stiffness, added);
  normalise(added, forces);
  for (int pass = 0; pass < 2 && num_vectors() > 0; ++pass) {  // what is new of them; twice, against rounding
    const Eigen::MatrixXd coupling = multiply_transposed(this->vectors(), forces);
    add_combinations(this->vectors(), -support::solve_positive_definite(UKU_, coupling), added);
    forces = multiply_transposed(problem_->stiffness, added);
  }
  normalise(added, forces);
  separate(added, forces);
  border(UKU_, multiply_transposed(this->vectors(), forces), multiply_transposed(added, forces));
  forces.resize(0, 0);  // memory for what follows
  const Eigen::MatrixXd momenta = problem_->times_mass(added);
  const Eigen::MatrixXd second = factor_->solve(momenta);
  const Eigen::Index old = num_vectors(), width = added.cols();
  border(UMU_, multiply_transposed(this->vectors(), momenta), multiply_transposed(added, momenta));
  border(TMU_, multiply_transposed(this->second(), momenta), multiply_transposed(second, momenta));
  append_columns(BU_, multiply_transposed(loads_, added));
  append_columns(BT_, multiply_transposed(loads_, second));
  make_room(room_for_vectors_, old + width);
  make_room(room_for_second_, old + width);
  room_for_vectors_.middleCols(old, width) = added;
  room_for_second_.middleCols(old, width) = second;
  num_vectors_ += width;
  update_ritz();
}

void InterfaceResidual::update_ritz() {
  if (num_vectors() == 0) {
    omega_squared_.resize(0);
    rotation_.resize(0, 0);
    ritz_TMU_.resize(0, 0);
    ritz_BU_ = BU_;
    ritz_BT_ = BT_;
    return;
  }
  const EigenPairs pairs = solve_dense(UKU_, UMU_);
  omega_squared_ = pairs.omega_squared;
  rotation_ = pairs.vectors;
  ritz_TMU_ = rotation_.transpose() * TMU_ * rotation_;
  ritz_BU_ = BU_ * rotation_;
  ritz_BT_ = BT_ * rotation_;
}

EigenPairs InterfaceResidual::ritz() const {
  return {.omega_squared = omega_squared_, .vectors = vectors() * rotation_};
}

Eigen::MatrixXd InterfaceResidual::calc_amplitudes(double s) const {
  const Eigen::VectorXd inverse = (omega_squared_.array() - s).inverse();
  return inverse.asDiagonal() * ritz_BU_.transpose();
}

// r = B_X − (K − sM)Uy, of which K⁻¹r = Z − Uy + sTy.
Eigen::VectorXd InterfaceResidual::calc_errors(double s, const Eigen::MatrixXd& y) const {
  if (num_vectors() == 0) return load_work_.cwiseMax(0.0);
  Eigen::MatrixXd products = s * s * (ritz_TMU_ * y);
  products += (omega_squared_.array() - 2.0 * s).matrix().asDiagonal() * y;
  products += 2.0 * (s * ritz_BT_ - ritz_BU_).transpose();
  const Eigen::VectorXd changes = products.cwiseProduct(y).colwise().sum();
  return (load_work_ + changes).cwiseMax(0.0);
}

Eigen::VectorXd InterfaceResidual::calc_damped_errors(double s, double loss_factor) const {
  const std::complex<double> factor(1.0, loss_factor);
  Eigen::VectorXd errors = load_work_;
  for (Eigen::Index j = 0; j < errors.size() && num_vectors() > 0; ++j) {
    const Eigen::VectorXcd y =
        ritz_BU_.row(j).transpose().array() / (factor * omega_squared_.array() - std::complex<double>(s));
    const Eigen::VectorXcd row = (s * ritz_BT_.row(j) - factor * ritz_BU_.row(j)).transpose();
    const double linear = (row.transpose() * y).value().real();
    const Eigen::VectorXd diagonal = std::norm(factor) * omega_squared_.array() - 2.0 * s;
    const double square = y.cwiseAbs2().dot(diagonal) + s * s * y.dot(ritz_TMU_ * y).real();
    errors(j) += 2.0 * linear + square;
  }
  return errors.cwiseMax(0.0);
}

Eigen::MatrixXd InterfaceResidual::calc_load_work() const {
  return symmetrise(multiply_transposed(loads_, flexible_));
}

Eigen::MatrixXd InterfaceResidual::calc_error_matrix(const Eigen::MatrixXd& load_work, double s,
                                                     const Eigen::MatrixXd& y) const {
  if (num_vectors() == 0) return load_work;
  const Eigen::MatrixXd linear = (s * ritz_BT_ - ritz_BU_) * y;
  Eigen::MatrixXd middle = s * s * ritz_TMU_;
  middle.diagonal() += (omega_squared_.array() - 2.0 * s).matrix();
  return symmetrise(load_work + linear + linear.transpose() + y.transpose() * middle * y);
}

Eigen::VectorXd InterfaceResidual::make_vector(Eigen::Index load, double s) const {
  if (num_vectors() == 0) return flexible_.col(load);
  const Eigen::VectorXd y = rotation_ * calc_amplitudes(s).col(load);
  Eigen::VectorXd vector = flexible_.col(load);
  add_combinations(vectors(), -y, vector);
  if (s > 0.0) add_combinations(second(), s * y, vector);
  return vector;
}

}  // namespace sprung::reduce
