#include "reduce/superelement/superelement_fields.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <sstream>

#include "reduce/superelement/superelement_fault.h"
#include "tests/catch.h"
#include "tests/reduce/test_bodies.h"

namespace sprung::reduce {
namespace {

using Catch::Matchers::StartsWith;

// A row of the specification's table of datasets: path, type, shape, unit and version, as texts.
using Row = std::array<std::string, 5>;

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" `"), last = text.find_last_not_of(" `");
  return first == std::string::npos ? "" : text.substr(first, last + 1 - first);
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(trimmed(part));
  return parts;
}

std::string read_specification() {
  return testing::read_bytes(testing::source_path("reduce/superelement/superelement.md"));
}

// A line of the table may name several datasets that are alike.
std::vector<Row> read_specified_rows() {
  std::vector<Row> rows;
  std::istringstream text(read_specification());
  for (std::string line; std::getline(text, line);) {
    if (!line.starts_with("| `/")) continue;
    const std::vector<std::string> cells = split(line, '|');  // the first one is empty
    REQUIRE(cells.size() >= 6);
    for (const std::string& path : split(cells[1], ',')) {
      rows.push_back({path, cells[2], cells[3], cells[4], cells[5]});
    }
  }
  return rows;
}

std::string type_name(FieldType type) {
  if (type == FieldType::kTexts) return "text";
  return type == FieldType::kIntegers ? "integer" : "real";
}

TEST_CASE("the specification has the datasets of the field table, with the same properties") {
  std::vector<Row> rows;
  for (const SuperelementField& field : superelement_fields()) {
    rows.push_back({std::string(field.path), type_name(field.type), std::string(field.shape),
                    std::string(field.unit), std::to_string(field.since)});
  }
  CHECK(read_specified_rows() == rows);
}

TEST_CASE("the specification has the versions of the field table, the newest one in use") {
  const std::string text = read_specification();
  CHECK(text.find("| `version` | " + std::to_string(kSuperelementVersion) + "; ") != std::string::npos);
  const std::string log = text.substr(text.find("## Versions"));
  std::int64_t newest = kFirstVersion;
  for (const SuperelementField& field : superelement_fields()) newest = std::max(newest, field.since);
  CHECK(newest == kSuperelementVersion);
  for (std::int64_t version = kFirstVersion; version <= newest; ++version) {
    CHECK(log.find("\n| " + std::to_string(version) + " | ") != std::string::npos);
  }
  CHECK(log.find("\n| " + std::to_string(newest + 1) + " | ") == std::string::npos);
}

TEST_CASE("a version has the fields of those before it, and a superelement the version that it needs") {
  CHECK(superelement_fields(0).empty());
  CHECK(superelement_fields(1).size() == 36);
  CHECK(superelement_fields(2).size() == 40);
  CHECK(superelement_fields(3).size() == 54);
  CHECK(superelement_fields(4).size() == 62);
  CHECK(superelement_fields(5).size() == 64);
  CHECK(superelement_fields(6).size() == 65);
  CHECK(superelement_fields(7).size() == 67);
  Superelement body = testing::make_two_armed_body();
  CHECK(find_version(body) == 7);
  CHECK(superelement_fields(body).size() == 67);
  body.certificate->soft_static_share.resize(0);
  CHECK(find_version(body) == 6);
  body.certificate->soft_reference.resize(0, 0);
  CHECK(find_version(body) == 5);
  body.section_sizes.reset();
  CHECK(find_version(body) == 4);
  body.section_loads.reset();
  body.point_deflections.reset();
  CHECK(find_version(body) == 3);
  body.certificate.reset();
  CHECK(find_version(body) == 2);
  body.geometric_stiffness.reset();
  CHECK(find_version(body) == 1);
}

TEST_CASE("the extents of a shape are products of its numbers and counts, if all counts are known") {
  const SuperelementField field{"/x", FieldType::kMatrices, "3p×2×m", "", {}};
  FieldCounts counts = {{'1', 1}, {'p', 4}};
  CHECK(calc_extents(field, counts) == std::vector<std::int64_t>{12, 2, -1});
  add_counts(field, {12, 2, 7}, counts);
  CHECK(counts == FieldCounts{{'1', 1}, {'p', 4}, {'m', 7}});
  CHECK(calc_extents(field, counts) == std::vector<std::int64_t>{12, 2, 7});
}

// The fault of the body with a changed value of a field.
std::string find_fault_with(const SuperelementField& field, FieldValue value) {
  Superelement body = testing::make_two_armed_body();
  field.member.set(body, value);
  const std::optional<SuperelementFault> fault = find_fault(body);
  return fault ? fault->dataset + " " + fault->message : "none";
}

TEST_CASE("NaN in any real field is a fault, in each of its matrices") {
  const Superelement body = testing::make_two_armed_body();
  for (const SuperelementField& field : superelement_fields()) {
    const FieldValue value = field.member.get(body).copied();
    for (std::size_t i = 0; i < value.reals.size(); ++i) {
      FieldValue changed = value;
      changed.reals[i](0, 0) = std::numeric_limits<double>::quiet_NaN();
      CHECK(find_fault_with(field, changed) == std::string(field.path) + " contains NaN or infinity");
    }
  }
}

