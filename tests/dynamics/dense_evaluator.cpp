#include "tests/dynamics/dense_evaluator.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "dynamics/joints/revolute_joint.h"

namespace sprung::test {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

namespace {

// A(θ) and its derivatives by θ, order 0 to 2.
Matrix2d rotation(double theta, int order) {
  const double angle = theta + 0.5 * std::numbers::pi * order;  // d/dθ turns by a right angle
  Matrix2d A;
  A << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  return A;
}

}  // namespace

DenseEvaluator::DenseEvaluator(const dynamics::Model& model) : model_(&model) {
  for (const auto& joint : model.joints) {
    if (dynamic_cast<const dynamics::RevoluteJoint*>(joint.get()) == nullptr) {
      throw std::invalid_argument("DenseEvaluator: unknown kind of joint: " + joint->name);
    }
  }
  for (const auto& force : model.forces) {
    const auto* spring = dynamic_cast<const dynamics::SpringDamper*>(force.get());
    const auto* tyre = dynamic_cast<const dynamics::PointContactTyre*>(force.get());
    if (spring != nullptr)
      springs_.push_back(spring);
    else if (tyre != nullptr)
      tyres_.push_back(tyre);
    else
      throw std::invalid_argument("DenseEvaluator: unknown kind of force: " + force->name);
  }
  for (const dynamics::Body& body : model.bodies) {
    const Index size = body.num_coordinates();
    BodyTerms terms;
    terms.M = MatrixXd::Zero(size, size);
    terms.dM.assign(static_cast<std::size_t>(size - 2), terms.M);
    terms.momentum = terms.product = terms.q = terms.v = VectorXd::Zero(size);
    bodies_.push_back(terms);
  }
  for (const dynamics::Marker& marker : model.markers) {
    Point point;
    point.r = marker.p_BP;
    point.v = point.bias = Vector2d::Zero();
    if (marker.body != dynamics::kGround) {
      const dynamics::Body& body = model.bodies[static_cast<std::size_t>(marker.body)];
      point.first = body.first_coordinate;
      point.J = MatrixXd::Zero(2, body.num_coordinates());
    }
    points_.push_back(point);
  }
  const Index nq = model.num_coordinates, m = model.num_constraints;
  Phi_q_ = MatrixXd::Zero(m, nq);
  Phi_d_ = MatrixXd::Zero(m, m);
  augmented_ = MatrixXd::Zero(nq + m, nq + m);
  phi_ = gamma_ = correction_ = lambda_ = VectorXd::Zero(m);
  Q_ = v_dot_ = VectorXd::Zero(nq);
  right_side_ = solution_ = VectorXd::Zero(nq + m);
  lu_ = Eigen::PartialPivLU<MatrixXd>(nq + m);
  lu_d_ = Eigen::PartialPivLU<MatrixXd>(m);
}

// r = R + A (p + Φη) and its gradient.
void DenseEvaluator::update_points(const VectorXd& q) {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    Point& point = points_[i];
    if (point.first < 0) continue;
    const dynamics::Marker& marker = model_->markers[i];
    const Index n = marker.Phi.cols();
    const double theta = q[point.first + 2];
    Vector2d u = marker.p_BP;
    u.noalias() += marker.Phi.topRows<2>() * q.segment(point.first + 3, n);
    point.J.leftCols<2>().setIdentity();
    point.J.col(2) = rotation(theta, 1) * u;
    point.J.rightCols(n).noalias() = rotation(theta, 0) * marker.Phi.topRows<2>();
    point.r = q.segment<2>(point.first) + rotation(theta, 0) * u;
    point.bias = u;  // kept for the velocities
  }
}

// v = J v, and J̇ v: what the acceleration is while the coordinates' accelerations are zero. After
// update_points.
void DenseEvaluator::update_point_velocities(const VectorXd& v) {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    Point& point = points_[i];
    if (point.first < 0) continue;
    const Index n = point.J.cols() - 3;
    const double theta_dot = v[point.first + 2];
    point.v.noalias() = point.J * v.segment(point.first, 3 + n);
    Vector2d bending = Vector2d::Zero();  // A Φ η̇
    bending.noalias() += point.J.rightCols(n) * v.segment(point.first + 3, n);
    Matrix2d quarter_turn;
    quarter_turn << 0.0, -1.0, 1.0, 0.0;
    const Vector2d radius = -(quarter_turn * point.J.col(2));  // A (p + Φη)
    point.bias = -theta_dot * theta_dot * radius + 2.0 * theta_dot * (quarter_turn * bending);
  }
}

