// The reader of superelements: an InputError, or a superelement without a fault.
#include "reduce/superelement/superelement.h"
#include "tests/fuzz/memory_file.h"
#include "tools/support/errors/input_error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const sprung::fuzz::MemoryFile file(data, size);
  try {
    sprung::reduce::read_superelement(file.path());
  } catch (const sprung::support::InputError&) {
  }
  return 0;
}
