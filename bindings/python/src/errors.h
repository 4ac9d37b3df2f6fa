// Failures of the library as Python's exceptions.
#pragma once

#include <nanobind/nanobind.h>

#include <string>

namespace reeb_python {

/// A failure with a reeb_result (StatusCode has the same numbers); becomes the exception that
/// belongs to it.
struct Failure {
  int code;
  std::string message;
};

/// Makes the exceptions and how failures become them.
void add_errors(nanobind::module_& module);

}  // namespace reeb_python
