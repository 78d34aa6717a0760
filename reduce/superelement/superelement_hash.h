#pragma once

#include <string>

#include "reduce/superelement/superelement.h"
#include "reduce/superelement/superelement_fields.h"

namespace sprung::reduce {

/// SHA-256 of everything a superelement says, in the order of reduce/superelement/superelement.md;
/// `content_hash` is not part of it.
/// @return 64 hexadecimal digits
std::string calc_content_hash(const Superelement& superelement);
/// @param values  of its fields
std::string calc_content_hash(const Superelement& superelement, const FieldValues& values);

}  // namespace sprung::reduce
