#include "reduce/sensitivity/certificate_rates.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <numbers>

#include "reduce/basis/free_basis.h"
#include "reduce/certificate/interface_residual.h"
#include "reduce/modes/held_node.h"
#include "tools/support/dense/dense_solvers.h"
#include "tools/support/dense/eigenproblems.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {

namespace {

constexpr double kJustAbove = 1.0 + 1e-6;  // of the next mode's frequency: it is below
constexpr double kSolved = 1e-13;          // residual of a mode's derivative, of the norms of its forces
constexpr int kMostIterations = 2000;

}  // namespace

// Derivatives by one parameter.
struct CertificateRates::Tangent {
  const FrameRates& rates;
  const RigidMotions& rigid;
  const Eigen::MatrixXd& rigid_momenta;
  Eigen::MatrixXd mode_momenta;  // (M Φ)'
  Eigen::MatrixXd loads;         // B_X'
  Eigen::MatrixXd vectors;       // U'

  // (M − QQᵀ)' x.
  Eigen::MatrixXd times_mass(const Eigen::MatrixXd& x) const {
    const auto inverse = rigid.mass.llt();
    const Eigen::MatrixXd motion = inverse.solve(rigid_momenta.transpose() * x);
    const Eigen::MatrixXd change = inverse.solve(rates.momenta.transpose() * x - rates.rigid_mass * motion);
    return rates.mass * x - rates.momenta * motion - rigid_momenta * change;
  }
  // (K − sM)' x.
  Eigen::MatrixXd times_dynamic(double s, const Eigen::MatrixXd& x) const {
    return rates.stiffness * x - s * times_mass(x);
  }
};

CertificateRates::CertificateRates(const Design& design, const BodyMatrices& matrices) : matrices_(matrices) {
  if (design.reduction.basis != BasisKind::kFree || design.reduction.interface.empty()) return;
  const Eigen::MatrixXd unit =
      make_interface_loads(static_cast<int>(matrices.full.stiffness.rows() / 3), design.reduction.interface);
  balanced_ = balance_loads(matrices.rigid, unit);
  rigid_work_ = matrices.rigid.shapes.transpose() * unit;
  rigid_momenta_ = remove_node(matrices.rigid.momenta, design.reference_node);
  const BasisRequest request{.interface = design.reduction.interface,
                             .loads = balanced_,
                             .frame_loads = Eigen::MatrixXd::Zero(balanced_.rows(), 4),
                             .highest_hz = *design.reduction.highest_hz,
                             .tolerance = design.reduction.tolerance,
                             .all_residual = design.reduction.all_residual};
  const ModesBelow modes = calc_modes_below(matrices.free, kBandMargin * request.highest_hz);
  const FreeBodyBasis basis = make_free_basis(matrices.free, *matrices.factor, modes, request);
  shares_ = Eigen::VectorXd::Zero(balanced_.cols());
  if (std::isinf(modes.next_omega_squared)) return;  // the basis holds every motion
  const EigenPairs all =
      calc_modes_below(matrices.free, kJustAbove * calc_frequency_hz(modes.next_omega_squared)).pairs;
  const Eigen::Index k = modes.pairs.omega_squared.size(), after = all.omega_squared.size() - k;
  modes_ = modes.pairs;
  if (k == 0) modes_.vectors.resize(balanced_.rows(), 0);
  next_ = {.omega_squared = all.omega_squared.tail(after), .vectors = all.vectors.rightCols(after)};
  mode_momenta_ = k > 0 ? matrices.free.times_mass(modes_.vectors) : modes_.vectors;
  mode_loads_ = modes_.vectors.transpose() * balanced_;
  loads_ = balanced_ - mode_momenta_ * mode_loads_;
  take_steps(basis.residuals);

  InterfaceResidual residual(matrices.free, *matrices.factor, modes.pairs, balanced_);
  for (const ResidualSource& source : basis.residuals)
    residual.add(residual.make_vector(source.load, source.omega_squared));
  const double highest = std::pow(2.0 * std::numbers::pi * request.highest_hz, 2);
  set_bounds(calc_band_errors(residual, highest, modes.next_omega_squared));
  for (Eigen::Index j = 0; j < shares_.size(); ++j)
    shares_(j) = basis.certificate.interface[static_cast<std::size_t>(j)].error;
}

