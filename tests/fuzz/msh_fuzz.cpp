// The .msh reader before gmsh, and the reader of what gmsh's process sends: an InputError or DamagedBytes,
// and no other end.
#include <string>

#include "fem/gmsh/gmsh_contents_bytes.h"
#include "fem/gmsh/msh_file.h"
#include "tools/support/errors/input_error.h"
#include "tools/support/files/bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    sprung::fem::parse_msh_declaration(bytes, "input.msh");
  } catch (const sprung::support::InputError&) {
  }
  try {
    sprung::fem::pack(sprung::fem::unpack(bytes));
  } catch (const sprung::support::DamagedBytes&) {
  }
  return 0;
}
