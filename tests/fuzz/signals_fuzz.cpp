// Files of measured signals, in each of their formats: an InputError, or numbers that are finite.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "dynamics/measured/column_file.h"
#include "dynamics/measured/crg_file.h"
#include "dynamics/measured/rpc3_file.h"
#include "tests/fuzz/memory_file.h"
#include "tools/support/errors/input_error.h"

namespace {

using namespace sprung;

void expect_finite(const std::vector<double>& values) {
  if (!std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }))
    std::abort();
}

// Refusing an input is a good end.
template <class Reading>
void attempt(const Reading& reading) {
  try {
    reading();
  } catch (const support::InputError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::MemoryFile input(data, size);
  attempt([&] {
    const dynamics::ColumnFile file = dynamics::ColumnFile::read(input.path());
    for (std::size_t i = 0; i < file.columns().size(); ++i) {
      expect_finite(file.read_column(i));
      file.locate(i, 1);
    }
  });
  attempt([&] {
    if (!dynamics::Rpc3File::is_one(input.path())) return;
    const dynamics::Rpc3File file = dynamics::Rpc3File::read(input.path());
    for (std::size_t i = 0; i < file.channels().size(); ++i) expect_finite(file.read_channel(i));
  });
  attempt([&] {
    const dynamics::CrgFile file = dynamics::CrgFile::read(input.path());
    expect_finite(file.read_heights(file.rightmost()));
    expect_finite(file.read_heights(0.5 * (file.rightmost() + file.leftmost())));
  });
  return 0;
}
