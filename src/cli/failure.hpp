#pragma once

#include <exception>
#include <string>

#include "core/error.hpp"

namespace weft::cli {

/// What to tell the user of an exception, and the caller of the program.
struct Failure {
  ExitCode code = ExitCode::internal;
  std::string text;
};

/// Any exception at all: those that are not an Error are our own fault.
Failure describe_failure(const std::exception_ptr& exception);

/// Prints it on standard error.
void report(const Failure& failure);

}  // namespace weft::cli
