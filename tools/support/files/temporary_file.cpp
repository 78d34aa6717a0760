#include "tools/support/files/temporary_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "tools/support/errors/input_error.h"
#include "tools/support/files/output_target.h"

namespace sprung::support {

namespace {

// Writes the rename to the disk. Some file systems cannot sync a folder; the file is complete in any case.
void sync_folder(const std::filesystem::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

TemporaryFile::TemporaryFile(std::filesystem::path target)
    : target_(std::move(target)), path_(temporary_name(target_)) {
  check_target(target_);
  check_replaceable(target_, path_);
  do {  // the writer before may have renamed the file between these two calls
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0) throw cannot_be_written(target_, std::strerror(errno));
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      ::close(descriptor_);
      throw cannot_be_written(target_, fmt::format("another writer is at '{}'", path_.string()));
    }
  } while (!is_in_place());
  unfinished_.emplace(path_);
}

TemporaryFile::~TemporaryFile() {
  if (descriptor_ < 0) return;
  if (is_in_place()) ::unlink(path_.c_str());
  ::close(descriptor_);
}

bool TemporaryFile::is_in_place() const {
  struct stat mine {};
  struct stat there {};
  return ::fstat(descriptor_, &mine) == 0 && ::stat(path_.c_str(), &there) == 0 &&
         mine.st_dev == there.st_dev && mine.st_ino == there.st_ino;
}

std::string TemporaryFile::try_rename_to(const std::filesystem::path& name) {
  if (::fsync(descriptor_) != 0) return std::strerror(errno);
  if (!is_in_place()) return fmt::format("another program has removed or replaced '{}'", path_.string());
  std::error_code error;
  std::filesystem::rename(path_, name, error);
  if (error) return error.message();
  leave();
  sync_folder(folder_of(name));
  return {};
}

void TemporaryFile::rename_to_target() {
  const std::string reason = try_rename_to(target_);
  if (!reason.empty()) throw cannot_be_written(target_, reason);
}

void TemporaryFile::leave() {
  unfinished_.reset();
  ::close(descriptor_);
  descriptor_ = -1;
}

}  // namespace sprung::support