Eigen::VectorXd CertificateRates::calc_residual(Eigen::Index load, double s,
                                                const Eigen::VectorXd& amplitudes) const {
  const Eigen::Index m = amplitudes.size();
  return loads_.col(load) - (forces_.leftCols(m) - s * inertia_.leftCols(m)) * amplitudes;
}

// By Galerkin's condition, among the first vectors.
Eigen::VectorXd CertificateRates::calc_amplitudes(Eigen::Index load, double s,
                                                  Eigen::Index num_vectors) const {
  if (num_vectors == 0) return {};
  const auto U = vectors_.leftCols(num_vectors);
  const Eigen::MatrixXd dynamic =
      U.transpose() * (forces_.leftCols(num_vectors) - s * inertia_.leftCols(num_vectors));
  return support::solve_lu(dynamic, Eigen::VectorXd(U.transpose() * loads_.col(load)));
}

void CertificateRates::take_steps(const std::vector<ResidualSource>& sources) {
  const auto m = static_cast<Eigen::Index>(sources.size());
  vectors_.setZero(loads_.rows(), m);
  forces_ = inertia_ = vectors_;
  for (Eigen::Index i = 0; i < m; ++i) {
    Step step{.source = sources[static_cast<std::size_t>(i)], .amplitudes = {}, .overlap = {}};
    step.amplitudes = calc_amplitudes(step.source.load, step.source.omega_squared, i);
    const Eigen::VectorXd u =
        matrices_.factor->solve(calc_residual(step.source.load, step.source.omega_squared, step.amplitudes));
    step.overlap = forces_.leftCols(i).transpose() * u;
    Eigen::VectorXd fresh = u - vectors_.leftCols(i) * step.overlap;
    fresh -= modes_.vectors * (mode_momenta_.transpose() * fresh);
    step.size = std::sqrt(fresh.dot(matrices_.free.stiffness * fresh));
    vectors_.col(i) = fresh / step.size;
    forces_.col(i) = matrices_.free.stiffness * vectors_.col(i);
    inertia_.col(i) = matrices_.free.times_mass(vectors_.col(i));
    steps_.push_back(std::move(step));
  }
}

void CertificateRates::set_bounds(const BandErrors& errors) {
  for (Eigen::Index j = 0; j < loads_.cols(); ++j) {
    const BandPart& part = errors.worst_part[static_cast<std::size_t>(j)];
    Bound bound{.middle = 0.5 * (part.begin + part.end),
                .place = errors.worst_omega_squared(j),
                .end = part.end,
                .amplitudes = {},
                .solution = {}};
    bound.amplitudes = calc_amplitudes(j, bound.middle, vectors_.cols());
    const Eigen::VectorXd residual = calc_residual(j, bound.place, bound.amplitudes);
    bound.solution = matrices_.factor->solve(residual);
    bound.error = residual.dot(bound.solution);
    bounds_.push_back(std::move(bound));
  }
}

