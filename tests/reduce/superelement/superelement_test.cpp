#include "reduce/superelement/superelement.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <set>
#include <stdexcept>

#include "reduce/superelement/superelement_fields.h"
#include "reduce/superelement/superelement_hash.h"
#include "tests/catch.h"
#include "tests/reduce/superelement/hdf5_tampering.h"
#include "tests/reduce/test_bodies.h"

namespace sprung::reduce {
namespace {

using support::InputError;
using testing::make_two_armed_body;
using testing::message_of;
using testing::read_bytes;

TEST_CASE("a superelement is read as it was written") {
  const Superelement a = make_two_armed_body();
  const std::string hash = write_superelement(a, "round_trip.h5");
  const Superelement b = read_superelement("round_trip.h5");
  CHECK(b.content_hash == hash);
  CHECK(hash.size() == 64);
  CHECK(b.name == a.name);
  CHECK(b.num_elastic_dofs == a.num_elastic_dofs);
  REQUIRE(b.geometric_stiffness);
  CHECK(b.geometric_stiffness->num_modes() == 7);
  for (const SuperelementField& field : superelement_fields()) {
    CAPTURE(field.path);
    const FieldValue written = field.member.get(a).copied(), read = field.member.get(b).copied();
    CHECK(read.reals == written.reals);
    CHECK(read.integers == written.integers);
    CHECK(read.texts == written.texts);
    CHECK_FALSE((read.reals.empty() && read.integers.empty() && read.texts.empty()));
  }
  // The member of a field, for one field of each kind, written by hand and not by the field table.
  CHECK(b.node_ids == a.node_ids);
  CHECK(b.node_positions == a.node_positions);
  REQUIRE(b.points.size() == 2);
  CHECK(b.points[1].name == "tip");
  CHECK(b.points[1].node == 5);
  CHECK(b.elements == a.elements);
  CHECK(b.cluster == a.cluster);
  CHECK(b.shapes == a.shapes);
  CHECK(b.inertia.mass == a.inertia.mass);
  CHECK(b.inertia.first_moment == a.inertia.first_moment);
  CHECK(b.inertia.P == a.inertia.P);
  CHECK(b.inertia.c == a.inertia.c);
  CHECK(b.geometric_stiffness->acceleration == a.geometric_stiffness->acceleration);
  CHECK(b.geometric_stiffness->point_loads == a.geometric_stiffness->point_loads);
  CHECK(b.checks[2].name == a.checks[2].name);
  CHECK(b.checks[2].value == a.checks[2].value);
  CHECK(b.checks[2].tolerance == a.checks[2].tolerance);
  CHECK(b.provenance.design_text == a.provenance.design_text);
  CHECK(b.provenance.input_names == a.provenance.input_names);
  CHECK(b.provenance.program_version == "9.8.7");
  CHECK(b.provenance.algorithm_revision == 3);
  CHECK(find_point(b, "tip") == 5);
  CHECK(find_point(b, "top") == -1);
}

TEST_CASE("a design text beyond 64 KiB and a body without points or mesh files are written too") {
  Superelement a = make_two_armed_body();
  a.points.clear();
  a.section_sizes.reset();
  a.section_loads.reset();
  a.point_deflections.reset();
  a.certificate->interface.clear();
  a.certificate->soft_loads.resize(0, 0);
  a.certificate->soft_reference.resize(0, 3);
  a.certificate->soft_radial.resize(0);
  a.certificate->soft_static_share.resize(0);
  a.geometric_stiffness->point_loads.clear();
  a.checks.clear();
  a.provenance.input_names.clear();
  a.provenance.input_hashes.clear();
  a.provenance.design_text = std::string(100000, '#');
  write_superelement(a, "sparse.h5");
  const Superelement b = read_superelement("sparse.h5");
  CHECK(b.points.empty());
  CHECK_FALSE(b.section_loads.has_value());  // of version 6 nevertheless
  CHECK(b.certificate->soft_reference.cols() == 3);
  CHECK(b.geometric_stiffness->point_loads.empty());
  CHECK(b.checks.empty());
  CHECK(b.provenance.input_names.empty());
  CHECK(b.provenance.design_text == a.provenance.design_text);
}

TEST_CASE("a file of any version is read, and written again as it was") {
  // Each made by the program of that version: three modes of a bent arm of three elements; that of version 7
  // as "free", since only a basis with a bound has its soft modes.
  for (int version = 1; version <= kSuperelementVersion; ++version) {
    CAPTURE(version);
    const std::string path =
        testing::source_path("tests/reduce/data/version_" + std::to_string(version) + ".h5");
    const Superelement old = read_superelement(path);
    CHECK(old.geometric_stiffness.has_value() == (version >= 2));
    CHECK(old.certificate.has_value() == (version >= 3));
    CHECK(old.section_loads.has_value() == (version >= 4));
    CHECK(old.section_sizes.has_value() == (version >= 5));
    CHECK((old.certificate && old.certificate->soft_reference.cols() == 3) == (version >= 6));
    CHECK(old.num_modes() == 3);
    CHECK((old.certificate && old.certificate->soft_static_share.size() > 0) == (version >= 7));
    CHECK(old.provenance.algorithm_revision == (version < 6 ? version : version + 3));
    CHECK(find_point(old, "tip") == 2);
    CHECK(write_superelement(old, "again.h5") == old.content_hash);
    CHECK(read_bytes("again.h5") == read_bytes(path));
  }
}

TEST_CASE("equal superelements give equal bytes") {
  const Superelement body = make_two_armed_body();
  write_superelement(body, "bytes_a.h5");
  write_superelement(make_two_armed_body(), "bytes_b.h5");
  CHECK(read_bytes("bytes_a.h5") == read_bytes("bytes_b.h5"));
  CHECK(read_bytes("bytes_a.h5").size() > 10000);
}

TEST_CASE("every part of a superelement enters its hash") {
  const Superelement body = make_two_armed_body();
  const std::string hash = write_superelement(body, "hash.h5");
  CHECK(calc_content_hash(body) == hash);
  const std::pair<const char*, std::function<void(Superelement&)>> changes[] = {
      {"name", [](Superelement& s) { s.name = "other"; }},
      {"freedoms", [](Superelement& s) { s.num_elastic_dofs += 1; }},
      {"no stiffening",
       [](Superelement& s) {
         s.geometric_stiffness.reset();
         s.certificate.reset();
         s.section_sizes.reset();
         s.section_loads.reset();
         s.point_deflections.reset();
         s.kind.clear();
       }},
      {"program", [](Superelement& s) { s.provenance.program_version += "x"; }},
      {"revision", [](Superelement& s) { s.provenance.algorithm_revision = 4; }}};
  for (const auto& [part, change] : changes) {
    CAPTURE(part);
    Superelement changed = body;
    change(changed);
    CHECK(write_superelement(changed, "hash.h5") != hash);
    CHECK(read_superelement("hash.h5").content_hash != hash);
  }
}

TEST_CASE("every single value of a field enters the hash") {
  const Superelement body = make_two_armed_body();
  std::set<std::string> hashes = {calc_content_hash(body)};
  std::size_t num_values = 0;
  for (const SuperelementField& field : superelement_fields()) {
    CAPTURE(field.path);
    const auto change = [&](const std::function<void(FieldValue&)>& change_value) {
      Superelement changed = body;
      FieldValue value = field.member.get(body).copied();
      change_value(value);
      field.member.set(changed, value);
      hashes.insert(calc_content_hash(changed));
      CHECK(hashes.size() == ++num_values + 1);  // another one than all before
    };
    const FieldValue value = field.member.get(body).copied();
    for (std::size_t i = 0; i < value.reals.size(); ++i) {
      for (Eigen::Index k = 0; k < value.reals[i].size(); ++k) {
        change([&](FieldValue& changed) {
          double& number = changed.reals[i].data()[k];
          number = number == 0.0 ? 1e-9 : 1.5 * number;
        });
      }
    }
    for (std::size_t i = 0; i < value.integers.size(); ++i) {
      change([&](FieldValue& changed) { changed.integers[i] += 70; });
    }
    for (std::size_t i = 0; i < value.texts.size(); ++i) {
      change([&](FieldValue& changed) { changed.texts[i] += "x"; });
    }
  }
  CHECK(num_values > 1000);
}

TEST_CASE("an inconsistent superelement is not written") {
  const Superelement body = make_two_armed_body();
  const auto fault = [&](const std::function<void(Superelement&)>& change) {
    Superelement changed = body;
    change(changed);
    return message_of<std::invalid_argument>([&] { write_superelement(changed, "never.h5"); });
  };
  CHECK_THAT(fault([](Superelement& s) { s.name.clear(); }), Contains("'name' is empty"));
  CHECK_THAT(fault([](Superelement& s) { s.node_ids[1] = s.node_ids[0]; }),
             Contains("/nodes/id' has node 1 twice"));
  CHECK_THAT(fault([](Superelement& s) { s.points[1].name = "foot"; }),
             Contains("has the name 'foot' twice"));
  CHECK_THAT(fault([](Superelement& s) { s.points[1].node = 6; }),
             Contains("has node 6 for point 'tip', expected 0 … 5"));
  CHECK_THAT(fault([](Superelement& s) { s.elements(0, 0) = s.elements(1, 0); }),
             Contains("/elements/node'"));
  CHECK_THAT(fault([](Superelement& s) { s.element_sections.pop_back(); }), Contains("/elements/section'"));
  CHECK_THAT(fault([](Superelement& s) { s.frequency_hz(0) = 0.0; }),
             Contains("is 0 Hz for mode 1, expected > 0"));
  CHECK_THAT(fault([](Superelement& s) { s.frequency_hz.row(0).swap(s.frequency_hz.row(3)); }),
             Contains("falls from"));
  CHECK_THAT(fault([](Superelement& s) { s.damping_ratio(2) = -0.1; }),
             Contains("is -0.1 for mode 3, expected ≥ 0"));
  CHECK_THAT(fault([](Superelement& s) { s.cluster(0) = 5; }), Contains("/modes/cluster'"));
  CHECK_THAT(fault([](Superelement& s) { s.num_elastic_dofs = 6; }), Contains("num_elastic_dofs is 6"));
  CHECK_THAT(fault([](Superelement& s) { s.shapes(0, 0) = std::numeric_limits<double>::quiet_NaN(); }),
             Contains("/modes/shape' contains NaN"));
  CHECK_THAT(fault([](Superelement& s) { s.stiffness(0, 1) += 1.0; }),
             Contains("/matrices/stiffness' is not symmetric"));
  CHECK_THAT(fault([](Superelement& s) { s.mass(0, 1) = s.mass(1, 0) = 2.0; }),
             Contains("/matrices/mass' is not positive definite"));
  CHECK_THAT(fault([](Superelement& s) { s.inertia.mass = -1.0; }),
             Contains("/inertia/mass' is -1 kg, expected > 0"));
  CHECK_THAT(fault([](Superelement& s) { s.inertia.second_moment = 1e-3; }),
             Contains("/inertia/second_moment'"));
  CHECK_THAT(fault([](Superelement& s) { s.inertia.B(0, 1) += 1.0; }), Contains("/inertia/B' is not skew"));
  CHECK_THAT(fault([](Superelement& s) { s.inertia.P.conservativeResize(2, 6); }),
             Contains("/inertia/P' has 2×6 values, expected 2×7"));
  CHECK_THAT(fault([](Superelement& s) { s.resultants.conservativeResize(29, 7); }),
             Contains("/resultants'"));
  CHECK_THAT(fault([](Superelement& s) { s.geometric_stiffness->centrifugal(0, 1) += 1.0; }),
             Contains("/stiffening/centrifugal' is not symmetric"));
  CHECK_THAT(fault([](Superelement& s) { s.geometric_stiffness->centrifugal.setZero(8, 8); }),
             Contains("/stiffening/centrifugal' is of 8 modes, expected 1 … 7"));
  CHECK_THAT(fault([](Superelement& s) { s.geometric_stiffness->acceleration[1].setZero(6, 6); }),
             Contains("/stiffening/acceleration' has 6×6 values, expected 7×7"));
  CHECK_THAT(fault([](Superelement& s) { s.geometric_stiffness->point_loads.pop_back(); }),
             Contains("/stiffening/point_load' is of 1 points, expected 2"));
  CHECK_THAT(fault([](Superelement& s) { s.provenance.input_hashes.clear(); }),
             Contains("/provenance/input_hash'"));
  CHECK_FALSE(std::filesystem::exists("never.h5"));
  CHECK_FALSE(std::filesystem::exists("never.h5.tmp"));
}

}  // namespace
}  // namespace sprung::reduce
