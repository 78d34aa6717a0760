#pragma once

// Catch2 version 3 where it is installed, version 2 otherwise, under version 2's names.
#if __has_include(<catch2/catch_all.hpp>)
#include <catch2/catch_all.hpp>
using Catch::Approx;
#else
#include <catch2/catch.hpp>
#endif
