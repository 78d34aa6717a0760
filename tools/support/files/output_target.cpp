#include "tools/support/files/output_target.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "tools/support/errors/input_error.h"

namespace sprung::support {

namespace fs = std::filesystem;

namespace {

InputError cannot_be_written(const fs::path& target, std::string_view reason) {
  return InputError({.path = target.string()}, fmt::format("cannot be written: {}", reason));
}

void sync_file(const fs::path& target, const fs::path& written) {
  const int descriptor = ::open(written.c_str(), O_RDONLY | O_CLOEXEC);
  const bool synced = descriptor >= 0 && ::fsync(descriptor) == 0;
  const int reason = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (!synced) throw cannot_be_written(target, std::strerror(reason));
}

// Writes the rename to the disk. Some file systems cannot sync a folder; the file is complete in any case.
void sync_folder(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

// Whether another program holds HDF5's lock. A file that cannot be opened is not locked: the attempt to write
// it will give the reason.
bool is_locked(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool held = ::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(descriptor);
  return held;
}

}  // namespace

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

void check_temporary(const fs::path& target, const fs::path& temporary) {
  std::error_code ignored;
  const fs::file_status status = fs::symlink_status(temporary, ignored);
  if (!fs::exists(status)) return;
  if (!fs::is_regular_file(status)) {
    throw cannot_be_written(target, fmt::format("'{}' is in the way", temporary.string()));
  }
  if (is_locked(temporary))
    throw cannot_be_written(target, fmt::format("another writer is at '{}'", temporary.string()));
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

void rename_to_target(const fs::path& temporary, const fs::path& target) {
  sync_file(target, temporary);
  std::error_code error;
  fs::rename(temporary, target, error);
  if (error) throw cannot_be_written(target, error.message());
  sync_folder(folder_of(target));
}

}  // namespace sprung::support
