#pragma once

namespace sprung::test {

/// Number of times any part of the program has asked for heap memory so far: malloc and its relatives, which
/// `new` and Eigen both end in.
long num_allocations();

}  // namespace sprung::test
