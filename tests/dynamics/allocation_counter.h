#pragma once

namespace sprung::test {

/// Number of heap allocations by any part of the program so far: calls of malloc and related functions, which
/// `new` and Eigen use.
long num_allocations();

}  // namespace sprung::test
