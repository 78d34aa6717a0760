#include "tools/support/files/output_target.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace sprung::support {

namespace fs = std::filesystem;

namespace {

// Whether another program writes it. A file that cannot be opened is not locked: the attempt to write
// it will give the reason.
bool is_locked(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool held = ::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(descriptor);
  return held;
}

}  // namespace

InputError cannot_be_written(const fs::path& target, std::string_view reason) {
  return InputError({.path = target.string()}, fmt::format("cannot be written: {}", reason));
}

fs::path folder_of(const fs::path& path) {
  const fs::path folder = path.parent_path();
  return folder.empty() ? fs::path(".") : folder;
}

void check_target(const fs::path& target) {
  if (target.filename().empty()) throw cannot_be_written(target, "it names no file");
  std::error_code ignored;
  fs::path walked;
  for (const fs::path& part : folder_of(target)) {
    walked /= part;
    const fs::file_status status = fs::status(walked, ignored);
    if (status.type() == fs::file_type::not_found) {
      throw cannot_be_written(target, fmt::format("there is no folder '{}'", walked.string()));
    }
    if (fs::exists(status) && !fs::is_directory(status)) {
      throw cannot_be_written(target, fmt::format("'{}' is not a folder", walked.string()));
    }
  }
  const fs::file_status status = fs::status(target, ignored);
  if (!fs::exists(status) && fs::is_symlink(fs::symlink_status(target, ignored))) {
    throw cannot_be_written(target, fmt::format("it is a link to '{}', which does not exist",
                                                fs::read_symlink(target, ignored).string()));
  }
  if (fs::is_directory(status)) throw cannot_be_written(target, "it is a folder");
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw cannot_be_written(target, "it is not a regular file");
  }
}

void check_replaceable(const fs::path& target, const fs::path& other) {
  std::error_code ignored;
  const fs::file_status status = fs::symlink_status(other, ignored);
  if (fs::exists(status) && !fs::is_regular_file(status))
    throw cannot_be_written(target, fmt::format("'{}' is in the way", other.string()));
}

fs::path temporary_name(const fs::path& target) {
  return target.string() + ".tmp";
}

void remove_left_over(const fs::path& target) {
  const fs::path temporary = temporary_name(target);
  std::error_code ignored;
  if (!fs::is_regular_file(fs::symlink_status(temporary, ignored)) || is_locked(temporary)) return;
  fs::remove(temporary, ignored);
}

}  // namespace sprung::support
