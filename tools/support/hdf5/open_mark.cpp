#include "tools/support/hdf5/open_mark.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cerrno>
#include <cstring>

#include "tools/support/hdf5/hdf5_library.h"

namespace sprung::support::hdf5 {

namespace {

// Superblock version 3 with addresses of 8 bytes: signature (8 bytes), version, sizes of addresses and
// lengths, flags, four addresses, checksum.
constexpr std::size_t kVersionPlace = 8, kFlagsPlace = 11, kChecksumPlace = 44;
using Superblock = std::array<unsigned char, kChecksumPlace + 4>;
constexpr unsigned char kVersion = 3;

// Three words of state, mixed with each 12 bytes.
struct State {
  std::uint32_t a, b, c;

  void mix() {
    a -= c, a ^= std::rotl(c, 4), c += b;
    b -= a, b ^= std::rotl(a, 6), a += c;
    c -= b, c ^= std::rotl(b, 8), b += a;
    a -= c, a ^= std::rotl(c, 16), c += b;
    b -= a, b ^= std::rotl(a, 19), a += c;
    c -= b, c ^= std::rotl(b, 4), b += a;
  }
  void finish() {
    c ^= b, c -= std::rotl(b, 14);
    a ^= c, a -= std::rotl(c, 11);
    b ^= a, b -= std::rotl(a, 25);
    c ^= b, c -= std::rotl(b, 16);
    a ^= c, a -= std::rotl(c, 4);
    b ^= a, b -= std::rotl(a, 14);
    c ^= b, c -= std::rotl(b, 24);
  }
};

std::uint32_t read_word(const unsigned char* bytes) {
  return static_cast<std::uint32_t>(bytes[0]) | static_cast<std::uint32_t>(bytes[1]) << 8U |
         static_cast<std::uint32_t>(bytes[2]) << 16U | static_cast<std::uint32_t>(bytes[3]) << 24U;
}

// HDF5's checksum of its structures, over the 44 bytes before it.
// Source: B. Jenkins, lookup3.c, hashlittle() (public domain, 2006)
std::uint32_t calc_checksum(const Superblock& superblock) {
  const std::uint32_t begin = 0xdeadbeefU + kChecksumPlace;
  State state{begin, begin, begin};
  const unsigned char* at = superblock.data();
  std::size_t left = kChecksumPlace;
  for (; left > 12; left -= 12, at += 12) {
    state.a += read_word(at), state.b += read_word(at + 4), state.c += read_word(at + 8);
    state.mix();
  }
  static_assert(kChecksumPlace % 12 == 8, "two words are left");
  state.a += read_word(at), state.b += read_word(at + 4);
  state.finish();
  return state.c;
}

}  // namespace

void clear_open_mark(int descriptor) {
  Superblock superblock{};
  const auto size = static_cast<ssize_t>(superblock.size());
  if (::pread(descriptor, superblock.data(), superblock.size(), 0) != size ||
      superblock[kVersionPlace] != kVersion ||
      read_word(&superblock[kChecksumPlace]) != calc_checksum(superblock)) {
    throw Failure("the file's superblock cannot be read");
  }
  superblock[kFlagsPlace] = 0;
  const std::uint32_t checksum = calc_checksum(superblock);
  for (std::size_t i = 0; i < 4; ++i) {
    superblock[kChecksumPlace + i] = static_cast<unsigned char>(checksum >> 8 * i);
  }
  if (::pwrite(descriptor, superblock.data(), superblock.size(), 0) != size) {
    throw Failure(fmt::format("cannot be written: {}", std::strerror(errno)));
  }
}

}  // namespace sprung::support::hdf5
