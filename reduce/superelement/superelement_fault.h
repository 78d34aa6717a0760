#pragma once

#include <optional>
#include <string>

#include "reduce/superelement/superelement.h"

namespace sprung::reduce {

/// What is wrong with a superelement, and where.
struct SuperelementFault {
  std::string dataset;  ///< as the file calls it (reduce/superelement/superelement.md)
  std::string message;
};

/// The first part that does not fit the others or cannot be: sizes, ranges of indices, finite values, signs,
/// symmetry, ascending frequencies, positive definite matrices. What the writer refuses to write and the
/// reader to return.
std::optional<SuperelementFault> find_fault(const Superelement& superelement);

}  // namespace sprung::reduce
