#include "reduce/superelement/superelement_hash.h"

#include <fmt/format.h>

#include "tools/support/files/content_hash.h"

namespace sprung::reduce {

namespace {

using support::ContentHash;

void add(ContentHash& hash, std::string_view label, std::int64_t value) {
  hash.add(label, std::span<const std::int64_t>(&value, 1));
}

void add_whole(ContentHash& hash, const SuperelementField& field, const FieldValue& value) {
  for (const support::RowMatrix& matrix : value.matrices()) {
    hash.add(fmt::format("{} {}x{}", field.path, matrix.rows(), matrix.cols()),
             std::span<const double>(matrix.data(), static_cast<std::size_t>(matrix.size())));
  }
  if (field.type == FieldType::kIntegers) hash.add(field.path, std::span<const std::int64_t>(value.integers));
  if (field.type == FieldType::kTexts) hash.add(field.path, fmt::format("{}", value.texts.size()));
  for (const std::string& text : value.texts) hash.add(field.path, text);
}

// Integers and texts only.
void add_rows(ContentHash& hash, const SuperelementField& field, const FieldValue& value) {
  const std::size_t num_columns = field.shape.ends_with("×2") ? 2 : 1;
  for (std::size_t i = 0; i < value.integers.size(); i += num_columns) {
    hash.add(field.path, std::span(value.integers).subspan(i, num_columns));
  }
  for (const std::string& text : value.texts) hash.add(field.path, text);
}

void add_points(ContentHash& hash, const std::vector<NamedPoint>& points) {
  for (const NamedPoint& point : points) {
    hash.add("/points/name", point.name);
    add(hash, "/points/node", point.node);
  }
}

void add_rigid_inertia(ContentHash& hash, const InertiaInvariants& inertia) {
  const double rigid[] = {inertia.mass, inertia.first_moment.x(), inertia.first_moment.y(),
                          inertia.second_moment};
  hash.add("/inertia/rigid", std::span<const double>(rigid));
}

void add_checks(ContentHash& hash, const std::vector<CheckResult>& checks) {
  for (const CheckResult& check : checks) {
    const double numbers[] = {check.value, check.tolerance};
    hash.add("/checks/name", check.name);
    hash.add("/checks/value", std::span<const double>(numbers));
  }
}

}  // namespace

std::string calc_content_hash(const Superelement& superelement) {
  return calc_content_hash(superelement, get_values(superelement));
}

std::string calc_content_hash(const Superelement& superelement, const FieldValues& values) {
  ContentHash hash;
  hash.add("name", superelement.name);
  add(hash, "num_elastic_dofs", superelement.num_elastic_dofs);
  auto value = values.begin();
  for (const SuperelementField& field : superelement_fields(superelement)) {
    switch (field.hash) {
      case FieldHash::kWhole:
        add_whole(hash, field, *value);
        break;
      case FieldHash::kRows:
        add_rows(hash, field, *value);
        break;
      case FieldHash::kPoints:
        add_points(hash, superelement.points);
        break;
      case FieldHash::kRigidInertia:
        add_rigid_inertia(hash, superelement.inertia);
        break;
      case FieldHash::kChecks:
        add_checks(hash, superelement.checks);
        break;
      case FieldHash::kWithPrevious:
        break;
    }
    ++value;
  }
  hash.add("program_version", superelement.provenance.program_version);
  add(hash, "algorithm_revision", superelement.provenance.algorithm_revision);
  return hash.hex();
}

}  // namespace sprung::reduce
