#pragma once

#include "core/error.hpp"
#include "tools/cli/options.hpp"

namespace weft::cli {

/// Runs a command line, and returns the exit code. Passes the commands that weft does not have (join, sweep, farm,
/// doctor, bench, diff, accept, review, export) to `run_other`.
int run_program(int argc, char** argv, ExitCode (*run_other)(const Command& command, char** argv)) noexcept;

}  // namespace weft::cli
