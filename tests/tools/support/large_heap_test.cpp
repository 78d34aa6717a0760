#include "tools/support/processes/large_heap.h"

#include <sys/resource.h>

#include <cstdint>
#include <string>
#include <vector>

#include "tests/catch.h"
#include "tools/support/processes/limited_child.h"

using namespace sprung::support;

namespace {

constexpr std::size_t kArray = 64U << 20U;  // bytes

// Pages that the system had to provide while an array was made and freed.
long count_pages_of_array() {
  rusage before{}, after{};
  ::getrusage(RUSAGE_SELF, &before);
  const std::vector<char> array(kArray, '\1');
  ::getrusage(RUSAGE_SELF, &after);
  return after.ru_minflt - before.ru_minflt;
}

}  // namespace

// In a child process, because the heap of this one stays as it is.
#ifndef __SANITIZE_ADDRESS__
TEST_CASE("Memory that a large array leaves is the next one's without new pages") {
  const std::string pages = run_in_limited_child("heap",
                                                 [] {
                                                   prepare_large_heap(4 * kArray);
                                                   count_pages_of_array();
                                                   return std::to_string(count_pages_of_array());
                                                 },
                                                 {});
  CHECK(std::stol(pages) < 100);  // 16384 of 4 kB make an array
}
#endif

// What comes before a huge page comes in small ones, 512 in place of one.
#ifndef __SANITIZE_ADDRESS__
TEST_CASE("The first large array begins where a huge page does") {
  const std::string offset =
      run_in_limited_child("heap",
                           [] {
                             prepare_large_heap(4 * kArray);
                             const std::vector<char> array(kArray, '\1');
                             const auto address = reinterpret_cast<std::uintptr_t>(array.data());
                             return std::to_string(address % (std::uintptr_t{2} << 20U));
                           },
                           {});
  CHECK(std::stol(offset) < 4096);
}
#endif

TEST_CASE("A heap for more than the address space changes nothing that a program notices") {
  const std::string size =
      run_in_limited_child("heap",
                           [] {
                             prepare_large_heap(std::size_t{1} << 60U);
                             return std::to_string(std::vector<char>(kArray, '\1').size());
                           },
                           {});
  CHECK(size == std::to_string(kArray));
}
