// Runs the tests of a program in a new temporary folder, so that they leave nothing in the present one.
#if __has_include(<catch2/catch_all.hpp>)
#include <catch2/catch_session.hpp>
#else
#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>
#endif

#include <filesystem>

#include "tests/tools/support/temporary_folder.h"

int main(int argc, char** argv) {
  const TemporaryFolder folder;
  std::filesystem::current_path(folder.path());
  return Catch::Session().run(argc, argv);
}
