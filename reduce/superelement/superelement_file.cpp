#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "reduce/superelement/superelement.h"
#include "reduce/superelement/superelement_fault.h"
#include "reduce/superelement/superelement_hash.h"
#include "tools/support/errors/input_error.h"
#include "tools/support/hdf5/hdf5_file.h"

namespace sprung::reduce {

namespace {

using support::Hdf5Reader;
using support::InputError;

void write_field(support::Hdf5Writer& file, const SuperelementField& field, const FieldValue& value,
                 const std::vector<std::size_t>& shape) {
  const std::string path(field.path);
  if (field.type == FieldType::kTexts) {
    file.write(path, std::span<const std::string>(value.texts));
  } else if (field.type == FieldType::kIntegers) {
    file.write(path, std::span<const std::int64_t>(value.integers), shape);
  } else if (value.matrices().size() == 1) {
    const support::RowMatrix& matrix = value.matrices().front();
    file.write(path, std::span<const double>(matrix.data(), static_cast<std::size_t>(matrix.size())), shape,
               field.unit);
  } else {
    std::vector<double> numbers;
    for (const support::RowMatrix& matrix : value.matrices())
      numbers.insert(numbers.end(), matrix.data(), matrix.data() + matrix.size());
    file.write(path, std::span<const double>(numbers), shape, field.unit);
  }
}

InputError dataset_error(const Hdf5Reader& file, std::string_view dataset, const std::string& message) {
  return InputError({.path = file.path().string()}, fmt::format("dataset '{}' {}", dataset, message));
}

// The version of the format.
std::int64_t read_version(const Hdf5Reader& file) {
  const support::SourceLocation where{.path = file.path().string()};
  if (!file.has_attribute("/", "format") || file.string_attribute("/", "format") != kSuperelementFormat) {
    throw InputError(where,
                     fmt::format("not a superelement: attribute 'format' is not '{}'", kSuperelementFormat));
  }
  const std::int64_t version = file.integer_attribute("/", "version");
  if (version > kSuperelementVersion) {
    throw InputError(
        where, fmt::format("superelement format version {}, this program reads up to version {}: use a "
                           "newer sprung, or make the file again from its design with sprung-reduce build",
                           version, kSuperelementVersion));
  }
  if (version < kFirstVersion) {
    throw InputError(where,
                     fmt::format("superelement format version {}, expected ≥ {}", version, kFirstVersion));
  }
  return version;
}

void check_unit(const Hdf5Reader& file, const SuperelementField& field) {
  const std::string path(field.path);
  if (!file.has_attribute(path, "unit")) return;
  const std::string unit = file.string_attribute(path, "unit");
  if (unit == field.unit) return;
  throw dataset_error(file, path, fmt::format("has the unit '{}', expected '{}'", unit, field.unit));
}

// A single matrix is read where it will stand, since that of the resultants is large.
std::vector<std::int64_t> read_matrices(const Hdf5Reader& file, const SuperelementField& field,
                                        const std::vector<std::int64_t>& expected,
                                        std::vector<support::RowMatrix>& matrices) {
  const std::string path(field.path);
  if (field.type == FieldType::kReals) {
    return file.read_reals(path, expected, [&](const std::vector<std::int64_t>& found) {
      const auto [num_matrices, rows, columns] = calc_matrices(field, found);
      support::RowMatrix& matrix = matrices.emplace_back(rows, columns);
      return std::span(matrix.data(), static_cast<std::size_t>(matrix.size()));
    });
  }
  const std::vector<double> numbers = file.reals(path, expected);
  std::vector<std::int64_t> found = file.shape(path);
  const auto [num_matrices, rows, columns] = calc_matrices(field, found);
  for (std::int64_t i = 0; i < num_matrices; ++i)
    matrices.emplace_back(
        Eigen::Map<const support::RowMatrix>(numbers.data() + i * rows * columns, rows, columns));
  return found;
}

FieldValue read_field(const Hdf5Reader& file, const SuperelementField& field, FieldCounts& counts) {
  const std::string path(field.path);
  const std::vector<std::int64_t> expected = calc_extents(field, counts);
  FieldValue value;
  std::vector<std::int64_t> found;
  if (field.type == FieldType::kTexts) {
    value.texts = file.strings(path, expected);
    found = file.shape(path);
  } else if (field.type == FieldType::kIntegers) {
    value.integers = file.integers(path, expected);
    found = file.shape(path);
  } else {
    found = read_matrices(file, field, expected, value.reals);
  }
  check_unit(file, field);
  add_counts(field, found, counts);
  if (field.rule == FieldRule::kIndex) {
    const auto bad = std::find_if(value.integers.begin(), value.integers.end(), [](std::int64_t index) {
      return index < 0 || index > std::numeric_limits<int>::max();
    });
    if (bad != value.integers.end()) {
      throw dataset_error(file, path,
                          fmt::format("has the value {}, expected a number ≥ 0 that fits 31 bits", *bad));
    }
  }
  return value;
}

}  // namespace

std::string write_superelement(const Superelement& superelement, const std::filesystem::path& path) {
  FieldValues values;
  if (const std::optional<SuperelementFault> fault = find_fault(superelement, values)) {
    throw std::invalid_argument(fmt::format("write_superelement: '{}' {}", fault->dataset, fault->message));
  }
  std::string hash = calc_content_hash(superelement, values);
  const std::int64_t version = find_version(superelement);
  support::Hdf5Writer file(path);
  file.attribute("/", "format", kSuperelementFormat);
  file.attribute("/", "version", version);
  file.attribute("/", "units", std::string_view("SI: kg, m, s, N, rad; frequencies in Hz"));
  file.attribute("/", "name", std::string_view(superelement.name));
  file.attribute("/", "num_elastic_dofs", superelement.num_elastic_dofs);
  file.attribute("/", "content_hash", std::string_view(hash));
  const FieldCounts counts = count_parts(superelement);
  auto value = values.begin();
  for (const SuperelementField& field : superelement_fields(superelement)) {
    const std::vector<std::int64_t> extents = calc_extents(field, counts);
    write_field(file, field, *value++, {extents.begin(), extents.end()});
  }
  file.attribute("/provenance", "program_version", superelement.provenance.program_version);
  file.attribute("/provenance", "algorithm_revision", superelement.provenance.algorithm_revision);
  file.commit();
  return hash;
}

Superelement read_superelement(const std::filesystem::path& path) {
  const Hdf5Reader file(path);
  const std::int64_t version = read_version(file);
  Superelement s;
  s.name = file.string_attribute("/", "name");
  s.num_elastic_dofs = file.integer_attribute("/", "num_elastic_dofs");
  FieldCounts counts = {{'1', 1}};
  const std::vector<SuperelementField> fields = superelement_fields();
  const bool has_section_loads = std::any_of(fields.begin(), fields.end(), [&](const auto& field) {
    return is_of_section_loads(field, version) && file.has(std::string(field.path));
  });
  for (const SuperelementField& field : fields) {
    if (is_of_section_loads(field, version) && !has_section_loads) continue;
    if (field.since <= version) {
      FieldValue value = read_field(file, field, counts);
      field.member.set(s, value);
    } else if (file.has(std::string(field.path))) {
      throw dataset_error(file, field.path,
                          fmt::format("belongs to version {} of the format, the file is of version {}",
                                      field.since, version));
    }
  }
  s.provenance.program_version = file.string_attribute("/provenance", "program_version");
  s.provenance.algorithm_revision = file.integer_attribute("/provenance", "algorithm_revision");
  FieldValues values;
  if (const std::optional<SuperelementFault> fault = find_fault(s, values)) {
    throw dataset_error(file, fault->dataset, fault->message);
  }
  s.content_hash = file.string_attribute("/", "content_hash");
  if (const std::string hash = calc_content_hash(s, values); hash != s.content_hash) {
    throw InputError(
        {.path = path.string()},
        fmt::format("attribute 'content_hash' is {}, but the contents have the hash {}: the file was "
                    "changed after it was written",
                    s.content_hash, hash));
  }
  return s;
}

}  // namespace sprung::reduce
