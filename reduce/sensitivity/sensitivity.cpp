#include "reduce/sensitivity/sensitivity.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>

#include "reduce/certificate/interface_loads.h"
#include "reduce/modes/clusters.h"
#include "reduce/modes/held_node.h"
#include "reduce/sensitivity/body_modes.h"
#include "reduce/sensitivity/certificate_rates.h"
#include "tools/support/dense/eigenproblems.h"

namespace sprung::reduce {

namespace {

// Responses of the free body to unit loads at rest.
struct StaticResponse {
  Eigen::MatrixXd loads;          // B, 3N×b
  Eigen::MatrixXd displacements;  // U, without rigid motion
  Eigen::MatrixXd accelerations;  // a, 3×b, of the rigid motion
};

// Derivatives of the frequencies, cluster by cluster.
Eigen::VectorXd calc_frequency_rates(const BodyModes& modes, const fem::AssembledMatrices& rates) {
  const Eigen::MatrixXd of_stiffness = rates.stiffness * modes.shapes, of_mass = rates.mass * modes.shapes;
  Eigen::VectorXd hz_rates(modes.omega_squared.size());
  for (ModeRange range; range.begin < hz_rates.size(); range.begin = range.end) {
    range = find_cluster_of(modes.cluster, range.begin);
    const Eigen::Index begin = range.begin, size = range.size();
    const double omega_squared = modes.omega_squared.segment(begin, size).mean();
    const Eigen::MatrixXd change =
        of_stiffness.middleCols(begin, size) - omega_squared * of_mass.middleCols(begin, size);
    const Eigen::MatrixXd work = modes.shapes.middleCols(begin, size).transpose() * change;
    hz_rates.segment(begin, size) = support::calc_symmetric_eigenvalues(0.5 * (work + work.transpose())) /
                                    (4.0 * std::numbers::pi * std::sqrt(omega_squared));
  }
  return hz_rates;
}

class SensitiveBody {
 public:
  SensitiveBody(const Design& design, int num_modes)
      : design_(design),
        matrices_(make_body_matrices(design)),
        free_(calc_body_modes(design, matrices_, true, num_modes)),
        clamped_(calc_body_modes(design, matrices_, false, num_modes)),
        certificate_(design, matrices_) {
    solve_static();
  }

  BodyQuantities calc_value() const {
    const Eigen::Matrix3d& mass = matrices_.rigid.mass;
    const Eigen::Vector2d first = mass.block<2, 1>(0, 2);
    return {.free_hz = free_.calc_hz(),
            .clamped_hz = clamped_.calc_hz(),
            .mass = mass(0, 0),
            .inertia = mass(2, 2) - first.squaredNorm() / mass(0, 0),
            .flexibility = static_.loads.cwiseProduct(static_.displacements).colwise().sum(),
            .certificate = certificate_.shares()};
  }

  BodyQuantities calc_derivative(const fem::BeamModelRates& model_rates) const {
    const fem::AssembledMatrices rates = fem::assemble_rates(design_.model, model_rates);
    Eigen::MatrixXd rigid_rates = Eigen::MatrixXd::Zero(rates.mass.rows(), 3);
    for (Eigen::Index node = 0; node < model_rates.node_positions.cols(); ++node) {
      const Eigen::Vector2d change =
          model_rates.node_positions.col(node) - model_rates.node_positions.col(design_.reference_node);
      rigid_rates.block<2, 1>(3 * node, 2) << -change.y(), change.x();
    }
    const Eigen::MatrixXd momenta = rates.mass * matrices_.rigid.shapes;
    const Eigen::Matrix3d half = rigid_rates.transpose() * matrices_.rigid.momenta;
    const Eigen::Matrix3d mass_rate = matrices_.rigid.shapes.transpose() * momenta + half + half.transpose();
    const Eigen::Matrix3d& mass = matrices_.rigid.mass;
    const Eigen::Vector2d first = mass.block<2, 1>(0, 2), first_rate = mass_rate.block<2, 1>(0, 2);
    const Eigen::VectorXd flexibility_rates = calc_flexibility_rates(rates, momenta, rigid_rates);
    return {.free_hz = calc_frequency_rates(free_, rates),
            .clamped_hz = calc_frequency_rates(clamped_, rates),
            .mass = mass_rate(0, 0),
            .inertia = mass_rate(2, 2) - 2.0 * first.dot(first_rate) / mass(0, 0) +
                       first.squaredNorm() * mass_rate(0, 0) / (mass(0, 0) * mass(0, 0)),
            .flexibility = flexibility_rates,
            .certificate = calc_certificate_rates(rates, momenta, rigid_rates, flexibility_rates)};
  }

