#pragma once

#include <optional>
#include <string>

#include "reduce/superelement/superelement.h"
#include "reduce/superelement/superelement_fields.h"

namespace sprung::reduce {

/// What is wrong with a superelement, and where.
struct SuperelementFault {
  std::string dataset;  ///< as the file calls it (reduce/superelement/superelement.md)
  std::string message;
};

/// The first thing found wrong: the fields' shapes and rules (superelement_fields.h), then the rules between
/// them: indices in range, distinct names, ascending frequencies, a possible second moment. The writer does
/// not write a superelement with a fault, and the reader does not return one.
std::optional<SuperelementFault> find_fault(const Superelement& superelement);
/// @param[out] values  of its fields, for the hash and the file: large ones take time to make. None where
/// parts are missing
std::optional<SuperelementFault> find_fault(const Superelement& superelement, FieldValues& values);

}  // namespace sprung::reduce
