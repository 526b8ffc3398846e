#pragma once

#include <exception>
#include <string>

#include "core/error.hpp"

namespace weft::cli {

/// Message and exit code of an exception.
struct Failure {
  ExitCode code = ExitCode::internal;
  std::string text;
};

/// Accepts any exception. An Error keeps its code. An error of std::filesystem gets output_failed, or usage if a file
/// name is too long. Any other exception is an internal error.
Failure describe_failure(const std::exception_ptr& exception);

/// Prints the message on standard error.
void report(const Failure& failure);

}  // namespace weft::cli
