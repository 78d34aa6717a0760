#include "tools/support/files/content_hash.h"

#include <nettle/sha2.h>

#include <algorithm>
#include <array>
#include <bit>
#include <stdexcept>
#include <utility>

namespace sprung::support {

namespace {

using Digest = std::array<std::uint8_t, SHA256_DIGEST_SIZE>;

// The eight bytes of a number, least significant first on every machine.
std::array<char, 8> little_endian(std::uint64_t value) {
  std::array<char, 8> bytes{};
  for (char& byte : bytes) {
    byte = static_cast<char>(value & 0xFFU);
    value >>= 8U;
  }
  return bytes;
}

void update(sha256_ctx& context, std::string_view bytes) {
  sha256_update(&context, bytes.size(), reinterpret_cast<const std::uint8_t*>(bytes.data()));
}

std::string to_hex(sha256_ctx& context) {
  Digest digest{};
  sha256_digest(&context, digest.size(), digest.data());
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  text.reserve(2 * digest.size());
  for (const std::uint8_t byte : digest) {
    text += kDigits[byte >> 4U];
    text += kDigits[byte & 0xFU];
  }
  return text;
}

}  // namespace

struct ContentHash::Context {
  sha256_ctx sha{};
};

ContentHash::ContentHash() : context_(std::make_unique<Context>()) {
  sha256_init(&context_->sha);
}

ContentHash::~ContentHash() = default;

void ContentHash::add(std::string_view label, std::string_view text) {
  add_header('t', label, text.size());
  add_bytes(text);
}

void ContentHash::add(std::string_view label, std::span<const double> values) {
  add_header('d', label, values.size());
  constexpr std::size_t kAtOnce = 512;  // one call of Nettle for each value would take longer than the hash
  std::array<std::array<char, 8>, kAtOnce> block;
  for (; !values.empty(); values = values.subspan(std::min(kAtOnce, values.size()))) {
    const std::span<const double> taken = values.first(std::min(kAtOnce, values.size()));
    std::transform(taken.begin(), taken.end(), block.begin(), [](double value) {
      return little_endian(std::bit_cast<std::uint64_t>(value == 0.0 ? 0.0 : value));
    });
    add_bytes(std::string_view(block.front().data(), 8 * taken.size()));
  }
}

void ContentHash::add(std::string_view label, std::span<const std::int64_t> values) {
  add_header('i', label, values.size());
  for (const std::int64_t value : values) add_integer(static_cast<std::uint64_t>(value));
}

void ContentHash::add_header(char type, std::string_view label, std::size_t count) {
  add_integer(label.size());
  add_bytes(label);
  add_bytes(std::string_view(&type, 1));
  add_integer(count);
}

void ContentHash::add_integer(std::uint64_t value) {
  const std::array<char, 8> bytes = little_endian(value);
  add_bytes(std::string_view(bytes.data(), bytes.size()));
}

void ContentHash::add_bytes(std::string_view bytes) {
  if (!context_) throw std::invalid_argument("ContentHash::add: hex() has been called");
  update(context_->sha, bytes);
}

std::string ContentHash::hex() {
  if (!context_) throw std::invalid_argument("ContentHash::hex: called twice");
  const std::unique_ptr<Context> context = std::move(context_);
  return to_hex(context->sha);
}

std::string sha256(std::string_view text) {
  sha256_ctx context{};
  sha256_init(&context);
  update(context, text);
  return to_hex(context);
}

}  // namespace sprung::support
