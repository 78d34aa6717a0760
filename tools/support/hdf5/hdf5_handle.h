#pragma once

#include <cstdint>
#include <utility>

namespace sprung::support {

/// Owns an HDF5 identifier and closes it. Other rooms may hold one, but not use it.
class Hdf5Handle {
 public:
  Hdf5Handle() = default;
  Hdf5Handle(std::int64_t id, int (*close)(std::int64_t)) : id_(id), close_(close) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(other.release()), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept;
  ~Hdf5Handle() { reset(); }

  std::int64_t get() const { return id_; }
  void reset();  ///< closes; an error is dropped
  std::int64_t release() {
    return std::exchange(id_, -1);
  }  ///< gives up ownership; the identifier stays open

 private:
  std::int64_t id_ = -1;
  int (*close_)(std::int64_t) = nullptr;
};

}  // namespace sprung::support
