#include "reduce/program/previous_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/support/errors/input_error.h"
#include "tools/support/files/content_hash.h"
#include "tools/support/hdf5/foreign_file.h"
#include "tools/support/hdf5/hdf5_file.h"

namespace sprung::reduce {

namespace {

bool is_newer(const std::filesystem::path& path) {
  try {
    const support::Hdf5Reader file(path);
    return file.has_attribute("/", "version") &&
           file.integer_attribute("/", "version") > kSuperelementVersion;
  } catch (const support::InputError&) {
    return false;  // cut off or overwritten: nothing that anybody could want back
  }
}

}  // namespace

PreviousFile read_previous_file(const std::filesystem::path& path) {
  PreviousFile previous;
  std::error_code ignored;
  previous.exists = std::filesystem::is_regular_file(path, ignored);
  if (!previous.exists) return previous;
  try {
    previous.superelement = read_superelement(path);
  } catch (const support::InputError& error) {
    previous.reason = error.what();
    previous.foreign = support::is_foreign_file(path, kSuperelementFormat) || is_newer(path);
  }
  return previous;
}

std::string find_reason_to_rebuild(const Superelement& superelement, const DesignSource& design) {
  const Provenance& provenance = superelement.provenance;
  if (provenance.algorithm_revision != kAlgorithmRevision) {
    return fmt::format("algorithm revision {} instead of {}", kAlgorithmRevision,
                       provenance.algorithm_revision);
  }
  if (support::sha256(read_source_text(design)) != provenance.design_hash) return "the design changed";
  for (std::size_t i = 0; i < provenance.input_names.size(); ++i) {
    const std::string& name = provenance.input_names[i];
    if (calc_file_hash(design.path.parent_path() / name) != provenance.input_hashes[i])
      return name + " changed";
  }
  const bool passed = std::all_of(superelement.checks.begin(), superelement.checks.end(),
                                  [](const CheckResult& check) { return check.passed(); });
  return passed ? "" : "a recorded check failed";
}

}  // namespace sprung::reduce
