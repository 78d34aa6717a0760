#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "reduce/superelement/superelement.h"
#include "tools/support/hdf5/row_matrix.h"

namespace sprung::reduce {

/// The values of a field. One of the four is used, by its type.
struct FieldValue {
  std::vector<support::RowMatrix> reals = {};  ///< the matrix or vector; of kMatrices, each matrix
  std::vector<std::int64_t> integers = {};     ///< row-major
  std::vector<std::string> texts = {};
  /// In place of `reals` a large matrix where it stands in the superelement, which has to live as long.
  const support::RowMatrix* standing = nullptr;

  /// What is in `reals`, or stands in the superelement.
  std::span<const support::RowMatrix> matrices() const {
    return standing != nullptr ? std::span(standing, 1) : std::span(reals);
  }
  /// The same with all matrices in `reals`.
  FieldValue copied() const { return {{matrices().begin(), matrices().end()}, integers, texts}; }
};

/// kReals is one matrix or vector of the struct; in an array of rank 3 its rows stand in groups. kMatrices is
/// several matrices of the struct, in an array of rank 3.
enum class FieldType { kReals, kMatrices, kIntegers, kTexts };

/// What the values must be. Reals are finite in any case; an index is ≥ 0 and fits 31 bits.
enum class FieldRule { kAny, kPositive, kNotNegative, kIndex, kSymmetric, kSkew, kPositiveDefinite };

/// How the values enter the content hash. All but kWhole keep an order of version 1: a new field is kWhole.
enum class FieldHash { kWhole, kRows, kPoints, kRigidInertia, kChecks, kWithPrevious };

/// The member of the struct that holds a field.
struct FieldMember {
  FieldValue (*get)(const Superelement&);
  void (*set)(Superelement&, FieldValue&);  ///< the value has the field's shape; it is of no use afterwards
};

/// A dataset of the superelement file: writer, reader, content hash and faults follow it.
struct SuperelementField {
  std::string_view path;
  FieldType type;
  std::string_view shape;  ///< as superelement.md writes it: "N×2", "3p×m×m"
  std::string_view unit;   ///< attribute of the dataset; "" for integers and texts, which have none
  FieldMember member;
  FieldRule rule = FieldRule::kAny;
  FieldHash hash = FieldHash::kWhole;
  std::int64_t since = kFirstVersion;  ///< first version of the format that has the field
};

/// All fields of a version of the format, in the order of the file and of the hash.
std::vector<SuperelementField> superelement_fields(std::int64_t version = kSuperelementVersion);

/// Version of the file that a superelement is written to.
std::int64_t find_version(const Superelement& superelement);

/// Whether a file without section loads lacks a field: from version 6 on they, deflections and sizes of
/// sections may be missing together. @param version  of the file
bool is_of_section_loads(const SuperelementField& field, std::int64_t version);

/// The fields that a superelement's file has.
std::vector<SuperelementField> superelement_fields(const Superelement& superelement);

/// The values of a superelement's fields, in the order of superelement_fields(superelement).
using FieldValues = std::vector<FieldValue>;
/// @param superelement  with all parts of its version (find_fault)
FieldValues get_values(const Superelement& superelement);

/// What the letters of the shapes stand for (superelement.md); '1' stands for itself.
using FieldCounts = std::map<char, std::int64_t>;
FieldCounts count_parts(const Superelement& superelement);

/// Extents of a field's dataset; -1 where a count is not known.
std::vector<std::int64_t> calc_extents(const SuperelementField& field, const FieldCounts& counts);

/// Takes the counts that were not known from the extents of a field's dataset.
void add_counts(const SuperelementField& field, const std::vector<std::int64_t>& extents,
                FieldCounts& counts);

/// Number and size of the matrices of `FieldValue::matrices`; a vector is one column. The number is 0 for
/// integers and texts.
struct FieldMatrices {
  std::int64_t number, rows, columns;
};
FieldMatrices calc_matrices(const SuperelementField& field, std::vector<std::int64_t> extents);

}  // namespace sprung::reduce
