#pragma once

#include <exception>
#include <string>

#include "core/error.hpp"

namespace weft::cli {

/// Message and exit code for an exception.
struct Failure {
  ExitCode code = ExitCode::internal;
  std::string text;
};

/// Accepts any exception; those that are not an Error count as internal errors.
Failure describe_failure(const std::exception_ptr& exception);

/// Prints the message on standard error.
void report(const Failure& failure);

}  // namespace weft::cli
