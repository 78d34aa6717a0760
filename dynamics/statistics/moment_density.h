#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/section_loads/body_sections.h"
#include "dynamics/statistics/sample_density.h"

namespace sprung::dynamics {

/// Judges whether the outputs are close enough for the bending moments along a body, by the mean moment of
/// each element, from the loads where there is one: its change since the first output (statistics, "Density
/// of outputs"). Checked by tests/verification/supported_beam_test.py
class MomentDensity {
 public:
  explicit MomentDensity(const BodySections& body);

  void add_output(const BodySections& body);   ///< at which `body` is up to date
  void add_between(const BodySections& body);  ///< likewise between two outputs

  const std::vector<SampleDensity>& elements() const { return elements_; }  ///< changes [N·m]
  /// Changes from output to output below this one are not judged [N·m]; 0 where there are none.
  double floor() const;

  template <class Bytes, class Density>
  static void transfer(Bytes& bytes, Density& density) {
    for (auto& element : density.elements_) SampleDensity::transfer(bytes, element);
    for (Eigen::Index i = 0; i < density.first_.size(); ++i) bytes.transfer(density.first_[i]);
    bytes.transfer(density.largest_);
    bytes.transfer(density.num_outputs_);
  }

 private:
  std::vector<SampleDensity> elements_;
  Eigen::VectorXd first_;  // moments at the first output [N·m]
  double largest_ = 0.0;   // size of a moment
  long num_outputs_ = 0;
  Eigen::VectorXd moments_;
};

}  // namespace sprung::dynamics
