#pragma once

namespace sprung::reduce {

/// Version of the program, as the build declares it.
const char* get_program_version();

}  // namespace sprung::reduce
