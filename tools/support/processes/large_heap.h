#pragma once

#include <cstddef>

namespace sprung::support {

/// Prepares this process for calculations with large arrays. From now on memory that is freed stays in the
/// process, so that the system clears it once and not for each array, and the next `bytes` of it come in huge
/// pages where the system offers them. Address space is taken at once, memory only as it is used. Where the
/// system refuses, or has no such means, memory comes as before.
/// Checked by tests/tools/support/large_heap_test.cpp
void prepare_large_heap(std::size_t bytes);

}  // namespace sprung::support
