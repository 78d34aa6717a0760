#include "reduce/design/program_version.h"

namespace sprung::reduce {

const char* get_program_version() {
  return SPRUNG_VERSION;
}

}  // namespace sprung::reduce
