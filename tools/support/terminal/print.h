#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string_view>
#include <utility>

namespace sprung::support {

/// Writes text to a stream. A stream that cannot be written, as of a terminal that was closed, must not end a
/// calculation: it throws nothing, and `run_program` tells at the end where standard output is not whole.
/// Checked by tests/tools/support/program_test.cpp
void write_text(std::FILE* stream, std::string_view text);

/// Likewise, formatted.
template <class... Values>
void print(std::FILE* stream, fmt::format_string<Values...> format, Values&&... values) {
  write_text(stream, fmt::format(format, std::forward<Values>(values)...));
}

/// errno of the last write_text() that failed; 0 if none has.
int last_write_error();

}  // namespace sprung::support