TEST_CASE("a value that violates the rule of its field is a fault") {
  const Superelement body = testing::make_two_armed_body();
  int num_rules = 0;
  for (const SuperelementField& field : superelement_fields()) {
    if (field.rule == FieldRule::kAny || field.rule == FieldRule::kIndex) continue;
    ++num_rules;
    const FieldValue value = field.member.get(body).copied();
    const std::string path(field.path);
    FieldValue changed = value;
    for (std::size_t i = 0; i < value.reals.size(); ++i) {
      changed = value;
      if (field.rule == FieldRule::kPositive || field.rule == FieldRule::kNotNegative) {
        changed.reals[i](0, 0) = -0.5;
        CHECK_THAT(find_fault_with(field, changed), StartsWith(path + " is -0.5"));
      } else {
        changed.reals[i](0, 1) += 1e6;
        CHECK_THAT(
            find_fault_with(field, changed),
            StartsWith(path + (field.rule == FieldRule::kSkew ? " is not skew" : " is not symmetric")));
      }
      if (field.rule == FieldRule::kPositiveDefinite) {
        changed.reals[i](1, 0) += 1e6;
        CHECK(find_fault_with(field, changed) == path + " is not positive definite");
      }
    }
  }
  CHECK(num_rules > 20);
}

TEST_CASE("a matrix or list of another size is a fault") {
  const Superelement body = testing::make_two_armed_body();
  int num_changed = 0;
  for (const SuperelementField& field : superelement_fields()) {
    FieldValue value = field.member.get(body).copied();
    // Counts, columns of a list, and what has one size always.
    const bool is_count =
        field.path == "/nodes/id" || field.path == "/elements/node" || field.path == "/modes/frequency" ||
        field.path == "/stiffening/centrifugal" || field.path == "/provenance/input_name" ||
        field.path == "/certificate/free_frequency" || field.path == "/certificate/soft_load" ||
        field.path == "/certificate/soft_reference";
    const bool is_column = field.path.starts_with("/points") || field.path.starts_with("/checks") ||
                           field.path == "/nodes/position" || field.shape == "b";
    if (is_count || is_column || field.shape == "1" || field.shape == "2") continue;
    ++num_changed;
    CAPTURE(field.path);
    if (!value.reals.empty()) {
      support::RowMatrix& last = value.reals.back();
      if (last.cols() == 1) {
        last.conservativeResize(last.rows() + 1, Eigen::NoChange);
      } else if (last.rows() == 1 || last.rows() == 2) {
        last.conservativeResize(Eigen::NoChange, last.cols() - 1);
      } else {
        last.conservativeResize(last.rows() - 1, Eigen::NoChange);
      }
    }
    if (!value.integers.empty()) value.integers.pop_back();
    if (!value.texts.empty()) value.texts.pop_back();
    CHECK_THAT(find_fault_with(field, value), StartsWith(std::string(field.path) + " has "));
  }
  CHECK(num_changed > 20);
}

TEST_CASE("what contradicts the certificate is a fault") {
  const auto fault_of = [](const std::function<void(Superelement&)>& change) {
    Superelement body = testing::make_two_armed_body();
    change(body);
    const std::optional<SuperelementFault> fault = find_fault(body);
    return fault ? fault->dataset + " " + fault->message : "none";
  };
  CHECK(fault_of([](Superelement& s) { s.kind[1] = "bent"; }) ==
        "/modes/kind is 'bent' for mode 2, expected free, residual, clamped, fixed-interface or constraint");
  CHECK(fault_of([](Superelement& s) {
          s.kind.clear();
          s.certificate.reset();
        }) == "/section_loads stands without the certificate of version 3");
  CHECK(fault_of([](Superelement& s) {
          s.section_loads.reset();
          s.point_deflections.reset();
        }) == "/sections stands without the section loads of version 4");
  CHECK(fault_of([](Superelement& s) { s.section_sizes.reset(); }) ==
        "/section_loads stands without the sizes of sections of version 5");
  CHECK(fault_of([](Superelement& s) { s.certificate->soft_reference.conservativeResize(1, 3); }) ==
        "/certificate/soft_reference has 1×3 values, expected 7×3");
  CHECK(fault_of([](Superelement& s) { s.certificate->soft_static_share.conservativeResize(1); }) ==
        "/certificate/soft_static_share has 1×1 values, expected 1×7");
  CHECK(fault_of([](Superelement& s) { s.certificate->soft_static_share(2) = 1.5; }) ==
        "/certificate/soft_static_share is 1.5, expected 0 … 1");
  CHECK(fault_of([](Superelement& s) { s.section_loads.reset(); }) ==
        "/deflections stands without the section loads");
  CHECK(fault_of([](Superelement& s) { s.point_deflections.reset(); }) ==
        "/section_loads stands without the deflections");
  CHECK(fault_of([](Superelement& s) { s.certificate.reset(); }) ==
        "/modes/kind stands without a certificate");
  CHECK(fault_of([](Superelement& s) { s.geometric_stiffness.reset(); }) ==
        "/certificate stands without the geometric stiffness of version 2");
  CHECK(fault_of([](Superelement& s) { s.certificate->interface[0].point = 2; }) ==
        "/certificate/interface_point is 2, expected 0 … 1");
  CHECK(fault_of([](Superelement& s) { s.certificate->interface[0].freedom = 3; }) ==
        "/certificate/interface_freedom is 3, expected 0, 1 or 2");
}

}  // namespace
}  // namespace sprung::reduce