// Revolute joints: φ = r_a − r_b.
void DenseEvaluator::update_constraints() {
  Phi_q_.setZero();
  Index row = 0;
  for (const auto& joint : model_->joints) {
    const Point& a = point(joint->marker_a);
    const Point& b = point(joint->marker_b);
    phi_.segment<2>(row) = a.r - b.r;
    if (a.first >= 0) Phi_q_.block(row, a.first, 2, a.J.cols()) += a.J;
    if (b.first >= 0) Phi_q_.block(row, b.first, 2, b.J.cols()) -= b.J;
    row += 2;
  }
}

bool DenseEvaluator::solve_positions(std::span<const int> dependent, VectorXd& q) {
  for (int iteration = 0; iteration < 30; ++iteration) {
    update_points(q);
    update_constraints();
    if (phi_.size() == 0 || phi_.cwiseAbs().maxCoeff() <= 1e-12 * model_->length_scale) return true;
    for (std::size_t k = 0; k < dependent.size(); ++k)
      Phi_d_.col(static_cast<Index>(k)) = Phi_q_.col(dependent[k]);
    lu_d_.compute(Phi_d_);
    correction_ = lu_d_.solve(phi_);
    for (std::size_t k = 0; k < dependent.size(); ++k) q[dependent[k]] -= correction_[static_cast<Index>(k)];
  }
  return false;
}

void DenseEvaluator::solve_velocities(std::span<const int> dependent, const VectorXd& q, VectorXd& v) {
  if (phi_.size() == 0) return;
  update_points(q);
  update_constraints();
  for (std::size_t k = 0; k < dependent.size(); ++k) {
    Phi_d_.col(static_cast<Index>(k)) = Phi_q_.col(dependent[k]);
    v[dependent[k]] = 0.0;
  }
  lu_d_.compute(Phi_d_);
  gamma_.noalias() = -Phi_q_ * v;
  correction_ = lu_d_.solve(gamma_);
  for (std::size_t k = 0; k < dependent.size(); ++k) v[dependent[k]] = correction_[static_cast<Index>(k)];
}

// M(q) and its derivatives by θ and η, from T = ½∫ ṙ·ṙ dm with ṙ = Ṙ + A′u θ̇ + AΦη̇.
void DenseEvaluator::calc_body(std::size_t b) {
  const dynamics::Body& body = model_->bodies[b];
  BodyTerms& terms = bodies_[b];
  const Index n = body.num_modes();
  const double theta = terms.q[2];
  const Matrix2d A = rotation(theta, 0), A1 = rotation(theta, 1), A2 = rotation(theta, 2);
  Vector2d s = body.first_moment;  // ∫ u dm
  s.noalias() += body.P * terms.q.tail(n);

  const auto set = [](MatrixXd& matrix, Index i, Index j, double value) {
    matrix(i, j) = matrix(j, i) = value;
  };
  MatrixXd& M = terms.M;
  MatrixXd& M_theta = terms.dM[0];
  M(0, 0) = M(1, 1) = body.mass;
  M(2, 2) = body.second_moment;
  for (Index i = 0; i < 2; ++i) {
    set(M, i, 2, A1.row(i).dot(s));
    set(M_theta, i, 2, A2.row(i).dot(s));
  }
  for (Index j = 0; j < n; ++j) {
    MatrixXd& M_eta = terms.dM[static_cast<std::size_t>(1 + j)];
    const Vector2d P = body.P.col(j);
    double M_theta_j = body.c[j];
    double half_growth = body.d[j];  // ½ ∂M_θθ/∂η_j
    for (Index i = 0; i < n; ++i) {
      M_theta_j += terms.q[3 + i] * body.B(i, j);
      half_growth += body.M_tt(j, i) * terms.q[3 + i];
      M(3 + i, 3 + j) = body.M_ff(i, j);
      set(M_eta, 2, 3 + i, body.B(j, i));
    }
    for (Index i = 0; i < 2; ++i) {
      set(M, i, 3 + j, A.row(i).dot(P));
      set(M_theta, i, 3 + j, A1.row(i).dot(P));
      set(M_eta, i, 2, A1.row(i).dot(P));
    }
    set(M, 2, 3 + j, M_theta_j);
    M_eta(2, 2) = 2.0 * half_growth;
    M(2, 2) += terms.q[3 + j] * (half_growth + body.d[j]);
  }
}

