#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "fem/beam_model.h"
#include "reduce/certificate/interface_loads.h"
#include "reduce/design/design.h"
#include "reduce/superelement/superelement.h"

namespace sprung::reduce::testing {

/// The full finite element model of a free body, solved directly and densely: what reduced bodies are
/// compared with.
class FreeBodyTruth {
 public:
  explicit FreeBodyTruth(const fem::BeamModel& model);

  /// Elastic flexibility of unit loads: Bᵀ of the response to them without rigid motion, for the stiffness
  /// (1 + i loss_factor) K. @return b×b
  Eigen::MatrixXcd calc_flexibility(double omega_squared, const std::vector<InterfaceFreedom>& interface,
                                    double loss_factor = 0.0) const;
  Eigen::MatrixXd calc_flexibility_at_rest(const std::vector<InterfaceFreedom>& interface) const;

  /// Frequencies of the elastic modes, ascending [Hz].
  Eigen::VectorXd calc_frequencies() const;
  /// ω² and M-normalised shapes, the three rigid ones first.
  const Eigen::VectorXd& omega_squared() const { return omega_squared_; }
  const Eigen::MatrixXd& shapes() const { return shapes_; }

  const Eigen::MatrixXd& stiffness() const { return K_; }
  const Eigen::MatrixXd& mass() const { return M_; }
  const Eigen::MatrixXd& rigid() const { return R_; }  ///< 3N×3, about the mesh's origin

 private:
  Eigen::MatrixXd K_, M_, R_, shapes_;
  Eigen::VectorXd omega_squared_;
};

/// Whether ω² is so near to that of a free mode that its flexibility is lost in rounding.
bool is_resonance(const FreeBodyTruth& truth, double omega_squared);

/// Elastic flexibility of a superelement at its interface, from its file's values alone. @return b×b
Eigen::MatrixXd calc_flexibility(const Superelement& superelement, double omega_squared);

/// Freedoms of nodes, all three of each. Names the nodes "p0", "p1" … in the model.
std::vector<InterfaceFreedom> make_interface(fem::BeamModel& model, const std::vector<int>& nodes,
                                             const std::vector<int>& freedoms = {0, 1, 2});

/// A frame of random members, some of them in closed loops, with random sections and point masses.
fem::BeamModel make_random_frame(std::uint64_t seed);

/// A design for the basis "free" of a random frame, with a random interface and band.
Design make_random_design(std::uint64_t seed, double tolerance);

/// A ladder frame of 6 m with eight points for stiff joints, and its interface of 16 freedoms.
struct LadderFrame {
  fem::BeamModel model;
  std::vector<InterfaceFreedom> interface;
  Eigen::Vector2d reference;
};
LadderFrame make_ladder_frame();

}  // namespace sprung::reduce::testing
