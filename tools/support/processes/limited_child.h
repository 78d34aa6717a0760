#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace sprung::support {

/// What a child process may use.
struct ChildLimits {
  unsigned processor_seconds = 120;  ///< the time limit by the wall's clock is ten times as long
  std::size_t memory_bytes = std::size_t{4} << 30U;  ///< address space beyond what this process has
};

/// Why a child process gave no result: an exception of the work (its own words), a crash, or a limit.
class ChildFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Runs work in a child process: for libraries that crash, hang or ask for all memory when their input is
/// damaged.
///
/// The child reads an empty standard input, prints nothing, writes no files and leaves no core file. It ends
/// without destructors of static objects, and at once when this process is killed. The calling process should
/// have one thread only: the others do not live on in the child, and the locks that they hold stay locked.
///
/// @param name    of the library, for messages
/// @param work    returns its result as bytes; what else it changes stays in the child
/// @return the bytes. They come from a process that may have been damaged by its input: check them.
/// @throws ChildFailure
/// Checked by tests/tools/support/limited_child_test.cpp
std::string run_in_limited_child(std::string_view name, const std::function<std::string()>& work,
                                 const ChildLimits& limits);

}  // namespace sprung::support
