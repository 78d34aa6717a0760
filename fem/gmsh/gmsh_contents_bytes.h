#pragma once

#include <string>
#include <string_view>

#include "fem/gmsh/gmsh_contents.h"

namespace sprung::fem {

/// The contents as bytes, by which they go from one process to another of the same program.
std::string pack(const GmshContents& contents);

/// The contents that `pack` made bytes of.
/// @throws support::DamagedBytes if the bytes are none of its: the process that sent them was damaged
/// Checked by tests/fem/gmsh/gmsh_contents_bytes_test.cpp
GmshContents unpack(std::string_view bytes);

}  // namespace sprung::fem
