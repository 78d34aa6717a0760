#include "tools/support/hdf5/hdf5_handle.h"

namespace sprung::support {

Hdf5Handle& Hdf5Handle::operator=(Hdf5Handle&& other) noexcept {
  if (this != &other) {
    reset();
    id_ = other.release();
    close_ = other.close_;
  }
  return *this;
}

void Hdf5Handle::reset() {
  if (id_ >= 0 && close_ != nullptr) close_(id_);
  id_ = -1;
}

}  // namespace sprung::support
