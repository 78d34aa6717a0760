#include "tools/support/files/content_hash.h"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <bit>
#include <new>
#include <stdexcept>

namespace sprung::support {

namespace {

using Digest = std::array<unsigned char, EVP_MAX_MD_SIZE>;

EVP_MD_CTX* evp(void* context) {
  return static_cast<EVP_MD_CTX*>(context);
}

void check(int status) {
  if (status != 1) throw std::runtime_error("ContentHash: the SHA-256 of OpenSSL failed");
}

// The eight bytes of a number, least significant first on every machine.
std::array<char, 8> little_endian(std::uint64_t value) {
  std::array<char, 8> bytes{};
  for (char& byte : bytes) {
    byte = static_cast<char>(value & 0xFFU);
    value >>= 8U;
  }
  return bytes;
}

std::string to_hex(const Digest& digest, unsigned int size) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  text.reserve(2 * std::size_t{size});
  for (unsigned int i = 0; i < size; ++i) {
    text += kDigits[digest[i] >> 4U];
    text += kDigits[digest[i] & 0xFU];
  }
  return text;
}

}  // namespace

void ContentHash::Deleter::operator()(void* context) const {
  EVP_MD_CTX_free(static_cast<EVP_MD_CTX*>(context));
}

ContentHash::ContentHash() : context_(EVP_MD_CTX_new()) {
  if (!context_) throw std::bad_alloc();
  check(EVP_DigestInit_ex(evp(context_.get()), EVP_sha256(), nullptr));
}

ContentHash::~ContentHash() = default;

void ContentHash::add(std::string_view label, std::string_view text) {
  add_header('t', label, text.size());
  add_bytes(text);
}

void ContentHash::add(std::string_view label, std::span<const double> values) {
  add_header('d', label, values.size());
  constexpr std::size_t kAtOnce = 512;  // one call of OpenSSL for each value would take longer than the hash
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
  check(EVP_DigestUpdate(evp(context_.get()), bytes.data(), bytes.size()));
}

std::string ContentHash::hex() {
  if (!context_) throw std::invalid_argument("ContentHash::hex: called twice");
  Digest digest{};
  unsigned int size = 0;
  check(EVP_DigestFinal_ex(evp(context_.get()), digest.data(), &size));
  context_.reset();
  return to_hex(digest, size);
}

std::string sha256(std::string_view text) {
  Digest digest{};
  unsigned int size = 0;
  check(EVP_Digest(text.data(), text.size(), digest.data(), &size, EVP_sha256(), nullptr));
  return to_hex(digest, size);
}

}  // namespace sprung::support