// The part of Φ' that is not of Φ: (K − ω²M) x = −(K' − ω²M')φ there, by conjugate gradients with K as
// preconditioner, which the bound (reduce/certificate, eq. 1) makes a good one. All modes at once. The matrix
// is positive definite in the complement of Φ alone, where residuals and directions are kept.
Eigen::MatrixXd CertificateRates::calc_mode_rates(const Tangent& tangent) const {
  const Eigen::MatrixXd& Phi = modes_.vectors;
  const auto diagonal = modes_.omega_squared.asDiagonal();
  const StiffnessFactor& factor = *matrices_.factor;
  const auto project = [&](Eigen::MatrixXd& forces) { forces -= mode_momenta_ * (Phi.transpose() * forces); };
  const auto precondition = [&](const Eigen::MatrixXd& forces) {
    Eigen::MatrixXd shapes = factor.solve(forces);
    shapes -= Phi * (mode_momenta_.transpose() * shapes);
    return shapes;
  };
  const auto calc_work = [](const Eigen::MatrixXd& forces,
                            const Eigen::MatrixXd& shapes) -> Eigen::RowVectorXd {
    return forces.cwiseProduct(shapes).colwise().sum();
  };
  const Eigen::MatrixXd inertia = tangent.times_mass(Phi) * diagonal,
                        stiffness = tangent.rates.stiffness * Phi;
  // Of forces that cancel, or that have no part outside of Φ, rounding is left.
  const Eigen::RowVectorXd allowed =
      kSolved * kSolved *
      (calc_work(inertia, factor.solve(inertia)) + calc_work(stiffness, factor.solve(stiffness)));
  Eigen::MatrixXd r = inertia - stiffness;
  project(r);
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(r.rows(), r.cols()), z = precondition(r), p = z;
  Eigen::RowVectorXd rz = calc_work(r, z);
  for (int iteration = 0; (rz.array() > allowed.array()).any(); ++iteration) {
    if (iteration == kMostIterations)
      throw support::NumericalError("sensitivity: the derivatives of the free modes do not converge");
    const Eigen::MatrixXd Ap = matrices_.free.stiffness * p - matrices_.free.times_mass(p) * diagonal;
    const Eigen::RowVectorXd pAp = calc_work(p, Ap);
    const Eigen::RowVectorXd step = (pAp.array() > 0.0).select(rz.cwiseQuotient(pAp), 0.0);
    x += p * step.asDiagonal();
    r -= Ap * step.asDiagonal();
    project(r);
    z = precondition(r);
    const Eigen::RowVectorXd next = calc_work(r, z);
    const Eigen::RowVectorXd turn = (rz.array() > 0.0).select(next.cwiseQuotient(rz), 0.0);
    p = z + p * turn.asDiagonal();
    rz = next;
  }
  // Of the modes themselves only what keeps ΦᵀMΦ = 1: how they mix does not matter.
  return x - 0.5 * Phi * (Phi.transpose() * tangent.times_mass(Phi));
}

// r' = B_X' − (K − sM)' U y − (K − sM) (U'y + Uy').
Eigen::VectorXd CertificateRates::calc_residual_rate(const Tangent& tangent, Eigen::Index load, double s,
                                                     const Eigen::VectorXd& amplitudes,
                                                     const Eigen::VectorXd& amplitude_rates) const {
  const Eigen::Index m = amplitudes.size();
  Eigen::VectorXd rate = tangent.loads.col(load);
  if (m == 0) return rate;
  const Eigen::VectorXd moved = tangent.vectors.leftCols(m) * amplitudes;
  rate -= tangent.times_dynamic(s, vectors_.leftCols(m) * amplitudes);
  rate -= matrices_.free.stiffness * moved - s * matrices_.free.times_mass(moved);
  rate -= (forces_.leftCols(m) - s * inertia_.leftCols(m)) * amplitude_rates;
  return rate;
}

// From Uᵀr = 0: UᵀAU y' = U'ᵀr + Uᵀ(r' without y').
Eigen::VectorXd CertificateRates::calc_amplitude_rates(const Tangent& tangent, Eigen::Index load, double s,
                                                       const Eigen::VectorXd& amplitudes) const {
  const Eigen::Index m = amplitudes.size();
  if (m == 0) return {};
  const auto U = vectors_.leftCols(m);
  const Eigen::VectorXd rate = calc_residual_rate(tangent, load, s, amplitudes, Eigen::VectorXd::Zero(m));
  const Eigen::VectorXd right =
      tangent.vectors.leftCols(m).transpose() * calc_residual(load, s, amplitudes) + U.transpose() * rate;
  return support::solve_lu(Eigen::MatrixXd(U.transpose() * (forces_.leftCols(m) - s * inertia_.leftCols(m))),
                           right);
}

