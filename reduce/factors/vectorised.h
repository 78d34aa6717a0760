#pragma once

#include <cstring>

/// Before a function: it is compiled for processors with AVX-512 and with AVX and FMA as well, and the
/// program takes what the machine has. What it calls has to be inlined (SPRUNG_INLINED). Sums are rounded
/// once less by FMA.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define SPRUNG_VECTORISED __attribute__((target_clones("avx512f", "fma", "default")))
#else
#define SPRUNG_VECTORISED
#endif
#define SPRUNG_INLINED [[gnu::always_inline]] inline

#pragma GCC diagnostic ignored "-Wpsabi"  // what is inlined is called by no rule

namespace sprung::reduce {

/// Numbers that are computed with together.
using FourDoubles [[gnu::vector_size(32)]] = double;
using EightDoubles [[gnu::vector_size(64)]] = double;

/// Whether the processor has 32 registers of eight doubles, by AVX-512.
inline bool has_many_registers() {
#if defined(__x86_64__) && defined(__GNUC__)
  return __builtin_cpu_supports("avx512f") != 0;
#else
  return false;
#endif
}

/// From and to anywhere in memory. @tparam Values  a number, or one of those above
template <class Values>
SPRUNG_INLINED Values load(const double* from) {
  Values values;
  std::memcpy(&values, from, sizeof(Values));
  return values;
}
template <class Values>
SPRUNG_INLINED void store(const Values& values, double* to) {
  std::memcpy(to, &values, sizeof(Values));
}

}  // namespace sprung::reduce
