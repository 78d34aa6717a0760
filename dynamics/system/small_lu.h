#pragma once

#include <span>
#include <vector>

namespace sprung::dynamics {

/// LU factors with partial pivoting of a small dense matrix, in storage that is kept: below some 50 rows plain loops
/// are several times faster than a blocked library.
class SmallLu {
 public:
  explicit SmallLu(int size);
  int size() const { return size_; }
  std::span<double> matrix() { return lu_; }  ///< row-major; fill before `factorise`
  void factorise();
  /// x ← A⁻¹ x
  void solve(double* x) const;
  double determinant() const { return determinant_; }

 private:
  int size_;
  std::vector<double> lu_;
  std::vector<int> pivots_;
  double determinant_ = 1.0;
};

}  // namespace sprung::dynamics
