#pragma once

#include <string>

#include "tests/catch.h"

/// The message of the `Error` that `function` throws; another exception, or none, fails the test.
template <typename Error, typename Function>
std::string error_message(Function&& function) {
  try {
    function();
  } catch (const Error& error) {
    return error.what();
  }
  FAIL("nothing was thrown");
  return {};
}
