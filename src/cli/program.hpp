#pragma once

#include "cli/options.hpp"
#include "core/error.hpp"

namespace weft::cli {

/// Runs one command line, as handed to main(), and returns the exit code. Never throws. Commands that make no film go
/// to `run_other`.
int run_program(int argc, char** argv, ExitCode (*run_other)(const Command& command, char** argv)) noexcept;

/// Runs such a command itself: it is compiled into the program of tools alone.
ExitCode run_tool(const Command& command, char** argv);

/// Becomes the program of tools, which lies beside this one. Throws Error(usage) where it is not there.
ExitCode become_tools(const Command& command, char** argv);

}  // namespace weft::cli
