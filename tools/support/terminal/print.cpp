#include "tools/support/terminal/print.h"

#include <atomic>
#include <cerrno>

namespace sprung::support {

namespace {

std::atomic<int> last_error{0};

}  // namespace

void write_text(std::FILE* stream, std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stream) < text.size()) last_error = errno;
}

int last_write_error() {
  return last_error;
}

}  // namespace sprung::support
