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

/// The same for frames that are only read from `cache`. An internal error in drawing them means that the cache is
/// broken (asset_unreadable), except if memory has run out.
Failure describe_replay_failure(const std::exception_ptr& exception, const std::string& cache);

/// Prints the message on standard error.
void report(const Failure& failure);

}  // namespace weft::cli