// U', but for what is of U itself. That U holds nothing of Φ has to be kept: K⁻¹(K − sM) multiplies what
// rounding leaves of a mode by 1 − s/ω², for each vector again.
void CertificateRates::follow_vectors(Tangent& tangent) const {
  tangent.vectors.setZero(vectors_.rows(), vectors_.cols());
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const Step& step = steps_[i];
    const auto [load, s] = step.source;
    const auto column = static_cast<Eigen::Index>(i);
    const Eigen::VectorXd of_amplitudes = calc_amplitude_rates(tangent, load, s, step.amplitudes);
    const Eigen::VectorXd u = step.size * vectors_.col(column) + vectors_.leftCols(column) * step.overlap;
    const Eigen::VectorXd rate = matrices_.factor->solve(
        calc_residual_rate(tangent, load, s, step.amplitudes, of_amplitudes) - tangent.rates.stiffness * u);
    Eigen::VectorXd fresh = (rate - tangent.vectors.leftCols(column) * step.overlap) / step.size;
    fresh -= modes_.vectors *
             (mode_momenta_.transpose() * fresh + tangent.mode_momenta.transpose() * vectors_.col(column));
    tangent.vectors.col(column) = fresh;
  }
}

Eigen::VectorXd CertificateRates::calc_rates(const FrameRates& rates,
                                             const Eigen::VectorXd& flexibility_rate) const {
  Eigen::VectorXd share_rates = Eigen::VectorXd::Zero(shares_.size());
  if (bounds_.empty()) return share_rates;
  Tangent tangent{.rates = rates,
                  .rigid = matrices_.rigid,
                  .rigid_momenta = rigid_momenta_,
                  .mode_momenta = mode_momenta_,
                  .loads = {},
                  .vectors = {}};
  const auto inverse = matrices_.rigid.mass.llt();
  const Eigen::MatrixXd motion = inverse.solve(rigid_work_);
  tangent.loads =
      -rates.momenta * motion - rigid_momenta_ * inverse.solve(rates.rigid_work - rates.rigid_mass * motion);
  if (modes_.omega_squared.size() > 0) {
    const Eigen::MatrixXd Phi_rates = calc_mode_rates(tangent);
    const Eigen::MatrixXd share_of_modes =
        Phi_rates.transpose() * balanced_ + modes_.vectors.transpose() * tangent.loads;
    tangent.mode_momenta = tangent.times_mass(modes_.vectors) + matrices_.free.times_mass(Phi_rates);
    tangent.loads -= tangent.mode_momenta * mode_loads_ + mode_momenta_ * share_of_modes;
  }
  follow_vectors(tangent);
  const double cutoff = next_.omega_squared.mean();
  const Eigen::MatrixXd work = next_.vectors.transpose() * tangent.times_dynamic(cutoff, next_.vectors);
  const double cutoff_rate = support::calc_symmetric_eigenvalues(0.5 * (work + work.transpose()))(0);
  for (Eigen::Index j = 0; j < share_rates.size(); ++j) {
    const Bound& bound = bounds_[static_cast<std::size_t>(j)];
    if (!(bound.error > 0.0) || !(shares_(j) > 0.0)) continue;
    const Eigen::VectorXd of_amplitudes = calc_amplitude_rates(tangent, j, bound.middle, bound.amplitudes);
    const Eigen::VectorXd of_residual =
        calc_residual_rate(tangent, j, bound.place, bound.amplitudes, of_amplitudes);
    const double error_rate =
        2.0 * of_residual.dot(bound.solution) - bound.solution.dot(rates.stiffness * bound.solution);
    const double margin = 1.0 - bound.end / cutoff, margin_rate = bound.end * cutoff_rate / (cutoff * cutoff);
    share_rates(j) = shares_(j) * (error_rate / bound.error - margin_rate / margin - flexibility_rate(j));
  }
  return share_rates;
}

}  // namespace sprung::reduce
