#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "reduce/basis/basis.h"
#include "reduce/certificate/band_errors.h"
#include "reduce/reduction/body_basis.h"

namespace sprung::reduce {

/// How the matrices of the free frame change with a parameter. Freedoms are those of the held frame.
struct FrameRates {
  Eigen::SparseMatrix<double> stiffness, mass;  ///< K', M', n×n
  Eigen::MatrixXd momenta;                      ///< (M R)', n×3
  Eigen::Matrix3d rigid_mass;                   ///< M_r'
  Eigen::MatrixXd rigid_work;                   ///< (RᵀB)', 3×b
};

/// The certificate of a design's free basis, and how it changes with the frame while loads, frequencies and
/// number of its residual vectors stay (reduce/sensitivity, eqs. 5–8). The modes and vectors themselves
/// change. n freedoms, b loads, k modes, m vectors. Checked by
/// tests/reduce/sensitivity/certificate_rates_test.cpp
class CertificateRates {
 public:
  /// @param matrices  has to outlive this
  /// @throws support::NumericalError as make_superelement
  CertificateRates(const Design& design, const BodyMatrices& matrices);

  /// b, of the static flexibility: the bound of each interface freedom. None of another basis.
  const Eigen::VectorXd& shares() const { return shares_; }
  /// @param flexibility_rate  G'/G, b   @return b
  Eigen::VectorXd calc_rates(const FrameRates& rates, const Eigen::VectorXd& flexibility_rate) const;

 private:
  // A residual vector: load, frequency, amplitudes of the earlier vectors; u = K⁻¹r, of which the vector is
  // (u − U overlap) / size.
  struct Step {
    ResidualSource source;
    Eigen::VectorXd amplitudes, overlap;
    double size = 1.0;
  };
  // A load's bound: amplitudes at the middle of a part, the residual at one of its ends.
  struct Bound {
    double middle = 0.0, place = 0.0, end = 0.0;  // ω²
    Eigen::VectorXd amplitudes, solution;         // m; K⁻¹r, n
    double error = 0.0;                           // D
  };
  struct Tangent;

  void take_steps(const std::vector<ResidualSource>& sources);
  void set_bounds(const BandErrors& errors);
  Eigen::VectorXd calc_residual(Eigen::Index load, double s, const Eigen::VectorXd& amplitudes) const;
  Eigen::VectorXd calc_amplitudes(Eigen::Index load, double s, Eigen::Index num_vectors) const;
  Eigen::MatrixXd calc_mode_rates(const Tangent& tangent) const;
  Eigen::VectorXd calc_residual_rate(const Tangent& tangent, Eigen::Index load, double s,
                                     const Eigen::VectorXd& amplitudes,
                                     const Eigen::VectorXd& amplitude_rates) const;
  Eigen::VectorXd calc_amplitude_rates(const Tangent& tangent, Eigen::Index load, double s,
                                       const Eigen::VectorXd& amplitudes) const;
  void follow_vectors(Tangent& tangent) const;

  const BodyMatrices& matrices_;
  Eigen::MatrixXd rigid_momenta_, rigid_work_;  // M R, n×3; RᵀB, 3×b
  EigenPairs modes_, next_;                     // Φ; the lowest modes that the basis does not hold
  Eigen::MatrixXd mode_momenta_, mode_loads_;   // M Φ, n×k; ΦᵀB, k×b
  Eigen::MatrixXd balanced_, loads_;            // B, B_X, n×b
  Eigen::MatrixXd vectors_, forces_, inertia_;  // U, KU = I in the product UᵀKU; KU and M U, n×m
  std::vector<Step> steps_;
  std::vector<Bound> bounds_;
  Eigen::VectorXd shares_;
};

}  // namespace sprung::reduce
