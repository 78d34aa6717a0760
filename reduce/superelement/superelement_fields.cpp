#include "reduce/superelement/superelement_fields.h"

#include <algorithm>
#include <type_traits>

namespace sprung::reduce {

namespace {

using support::RowMatrix;
using I = InertiaInvariants;
using G = GeometricStiffness;
using C = Certificate;
using E = InterfaceError;
using L = UnitLoads;
using A = SectionSizes;
using S = Superelement;

// Each type of member as a value of the file, and back.

template <typename Value>
FieldValue pack(const std::vector<Value>& values) {
  if constexpr (std::is_same_v<Value, std::string>) {
    return {.texts = values};
  } else if constexpr (std::is_integral_v<Value>) {
    return {.integers = {values.begin(), values.end()}};
  } else {
    return {
        .reals = {Eigen::Map<const RowMatrix>(values.data(), static_cast<Eigen::Index>(values.size()), 1)}};
  }
}

FieldValue pack(double number) {
  return pack(std::vector{number});
}

FieldValue pack(const std::string& text) {
  return pack(std::vector{text});
}

template <typename Derived>
FieldValue pack(const Eigen::MatrixBase<Derived>& matrix) {
  return {.reals = {RowMatrix(matrix)}};
}

FieldValue pack(const RowMatrix& matrix) {
  return {.standing = &matrix};
}

template <int Rows, int Columns>
FieldValue pack(const Eigen::Matrix<int, Rows, Columns>& matrix) {  // a column is a row of the file
  return {.integers = {matrix.data(), matrix.data() + matrix.size()}};
}

FieldValue pack(const std::array<Eigen::MatrixXd, 2>& matrices) {
  return {.reals = {matrices.begin(), matrices.end()}};
}

FieldValue pack(const std::vector<std::array<Eigen::MatrixXd, 3>>& matrices) {
  FieldValue value;
  for (const auto& three : matrices) value.reals.insert(value.reals.end(), three.begin(), three.end());
  return value;
}

template <typename Value>
void unpack(const FieldValue& value, std::vector<Value>& values) {
  if constexpr (std::is_same_v<Value, std::string>) {
    values = value.texts;
  } else if constexpr (std::is_integral_v<Value>) {
    values.assign(value.integers.begin(), value.integers.end());
  } else {
    values.assign(value.reals.front().data(), value.reals.front().data() + value.reals.front().size());
  }
}

void unpack(const FieldValue& value, double& number) {
  number = value.reals.front()(0, 0);
}

void unpack(const FieldValue& value, std::string& text) {
  text = value.texts.front();
}

template <typename Derived>
void unpack(const FieldValue& value, Eigen::PlainObjectBase<Derived>& matrix) {
  if constexpr (Derived::RowsAtCompileTime == 1) {
    const RowMatrix& values = value.reals.front();  // a column in the file
    matrix = Eigen::Map<const Derived>(values.data(), 1, values.size());
  } else {
    matrix = value.reals.front();
  }
}

void unpack(FieldValue& value, RowMatrix& matrix) {  // large: not copied
  matrix.swap(value.reals.front());
}

template <int Rows, int Columns>
void unpack(const FieldValue& value, Eigen::Matrix<int, Rows, Columns>& matrix) {
  const auto size = static_cast<Eigen::Index>(value.integers.size());
  matrix.resize(Rows == 2 ? 2 : size, Rows == 2 ? size / 2 : 1);
  std::copy(value.integers.begin(), value.integers.end(), matrix.data());
}

void unpack(const FieldValue& value, std::array<Eigen::MatrixXd, 2>& matrices) {
  std::copy(value.reals.begin(), value.reals.end(), matrices.begin());
}

void unpack(const FieldValue& value, std::vector<std::array<Eigen::MatrixXd, 3>>& matrices) {
  matrices.resize(value.reals.size() / 3);
  for (std::size_t i = 0; i < value.reals.size(); ++i) matrices[i / 3][i % 3] = value.reals[i];
}

// A member of the struct, of a part of it, of a part that may be missing, and of each record of a list.

template <auto Member>
constexpr FieldMember member = {[](const S& s) { return pack(s.*Member); },
                                [](S& s, FieldValue& value) { unpack(value, s.*Member); }};

template <auto Part, auto Member>
constexpr FieldMember member_of = {[](const S& s) { return pack((s.*Part).*Member); },
                                   [](S& s, FieldValue& value) { unpack(value, (s.*Part).*Member); }};

template <auto Part, auto Member>
constexpr FieldMember member_of_optional = {[](const S& s) { return pack((*(s.*Part)).*Member); },
                                            [](S& s, FieldValue& value) {
                                              if (!(s.*Part)) (s.*Part).emplace();
                                              unpack(value, (*(s.*Part)).*Member);
                                            }};

template <auto List, auto Member>
constexpr FieldMember column = {
    [](const S& s) {
      std::vector<std::remove_cvref_t<decltype((s.*List).front().*Member)>> values;
      for (const auto& record : s.*List) values.push_back(record.*Member);
      return pack(values);
    },
    [](S& s, FieldValue& value) {
      std::vector<std::remove_cvref_t<decltype((s.*List).front().*Member)>> values;
      unpack(value, values);
      (s.*List).resize(values.size());
      for (std::size_t i = 0; i < values.size(); ++i) (s.*List)[i].*Member = values[i];
    }};

template <auto Part, auto List, auto Member>
constexpr FieldMember column_of_optional = {
    [](const S& s) {
      std::vector<std::remove_cvref_t<decltype(((*(s.*Part)).*List).front().*Member)>> values;
      for (const auto& record : (*(s.*Part)).*List) values.push_back(record.*Member);
      return pack(values);
    },
    [](S& s, FieldValue& value) {
      if (!(s.*Part)) (s.*Part).emplace();
      auto& list = (*(s.*Part)).*List;
      std::vector<std::remove_cvref_t<decltype(list.front().*Member)>> values;
      unpack(value, values);
      list.resize(values.size());
      for (std::size_t i = 0; i < values.size(); ++i) list[i].*Member = values[i];
    }};

template <auto Member>
constexpr FieldMember inertia = member_of<&S::inertia, Member>;
template <auto Member>
constexpr FieldMember stiffening = member_of_optional<&S::geometric_stiffness, Member>;
template <auto Member>
constexpr FieldMember certificate = member_of_optional<&S::certificate, Member>;
template <auto Member>
constexpr FieldMember section_loads = member_of_optional<&S::section_loads, Member>;
template <auto Member>
constexpr FieldMember deflections = member_of_optional<&S::point_deflections, Member>;
template <auto Member>
constexpr FieldMember section_sizes = member_of_optional<&S::section_sizes, Member>;
template <auto Member>
constexpr FieldMember interface = column_of_optional<&S::certificate, &C::interface, Member>;

constexpr FieldMember kNodePositions = {  // a node is a column of the struct, a row of the file
    [](const S& s) { return pack(s.node_positions.transpose()); },
    [](S& s, FieldValue& value) { s.node_positions = value.reals.front().transpose(); }};

constexpr std::string_view kShapeUnit = "m, m, rad per unit modal coordinate (m·√kg)";
constexpr std::string_view kResultantUnit = "N, N, N·m per unit modal coordinate (m·√kg)";
constexpr std::string_view kPointLoadUnit = "N, N, N·m per N, N, N·m";
constexpr std::string_view kAccelerationLoadUnit = "N, N, N·m per m/s^2, m/s^2, rad/s^2, rad^2/s^2";
constexpr std::string_view kModalLoadUnit = "N, N, N·m per unit modal acceleration (m·√kg/s^2)";
constexpr std::string_view kPointDeflectionUnit = "m, m, rad per N, N, N·m";
constexpr std::string_view kAccelerationDeflectionUnit = "m, m, rad per m/s^2, m/s^2, rad/s^2, rad^2/s^2";
constexpr std::string_view kModalDeflectionUnit = "m, m, rad per unit modal acceleration (m·√kg/s^2)";
constexpr std::string_view kFlexibilityUnit = "m/N; rad/(N·m) of a rotation";
constexpr std::string_view kSoftLoadUnit = "1/√kg; 1/(m·√kg) of a rotation";
constexpr std::string_view kSoftReferenceUnit = "1/√kg, 1/√kg, 1/(m·√kg)";
constexpr std::string_view kLoadUnit = "1/(kg·m), 1/(kg·m), 1/(kg·m^2)";

using enum FieldType;
using enum FieldRule;
using enum FieldHash;

// clang-format off
constexpr SuperelementField kFields[] = {
    {"/nodes/id", kIntegers, "N", "", member<&S::node_ids>},
    {"/nodes/position", kReals, "N×2", "m", kNodePositions},
    {"/points/name", kTexts, "p", "", column<&S::points, &NamedPoint::name>, kAny, kPoints},
    {"/points/node", kIntegers, "p", "", column<&S::points, &NamedPoint::node>, kIndex, kWithPrevious},
    {"/elements/node", kIntegers, "E×2", "", member<&S::elements>, kIndex, kRows},
    {"/elements/section", kTexts, "E", "", member<&S::element_sections>},
    {"/modes/frequency", kReals, "n", "Hz", member<&S::frequency_hz>, kPositive},
    {"/modes/damping_ratio", kReals, "n", "1", member<&S::damping_ratio>, kNotNegative},
    {"/modes/cluster", kIntegers, "n", "", member<&S::cluster>, kIndex, kRows},
    {"/modes/kind", kTexts, "n", "", member<&S::kind>, kAny, kWhole, kCertificateVersion},
    {"/modes/shape", kReals, "N×3×n", kShapeUnit, member<&S::shapes>},
    {"/matrices/stiffness", kReals, "n×n", "1/s^2", member<&S::stiffness>, kPositiveDefinite},
    {"/matrices/mass", kReals, "n×n", "1", member<&S::mass>, kPositiveDefinite},
    {"/matrices/damping", kReals, "n×n", "1/s", member<&S::damping>, kSymmetric},
    {"/resultants", kReals, "E×6×n", kResultantUnit, member<&S::resultants>},
    {"/inertia/mass", kReals, "1", "kg", inertia<&I::mass>, kPositive, kRigidInertia},
    {"/inertia/first_moment", kReals, "2", "kg·m", inertia<&I::first_moment>, kAny, kWithPrevious},
    {"/inertia/second_moment", kReals, "1", "kg·m^2", inertia<&I::second_moment>, kAny, kWithPrevious},
    {"/inertia/P", kReals, "2×n", "√kg", inertia<&I::P>},
    {"/inertia/c", kReals, "n", "m·√kg", inertia<&I::c>},
    {"/inertia/d", kReals, "n", "m·√kg", inertia<&I::d>},
    {"/inertia/M_ff", kReals, "n×n", "1", inertia<&I::M_ff>, kPositiveDefinite},
    {"/inertia/B", kReals, "n×n", "1", inertia<&I::B>, kSkew},
    {"/inertia/x_phi_x", kReals, "n", "m·√kg", inertia<&I::x_phi_x>},
    {"/inertia/x_phi_y", kReals, "n", "m·√kg", inertia<&I::x_phi_y>},
    {"/inertia/y_phi_x", kReals, "n", "m·√kg", inertia<&I::y_phi_x>},
    {"/inertia/y_phi_y", kReals, "n", "m·√kg", inertia<&I::y_phi_y>},
    {"/inertia/phi_x_phi_x", kReals, "n×n", "1", inertia<&I::phi_x_phi_x>, kSymmetric},
    {"/inertia/phi_x_phi_y", kReals, "n×n", "1", inertia<&I::phi_x_phi_y>},
    {"/inertia/phi_y_phi_y", kReals, "n×n", "1", inertia<&I::phi_y_phi_y>, kSymmetric},
    {"/stiffening/centrifugal", kReals, "m×m", "1", stiffening<&G::centrifugal>, kSymmetric, kWhole, kStiffeningVersion},
    {"/stiffening/angular_acceleration", kReals, "m×m", "1", stiffening<&G::angular_acceleration>, kSymmetric, kWhole, kStiffeningVersion},
    {"/stiffening/acceleration", kMatrices, "2×m×m", "1/m", stiffening<&G::acceleration>, kSymmetric, kWhole, kStiffeningVersion},
    {"/stiffening/point_load", kMatrices, "3p×m×m", kLoadUnit, stiffening<&G::point_loads>, kSymmetric, kWhole, kStiffeningVersion},
    {"/certificate/highest_frequency", kReals, "1", "Hz", certificate<&C::highest_hz>, kPositive, kWhole, kCertificateVersion},
    {"/certificate/tolerance", kReals, "1", "1", certificate<&C::tolerance>, kNotNegative, kWhole, kCertificateVersion},
    {"/certificate/cutoff_frequency", kReals, "1", "Hz", certificate<&C::cutoff_hz>, kNotNegative, kWhole, kCertificateVersion},
    {"/certificate/rounding_floor", kReals, "1", "1", certificate<&C::rounding_floor>, kPositive, kWhole, kCertificateVersion},
    {"/certificate/free_frequency", kReals, "k", "Hz", certificate<&C::free_hz>, kPositive, kWhole, kCertificateVersion},
    {"/certificate/free_frequency_error", kReals, "k", "1", certificate<&C::free_error>, kNotNegative, kWhole, kCertificateVersion},
    {"/certificate/interface_point", kIntegers, "b", "", interface<&E::point>, kIndex, kWhole, kCertificateVersion},
    {"/certificate/interface_freedom", kIntegers, "b", "", interface<&E::freedom>, kIndex, kWhole, kCertificateVersion},
    {"/certificate/static_flexibility", kReals, "b", kFlexibilityUnit, interface<&E::static_flexibility>, kNotNegative, kWhole, kCertificateVersion},
    {"/certificate/static_error", kReals, "b", "1", interface<&E::static_error>, kNotNegative, kWhole, kCertificateVersion},
    {"/certificate/error", kReals, "b", "1", interface<&E::error>, kNotNegative, kWhole, kCertificateVersion},
    {"/certificate/worst_frequency", kReals, "b", "Hz", interface<&E::worst_hz>, kNotNegative, kWhole, kCertificateVersion},
    {"/certificate/soft_load", kReals, "q×b", kSoftLoadUnit, certificate<&C::soft_loads>, kAny, kWhole, kCertificateVersion},
    {"/section_loads/point_load", kReals, "E×6×3p", kPointLoadUnit, section_loads<&L::point_load>, kAny, kWhole, kSectionLoadVersion},
    {"/section_loads/acceleration", kReals, "E×6×4", kAccelerationLoadUnit, section_loads<&L::acceleration>, kAny, kWhole, kSectionLoadVersion},
    {"/section_loads/modal_acceleration", kReals, "E×6×n", kModalLoadUnit, section_loads<&L::modal_acceleration>, kAny, kWhole, kSectionLoadVersion},
    {"/section_loads/turned_acceleration", kReals, "E×6×n", kModalLoadUnit, section_loads<&L::turned_acceleration>, kAny, kWhole, kSectionLoadVersion},
    {"/deflections/point_load", kReals, "3p×3p", kPointDeflectionUnit, deflections<&L::point_load>, kSymmetric, kWhole, kSectionLoadVersion},
    {"/deflections/acceleration", kReals, "3p×4", kAccelerationDeflectionUnit, deflections<&L::acceleration>, kAny, kWhole, kSectionLoadVersion},
    {"/deflections/modal_acceleration", kReals, "3p×n", kModalDeflectionUnit, deflections<&L::modal_acceleration>, kAny, kWhole, kSectionLoadVersion},
    {"/deflections/turned_acceleration", kReals, "3p×n", kModalDeflectionUnit, deflections<&L::turned_acceleration>, kAny, kWhole, kSectionLoadVersion},
    {"/sections/area", kReals, "E", "m^2", section_sizes<&A::area>, kNotNegative, kWhole, kSectionSizeVersion},
    {"/sections/modulus", kReals, "E", "m^3", section_sizes<&A::modulus>, kNotNegative, kWhole, kSectionSizeVersion},
    {"/certificate/soft_reference", kReals, "q×3", kSoftReferenceUnit, certificate<&C::soft_reference>, kAny, kWhole, kSoftReferenceVersion},
    {"/certificate/soft_radial", kReals, "q", "m·√kg", certificate<&C::soft_radial>, kAny, kWhole, kSoftShareVersion},
    {"/certificate/soft_static_share", kReals, "q", "1", certificate<&C::soft_static_share>, kNotNegative, kWhole, kSoftShareVersion},
    {"/checks/name", kTexts, "c", "", column<&S::checks, &CheckResult::name>, kAny, kChecks},
    {"/checks/value", kReals, "c", "1", column<&S::checks, &CheckResult::value>, kAny, kWithPrevious},
    {"/checks/tolerance", kReals, "c", "1", column<&S::checks, &CheckResult::tolerance>, kAny, kWithPrevious},
    // Texts are datasets, not attributes: an attribute ends at 64 KiB and carries no checksum.
    {"/provenance/design_text", kTexts, "1", "", member_of<&S::provenance, &Provenance::design_text>, kAny, kRows},
    {"/provenance/design_hash", kTexts, "1", "", member_of<&S::provenance, &Provenance::design_hash>, kAny, kRows},
    {"/provenance/input_name", kTexts, "f", "", member_of<&S::provenance, &Provenance::input_names>},
    {"/provenance/input_hash", kTexts, "f", "", member_of<&S::provenance, &Provenance::input_hashes>},
};
// clang-format on

// A factor of a shape: a digit, a letter, or a digit times a letter.
struct Factor {
  std::int64_t number = 1;
  char letter = '1';
};

std::vector<Factor> parse_shape(std::string_view shape) {
  std::vector<Factor> factors(1);
  for (const char c : shape) {
    if (c == "×"[0]) factors.emplace_back();
    if (c >= '0' && c <= '9') factors.back().number = c - '0';
    if ((c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z')) factors.back().letter = c;
  }
  return factors;
}

}  // namespace

std::vector<SuperelementField> superelement_fields(std::int64_t version) {
  std::vector<SuperelementField> fields;
  std::copy_if(std::begin(kFields), std::end(kFields), std::back_inserter(fields),
               [&](const SuperelementField& field) { return field.since <= version; });
  return fields;
}

bool is_of_section_loads(const SuperelementField& field, std::int64_t version) {
  return version >= kSoftReferenceVersion &&
         (field.since == kSectionLoadVersion || field.since == kSectionSizeVersion);
}

std::vector<SuperelementField> superelement_fields(const Superelement& superelement) {
  const std::int64_t version = find_version(superelement);
  std::vector<SuperelementField> fields = superelement_fields(version);
  if (!superelement.section_loads)
    std::erase_if(fields,
                  [&](const SuperelementField& field) { return is_of_section_loads(field, version); });
  return fields;
}

std::int64_t find_version(const Superelement& superelement) {
  if (superelement.certificate && superelement.certificate->soft_reference.cols() > 0) {
    return superelement.certificate->soft_static_share.size() > 0 ? kSoftShareVersion : kSoftReferenceVersion;
  }
  if (superelement.section_loads && superelement.certificate && superelement.geometric_stiffness)
    return superelement.section_sizes ? kSectionSizeVersion : kSectionLoadVersion;
  if (superelement.certificate && superelement.geometric_stiffness) return kCertificateVersion;
  return superelement.geometric_stiffness ? kStiffeningVersion : kFirstVersion;
}

FieldValues get_values(const Superelement& superelement) {
  FieldValues values;
  for (const SuperelementField& field : superelement_fields(superelement))
    values.push_back(field.member.get(superelement));
  return values;
}

FieldCounts count_parts(const Superelement& s) {
  return {{'1', 1},
          {'N', s.num_nodes()},
          {'E', s.elements.cols()},
          {'p', static_cast<std::int64_t>(s.points.size())},
          {'n', s.num_modes()},
          {'m', s.geometric_stiffness ? s.geometric_stiffness->num_modes() : 0},
          {'k', s.certificate ? s.certificate->free_hz.size() : 0},
          {'b', s.certificate ? static_cast<std::int64_t>(s.certificate->interface.size()) : 0},
          {'q', s.certificate ? s.certificate->soft_loads.rows() : 0},
          {'c', static_cast<std::int64_t>(s.checks.size())},
          {'f', static_cast<std::int64_t>(s.provenance.input_names.size())}};
}

std::vector<std::int64_t> calc_extents(const SuperelementField& field, const FieldCounts& counts) {
  std::vector<std::int64_t> extents;
  for (const Factor& factor : parse_shape(field.shape)) {
    const auto count = counts.find(factor.letter);
    extents.push_back(count == counts.end() ? -1 : factor.number * count->second);
  }
  return extents;
}

void add_counts(const SuperelementField& field, const std::vector<std::int64_t>& extents,
                FieldCounts& counts) {
  const std::vector<Factor> factors = parse_shape(field.shape);
  for (std::size_t i = 0; i < factors.size(); ++i)
    counts.try_emplace(factors[i].letter, extents[i] / factors[i].number);
}

FieldMatrices calc_matrices(const SuperelementField& field, std::vector<std::int64_t> extents) {
  if (extents.size() == 1) extents.push_back(1);
  if (extents.size() == 2) extents.insert(extents.begin(), 1);
  if (field.type == FieldType::kMatrices) return {extents[0], extents[1], extents[2]};
  return {field.type == FieldType::kReals ? 1 : 0, extents[0] * extents[1], extents[2]};
}

}  // namespace sprung::reduce
