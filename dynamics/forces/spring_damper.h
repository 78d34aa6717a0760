#pragma once

#include "dynamics/forces/spring_and_damper.h"

namespace sprung::dynamics {

/// Spring and damper along the line between two markers (forces, eq. 2). The deflection d = free length −
/// length is positive in compression. A positive force F = spring(d) + damper(ḋ) pushes the markers apart.
class SpringDamper final : public SpringAndDamper {
 public:
  struct Parameters {
    int marker_a = 0;
    int marker_b = 0;
    double free_length = 0.0;                     ///< > 0 [m]
    double multiplicity = 1.0;                    ///< number of them side by side, > 0
    PiecewisePolynomial spring;                   ///< F(d) [N], with its stops
    PiecewisePolynomial damper;                   ///< F(ḋ) [N]
    std::optional<double> compression_stop = {};  ///< where it begins, part of the spring's law [m]
    std::optional<double> rebound_stop = {};      ///< likewise
  };
  SpringDamper(std::string element_name, Parameters parameters)
      : SpringAndDamper(std::move(element_name)), parameters_(std::move(parameters)) {}

  const Parameters& parameters() const { return parameters_; }
  std::string_view kind() const override { return "spring-damper"; }
  std::vector<int> markers() const override { return {parameters_.marker_a, parameters_.marker_b}; }
  ElementDescription describe() const override;
  std::vector<DeflectionLaw> deflection_laws() const override {
    return {{1, &parameters_.spring, parameters_.compression_stop, parameters_.rebound_stop}};
  }
  Power add_wrenches(const Instant& instant, std::span<const int> branches,
                     std::span<Wrench> wrenches) const override;
  double calc_stored_energy(const Instant& instant, std::span<const int> branches) const override;
  std::span<const Channel> channels() const override;
  void calc_channels(const Instant& instant, std::span<const int> branches,
                     std::span<double> values) const override;

 private:
  struct Line;
  Line calc_line(const Instant& instant) const;
  Deflection calc_deflection(const Instant& instant) const override;
  const PiecewisePolynomial& spring() const override { return parameters_.spring; }
  const PiecewisePolynomial& damper() const override { return parameters_.damper; }
  double multiplicity() const override { return parameters_.multiplicity; }
  Parameters parameters_;
};

}  // namespace sprung::dynamics
