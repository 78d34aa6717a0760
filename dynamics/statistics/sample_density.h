#pragma once

#include <array>
#include <limits>

namespace sprung::dynamics {

/// Judges whether the samples of a quantity are close enough for its extremes: by values in between, where
/// some are known, and by the difference of each sample from the cubic through its four neighbours
/// (statistics, "Density of outputs"). The samples come at equal intervals, other values in any order.
/// Checked by tests/dynamics/statistics/sample_density_test.cpp
class SampleDensity {
 public:
  void add_sample(double value);
  void add_between(double value);

  /// Root mean square of the differences, over that of the samples but with at least `floor` > 0 for it; 0
  /// with fewer than five samples.
  double roughness(double floor) const;
  /// Likewise by the steps from sample to sample in place of the samples, so that a change of level does not
  /// hide a vibration; the same for a sine (statistics, eq. 3). @param floor  of the steps, > 0
  double roughness_by_steps(double floor) const;
  double step_rms() const;  ///< from sample to sample; 0 with fewer than two
  /// The value that lies farthest outside of the range of the samples, if one does.
  double farthest_between() const;
  double smallest() const { return smallest_; }  ///< of the samples
  double largest() const { return largest_; }
  /// How far the farthest value lies outside, over the largest size of all, at least `floor` > 0.
  double missed(double floor) const;

  /// Saves or restores what was added.
  template <class Bytes, class Density>
  static void transfer(Bytes& bytes, Density& density) {
    for (auto& value : density.last_) bytes.transfer(value);
    bytes.transfer(density.num_samples_);
    for (auto* value :
         {&density.sum_of_differences_, &density.sum_of_squares_, &density.sum_of_steps_, &density.smallest_,
          &density.largest_, &density.smallest_between_, &density.largest_between_})
      bytes.transfer(*value);
  }

 private:
  std::array<double, 5> last_{};  // samples, the latest last
  long num_samples_ = 0;
  double sum_of_differences_ = 0.0;                   // squared, of those with four neighbours
  double sum_of_squares_ = 0.0, sum_of_steps_ = 0.0;  // of all samples; of the steps, squared
  double smallest_ = 0.0, largest_ = 0.0;
  double smallest_between_ = std::numeric_limits<double>::infinity();
  double largest_between_ = -std::numeric_limits<double>::infinity();
};

}  // namespace sprung::dynamics
