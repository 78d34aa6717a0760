#pragma once

#include <cstdint>
#include <span>

namespace sprung::support {

/// Checksum of doubles as they stand in memory, by the rule of HDF5's filter "fletcher32": of big-endian
/// words of two bytes, Σ w_i below and Σ (n − i) w_i above, both by ones' complement in 16 bits. Source:
/// [HDF5] H5checksum.c, H5_checksum_fletcher32 — checked by tests/tools/support/fletcher32_test.cpp
std::uint32_t calc_fletcher32(std::span<const double> values);

}  // namespace sprung::support
