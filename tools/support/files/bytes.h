#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace sprung::support {

/// Bytes that are not what a ByteWriter made.
class DamagedBytes : public std::runtime_error {
 public:
  DamagedBytes() : std::runtime_error("the data are damaged") {}
};

// Values as bytes, for another process of the same program on the same machine, or for a file that the same
// program reads again. ByteWriter takes what ByteReader gives, call by call: one template describes a layout
// for both, with the structure constant for the writer.

class ByteWriter {
 public:
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void transfer(const Number& value) { bytes_.append(reinterpret_cast<const char*>(&value), sizeof value); }
  void transfer(const Eigen::VectorXd& values) {
    transfer(values.size());
    for (const double value : values) transfer(value);
  }
  /// @param each  called with each item
  template <class Items, class Each>
  void transfer_items(const Items& items, Each&& each) {
    transfer(items.size());
    for (const auto& item : items) each(item);
  }
  void transfer(const std::string& text) {
    transfer(text.size());
    bytes_ += text;
  }
  void transfer(const std::vector<bool>& flags) {
    transfer(flags.size());
    for (const bool flag : flags) transfer(flag);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Throws DamagedBytes where the bytes end too early. A damaged number of items ends with the bytes, not with
/// the memory.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : rest_(bytes) {}

  template <class Number>
  requires std::is_arithmetic_v<Number>
  void transfer(Number& value) { std::memcpy(&value, take(sizeof value).data(), sizeof value); }
  void transfer(Eigen::VectorXd& values) {
    Eigen::Index size = 0;
    transfer(size);
    if (size < 0 || static_cast<std::size_t>(size) > rest_.size() / sizeof(double)) throw DamagedBytes();
    values.resize(size);
    for (double& value : values) transfer(value);
  }
  template <class Items, class Each>
  void transfer_items(Items& items, Each&& each) {
    std::size_t size = 0;
    transfer(size);
    items.clear();
    for (std::size_t i = 0; i < size; ++i) {
      items.push_back({});
      each(items.back());
    }
  }
  void transfer(std::string& text) {
    std::size_t size = 0;
    transfer(size);
    text = take(size);
  }
  void transfer(std::vector<bool>& flags) {
    std::size_t size = 0;
    transfer(size);
    flags.clear();
    for (std::size_t i = 0; i < size; ++i) flags.push_back(take(1)[0] != 0);
  }
  bool at_end() const { return rest_.empty(); }

 private:
  std::string_view take(std::size_t size) {
    if (size > rest_.size()) throw DamagedBytes();
    const std::string_view taken = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return taken;
  }

  std::string_view rest_;
};

}  // namespace sprung::support
