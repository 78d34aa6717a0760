#include <fmt/format.h>

#include <map>

#include "fem/gmsh/gmsh_mesher.h"
#include "tests/catch.h"
#include "tests/fem/frames.h"
#include "tests/mutations.h"

namespace sprung::fem {

namespace {

const std::vector<const char*> kFiles{"portal.geo", "portal_22.msh", "portal_22_binary.msh", "portal_41.msh",
                                      "portal_41_binary.msh"};

// How the reading of a file ended. Anything but an InputError of this file passes through and fails the test.
std::string classify(const std::filesystem::path& path) {
  try {
    read_gmsh_file(path, {.processor_seconds = 2, .memory_bytes = std::size_t{2} << 30U});
    return "read";
  } catch (const support::InputError& error) {
    const std::string message = error.what();
    if (message.rfind(path.string() + ": error: ", 0) != 0) return "not located: " + message;
    for (const char* end :
         {"gmsh crashed", "gmsh asked for more", "gmsh was stopped", "gmsh came to no end"}) {
      if (message.find(end) != std::string::npos) return fmt::format("refused: {}", end);
    }
    return message.find("gmsh: ") != std::string::npos ? "refused by gmsh" : "refused by its contents";
  }
}

std::map<std::string, int> classify_mutants(std::uint64_t seed, int per_file) {
  sprung::test::Mutations mutations(seed);
  std::map<std::string, int> outcomes;
  for (const char* file : kFiles) {
    const std::string whole = test::read_file(test::get_data(file));
    const std::string name = "mutant" + std::filesystem::path(file).extension().string();
    for (int i = 0; i < per_file; ++i) {
      const std::filesystem::path path = test::write_file(name, mutations.damage(whole));
      const std::string outcome = classify(path);
      if (outcome.rfind("not located", 0) == 0)
        test::write_file(fmt::format("{}.{}.kept", i, file), test::read_file(path));
      ++outcomes[outcome];
    }
  }
  return outcomes;
}

void check_outcomes(const std::map<std::string, int>& outcomes) {
  for (const auto& [outcome, count] : outcomes) {
    INFO(outcome << ": " << count);
    CHECK(outcome.rfind("not located", 0) != 0);
  }
}

}  // namespace

TEST_CASE("A damaged mesh file is read or refused by a located error, whatever the damage") {
  check_outcomes(classify_mutants(20251, 12));
}

// By hand: `fem_test "[many]"` prints how many ended in which way.
TEST_CASE("Thousands of damaged mesh files are read or refused by a located error", "[.][many]") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const std::map<std::string, int> outcomes = classify_mutants(seed, 100);
    check_outcomes(outcomes);
    for (const auto& [outcome, count] : outcomes) fmt::print("{} {}: {}\n", seed, outcome, count);
  }
}

}  // namespace sprung::fem
