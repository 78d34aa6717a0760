#pragma once

#include <span>
#include <string>

#include "reduce/inspection/comparison.h"
#include "reduce/superelement/superelement.h"

namespace sprung::reduce {

// The tables of superelement_tables.h as JSON objects for other programs, SI units named in the keys, all
// digits. Numbers that are not finite are null.
std::string format_superelement_json(const Superelement& superelement, std::span<const CheckResult> checks);
std::string format_checks_json(const std::string& path, std::span<const CheckResult> checks);
std::string format_comparison_json(const Comparison& comparison);

}  // namespace sprung::reduce
