// Gives each file of the command line, and each file in its folders, to the fuzzer's function, and a few
// hundred damaged copies of each: what the fuzzers once found stays found, in a second and with any compiler.
// Usage: NAME_replay FILE|FOLDER…
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/mutations.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

namespace fs = std::filesystem;

constexpr int kDamagedCopies = 200;

std::vector<fs::path> list_files(const fs::path& path) {
  if (!fs::is_directory(path)) return {path};
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(path)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

void give(const std::string& bytes) {
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

}  // namespace

int main(int argc, char** argv) {
  int num_files = 0;
  for (int i = 1; i < argc; ++i) {
    for (const fs::path& file : list_files(argv[i])) {
      std::printf("%s\n", file.c_str());  // the last line names the file of a crash
      std::fflush(stdout);
      std::ifstream stream(file, std::ios::binary);
      const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
      give(bytes);
      sprung::test::Mutations mutations(static_cast<std::uint64_t>(++num_files));
      for (int copy = 0; copy < kDamagedCopies; ++copy) give(mutations.damage(bytes));
    }
  }
  return num_files == 0;
}
