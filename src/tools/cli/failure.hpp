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

/// Accepts any exception. An error of std::filesystem counts as output_failed, or as usage if a name is too long; other
/// exceptions that are not an Error count as internal errors.
Failure describe_failure(const std::exception_ptr& exception);

/// Prints the message on standard error.
void report(const Failure& failure);

}  // namespace weft::cli
