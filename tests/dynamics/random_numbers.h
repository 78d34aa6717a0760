#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace sprung::test {

/// Uniform numbers from a fixed seed, the same on every machine.
/// Source: [Steele, Lea & Flood 2014], splitmix64
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : state_(seed) {}

  double between(double low, double high) {
    state_ += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    z ^= z >> 31;
    return low + (high - low) * static_cast<double>(z >> 11) * 0x1.0p-53;
  }
  /// Of either sign, and never near zero.
  double size_up_to(double largest) {
    const double value = between(-largest, largest);
    return value + (value < 0.0 ? -0.05 : 0.05) * largest;
  }
  Eigen::VectorXd vector(Eigen::Index size, double largest) {
    Eigen::VectorXd values(size);
    for (double& value : values) value = size_up_to(largest);
    return values;
  }

 private:
  std::uint64_t state_;
};

}  // namespace sprung::test