  ElementShares calc_shares() const {
    const fem::BeamModel& model = design_.model;
    const Eigen::Index k = free_.shapes.cols();
    ElementShares shares{Eigen::MatrixXd(model.mesh.num_elements(), k),
                         Eigen::MatrixXd(model.mesh.num_elements(), k)};
    for (int e = 0; e < model.mesh.num_elements(); ++e) {
      const fem::Mesh::Element& nodes = model.mesh.elements[static_cast<std::size_t>(e)];
      const fem::BeamElement element = fem::make_element(model, e);
      Eigen::MatrixXd ends(6, k);
      ends << free_.shapes.middleRows<3>(3 * nodes.first), free_.shapes.middleRows<3>(3 * nodes.second);
      shares.strain.row(e) = ends.cwiseProduct(fem::calc_stiffness(element) * ends).colwise().sum();
      shares.kinetic.row(e) = ends.cwiseProduct(fem::calc_mass(element) * ends).colwise().sum();
    }
    shares.strain *= free_.omega_squared.cwiseInverse().asDiagonal();
    return shares;
  }

 private:
  void solve_static() {
    const std::vector<InterfaceFreedom>& interface = design_.reduction.interface;
    const RigidMotions& rigid = matrices_.rigid;
    static_.loads = make_interface_loads(design_.model.mesh.num_nodes(), interface);
    static_.accelerations = rigid.mass.llt().solve(rigid.shapes.transpose() * static_.loads);
    if (interface.empty()) {
      static_.displacements = static_.loads;
      return;
    }
    const Eigen::MatrixXd held = matrices_.factor->solve(balance_loads(rigid, static_.loads));
    static_.displacements = remove_momentum(rigid, insert_node(held, design_.reference_node));
  }

  // G = uᵀKu with Ku = b − MRa, a = M_r⁻¹Rᵀb and uᵀMR = 0: dG = −uᵀdKu − 2uᵀ(dM R + M dR)a.
  Eigen::VectorXd calc_flexibility_rates(const fem::AssembledMatrices& rates, const Eigen::MatrixXd& momenta,
                                         const Eigen::MatrixXd& rigid_rates) const {
    const Eigen::MatrixXd& U = static_.displacements;
    const Eigen::MatrixXd stiffness = rates.stiffness * U;
    const Eigen::MatrixXd inertia = (momenta + matrices_.full.mass * rigid_rates) * static_.accelerations;
    return -U.cwiseProduct(stiffness + 2.0 * inertia).colwise().sum();
  }

  Eigen::VectorXd calc_certificate_rates(const fem::AssembledMatrices& rates, const Eigen::MatrixXd& momenta,
                                         const Eigen::MatrixXd& rigid_rates,
                                         const Eigen::VectorXd& flexibility_rates) const {
    if (certificate_.shares().size() == 0) return {};
    const Eigen::MatrixXd half = rigid_rates.transpose() * matrices_.rigid.momenta;
    const Eigen::VectorXd flexibility = static_.loads.cwiseProduct(static_.displacements).colwise().sum();
    const int node = design_.reference_node;
    const Eigen::MatrixXd momenta_rate = momenta + matrices_.full.mass * rigid_rates;
    return certificate_.calc_rates(
        {.stiffness = remove_node(rates.stiffness, node),
         .mass = remove_node(rates.mass, node),
         .momenta = remove_node(momenta_rate, node),
         .rigid_mass = matrices_.rigid.shapes.transpose() * momenta + half + half.transpose(),
         .rigid_work = rigid_rates.transpose() * static_.loads},
        (flexibility.array() > 0.0).select(flexibility_rates.cwiseQuotient(flexibility), 0.0));
  }

  const Design& design_;
  BodyMatrices matrices_;
  BodyModes free_, clamped_;
  CertificateRates certificate_;
  StaticResponse static_;
};

}  // namespace

DesignSensitivity calc_sensitivity(const Design& design, std::vector<DesignParameter> parameters,
                                   int num_modes) {
  const SensitiveBody body(design, num_modes);
  DesignSensitivity sensitivity{.value = body.calc_value(), .parameters = {}, .shares = body.calc_shares()};
  for (DesignParameter& parameter : parameters) {
    BodyQuantities derivative = body.calc_derivative(parameter.rates);
    sensitivity.parameters.push_back({std::move(parameter), std::move(derivative)});
  }
  return sensitivity;
}

}  // namespace sprung::reduce
