#pragma once

#include <Eigen/Core>

namespace sprung::reduce {

/// The relative rounding of numbers that another program printed: that of the number with the most digits,
/// and a margin of ten in the last one. At least 1e-12, since programs add up the numbers that they print;
/// that, too, where none has six digits, as 0.1 and 12.
double estimate_rounding(const Eigen::Ref<const Eigen::VectorXd>& numbers);

}  // namespace sprung::reduce
