// The functions of fmt as a part of the program, which then needs no shared library of fmt. Each of them is
// inline here, and compiled although nothing in this file calls it (CMakeLists.txt).
#define FMT_HEADER_ONLY
#include <fmt/format.h>
