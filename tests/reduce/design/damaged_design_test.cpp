#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>

#include "reduce/design/design.h"
#include "reduce/reduction/reduction.h"
#include "tests/catch.h"
#include "tests/mutations.h"
#include "tests/reduce/test_bodies.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {

namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kDesigns{"meshes/examples/square_frame.toml", "meshes/examples/four_arms.toml",
                                        "meshes/truck/chassis.toml", "meshes/truck/long_arm.toml"};
const fs::path kMutant = "mutant.toml";

// A message that shows a number which is none tells nobody what to do.
bool shows_no_number(const std::string& message) {
  static const std::regex kNoNumber(R"((^|[^a-z_'])-?(inf|nan)($|[^a-z_']))");
  return std::regex_search(message, kNoNumber);
}

// How the work on the mutant ended. What is neither of the two errors passes through and fails the test.
std::string classify() {
  try {
    make_superelement(read_design(kMutant));
    return "made";
  } catch (const support::InputError& error) {
    const std::string message = error.what();
    // A value that the user wrote as inf or nan may be quoted.
    if (message.rfind(kMutant.string() + ":", 0) != 0) return "bad: " + message;
    if (shows_no_number(message) && message.find("finite") == std::string::npos) return "bad: " + message;
    return "refused";
  } catch (const support::NumericalError& error) {
    return shows_no_number(error.what()) ? fmt::format("bad: {}", error.what()) : "numerics";
  } catch (const std::exception& error) {
    return fmt::format("bad: internal error: {}", error.what());
  }
}

// Only the sizes change in every other mutant, so that many come as far as the eigenvalues.
std::map<std::string, int> classify_mutants(std::uint64_t seed, int count) {
  sprung::test::Mutations mutations(seed);
  std::map<std::string, int> outcomes;
  for (int i = 0; i < count; ++i) {
    const std::string whole =
        testing::read_bytes(testing::source_path(kDesigns[static_cast<std::size_t>(i) % 4]));
    const std::string mutant = i / 4 % 2 == 0 ? mutations.change_numbers(whole) : mutations.damage(whole);
    // Meshes so fine that they take minutes are sound.
    static const std::regex kFine(R"(elements *= *\d\d\d)");
    if (std::regex_search(mutant, kFine)) continue;
    std::ofstream(kMutant, std::ios::binary) << mutant;
    const std::string outcome = classify();
    if (outcome.rfind("bad", 0) == 0)
      fs::copy_file(kMutant, fmt::format("bad_{}_{}.toml", seed, i), fs::copy_options::overwrite_existing);
    ++outcomes[outcome];
  }
  return outcomes;
}

void check_outcomes(const std::map<std::string, int>& outcomes) {
  for (const auto& [outcome, count] : outcomes) {
    INFO(outcome << ": " << count);
    CHECK(outcome.rfind("bad", 0) != 0);
  }
}

}  // namespace

TEST_CASE("a damaged design is reduced or refused, by a message without inf and nan") {
  check_outcomes(classify_mutants(5, 60));
}

// By hand: `reduce_test "[many]"` prints how many ended in which way.
TEST_CASE("thousands of damaged designs are reduced or refused", "[.][many]") {
  for (std::uint64_t seed = 100; seed < 110; ++seed) {
    const std::map<std::string, int> outcomes = classify_mutants(seed, 500);
    for (const auto& [outcome, count] : outcomes) fmt::print("{} {}: {}\n", seed, outcome, count);
    check_outcomes(outcomes);
  }
}

}  // namespace sprung::reduce