// M into the system; Q_v, weight, stiffness and damping into Q.
void DenseEvaluator::add_body(std::size_t b) {
  const dynamics::Body& body = model_->bodies[b];
  BodyTerms& terms = bodies_[b];
  const Index first = body.first_coordinate, size = body.num_coordinates(), n = body.num_modes();
  calc_body(b);
  augmented_.block(first, first, size, size) = terms.M;
  terms.momentum.noalias() = terms.M * terms.v;
  kinetic_energy_ += 0.5 * terms.v.dot(terms.momentum);
  for (std::size_t k = 0; k < terms.dM.size(); ++k) {
    const Index coordinate = static_cast<Index>(k) + 2;
    terms.product.noalias() = terms.dM[k] * terms.v;
    Q_.segment(first, size) -= terms.v[coordinate] * terms.product;
    Q_[first + coordinate] += 0.5 * terms.v.dot(terms.product);
  }
  // Potential −g·∫r dm = −g·(m R + A s): M_Rθ = A′s and M_Rη = AP are its gradient's columns.
  for (Index i = 0; i < 2; ++i) {
    for (Index j = 0; j < size; ++j) Q_[first + j] += model_->gravity[i] * terms.M(i, j);
  }
  Q_.segment(first + 3, n).noalias() -= body.stiffness * terms.q.tail(n);
  Q_.segment(first + 3, n).noalias() -= body.damping * terms.v.tail(n);
}

void DenseEvaluator::push(int marker, const Vector2d& force) {
  const Point& at = point(marker);
  if (at.first >= 0) Q_.segment(at.first, at.J.cols()).noalias() += at.J.transpose() * force;
}

void DenseEvaluator::add_spring_damper(const dynamics::SpringDamper::Parameters& parameters) {
  const Point& a = point(parameters.marker_a);
  const Point& b = point(parameters.marker_b);
  const Vector2d span = b.r - a.r;
  const double length = std::sqrt(span.dot(span));
  const double deflection = parameters.free_length - length;
  const double rate = -span.dot(b.v - a.v) / length;
  const double force = parameters.spring.value(deflection) + parameters.damper.value(rate);
  push(parameters.marker_b, parameters.multiplicity * force / length * span);
  push(parameters.marker_a, -parameters.multiplicity * force / length * span);
}

void DenseEvaluator::add_tyre(const dynamics::PointContactTyre& tyre) {
  const dynamics::PointContactTyre::Parameters& parameters = tyre.parameters();
  const dynamics::PlacedRoad& placed = tyre.road();
  const Point& wheel = point(parameters.marker);
  const double s = placed.direction * wheel.r.x() - placed.origin;
  int segment = 0;
  while (segment + 1 < placed.road->num_segments() && placed.road->segment_end(segment) <= s) ++segment;
  const dynamics::RoadSample road = placed.road->sample(segment, s);
  const double penetration = parameters.radius + road.height - wheel.r.y();
  if (parameters.one_sided && penetration <= 0.0) return;
  const double rate = road.slope * placed.direction * wheel.v.x() - wheel.v.y();
  double force = parameters.spring.value(penetration) + parameters.damping * rate;
  if (parameters.one_sided) force = std::max(0.0, force);
  push(parameters.marker, {0.0, parameters.multiplicity * force});
}

void DenseEvaluator::solve_accelerations(const VectorXd& q, const VectorXd& v) {
  update_points(q);
  update_point_velocities(v);
  update_constraints();
  Q_.setZero();
  kinetic_energy_ = 0.0;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const Index first = model_->bodies[b].first_coordinate, size = model_->bodies[b].num_coordinates();
    bodies_[b].q = q.segment(first, size);
    bodies_[b].v = v.segment(first, size);
    add_body(b);
  }
  for (const dynamics::SpringDamper* spring : springs_) add_spring_damper(spring->parameters());
  for (const dynamics::PointContactTyre* tyre : tyres_) add_tyre(*tyre);

  Index row = 0;
  for (const auto& joint : model_->joints) {
    gamma_.segment<2>(row) = point(joint->marker_b).bias - point(joint->marker_a).bias;
    row += 2;
  }
  const Index nq = model_->num_coordinates, m = model_->num_constraints;
  augmented_.bottomLeftCorner(m, nq) = Phi_q_;
  augmented_.topRightCorner(nq, m) = Phi_q_.transpose();
  right_side_.head(nq) = Q_;
  right_side_.tail(m) = gamma_;
  lu_.compute(augmented_);
  solution_ = lu_.solve(right_side_);
  v_dot_ = solution_.head(nq);
  lambda_ = solution_.tail(m);
}

}  // namespace sprung::test
