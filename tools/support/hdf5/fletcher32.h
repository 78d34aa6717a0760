#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace sprung::support {

/// Checksum of bytes, a multiple of eight of them, by the rule of HDF5's filter "fletcher32". With the n
/// big-endian words w_i of two bytes, the lower half is Σ w_i and the upper half Σ (n − i) w_i, both in
/// ones' complement arithmetic of 16 bits. Source:
/// [HDF5] H5checksum.c, H5_checksum_fletcher32 — checked by tests/tools/support/fletcher32_test.cpp
std::uint32_t calc_fletcher32(std::span<const std::byte> bytes);

}  // namespace sprung::support
