#include "tools/support/files/content_hash.h"

#include <array>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "tests/catch.h"
#include "tests/tools/support/error_message.h"

using sprung::support::ContentHash;
using sprung::support::sha256;

namespace {

std::string hash_of(const std::vector<double>& values) {
  ContentHash hash;
  hash.add("values", values);
  return hash.hex();
}

}  // namespace

TEST_CASE("sha256 gives the digests of the standard's examples") {
  // FIPS 180-4: the empty message, "abc" and the two-block message of the NIST example file SHA256.pdf.
  CHECK(sha256("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(sha256("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
        "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

TEST_CASE("a content hash is the SHA-256 of label length, label, type, count and little-endian values") {
  // The bytes written out by hand: 1.5 is 0x3FF8000000000000, -2 is 0xFFFFFFFFFFFFFFFE.
  using namespace std::string_literals;
  const std::string expected =
      "\1\0\0\0\0\0\0\0"s
      "at"s
      "\2\0\0\0\0\0\0\0"s
      "hi"s
      "\1\0\0\0\0\0\0\0"s
      "bd"s
      "\1\0\0\0\0\0\0\0"s
      "\0\0\0\0\0\0\xF8\x3F"s
      "\1\0\0\0\0\0\0\0"s
      "ci"s
      "\1\0\0\0\0\0\0\0"s
      "\xFE\xFF\xFF\xFF\xFF\xFF\xFF\xFF"s;
  ContentHash hash;
  hash.add("a", "hi");
  hash.add("b", std::array{1.5});
  hash.add("c", std::array{std::int64_t{-2}});
  CHECK(hash.hex() == sha256(expected));
}

TEST_CASE("a content hash tells the sign of every number but zero") {
  CHECK(hash_of({0.0, 1.25}) == hash_of({-0.0, 1.25}));
  CHECK(hash_of({0.0, 1.25}) != hash_of({0.0, -1.25}));
  CHECK(hash_of({0.0, 1.25}) != hash_of({1.25, 0.0}));
}

TEST_CASE("a content hash tells the last bit of a number") {
  CHECK(hash_of({1.0}) != hash_of({1.0 + 2.220446049250313e-16}));
}

TEST_CASE("a content hash tells where one value ends and the next begins") {
  ContentHash first;
  first.add("a", "xy");
  first.add("b", "z");
  ContentHash second;
  second.add("a", "x");
  second.add("b", "yz");
  CHECK(first.hex() != second.hex());
}

TEST_CASE("a content hash is finished once") {
  ContentHash hash;
  hash.add("a", "text");
  hash.hex();
  CHECK(error_message<std::invalid_argument>([&] { hash.hex(); }) == "ContentHash::hex: called twice");
  CHECK(error_message<std::invalid_argument>([&] { hash.add("b", "more"); }) ==
        "ContentHash::add: hex() has been called");
}
