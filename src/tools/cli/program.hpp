#pragma once

#include "core/error.hpp"
#include "tools/cli/options.hpp"

namespace weft::cli {

/// Runs the command line given to main() and returns the exit code. Never throws. Commands that do not make films are
/// passed to `run_other`.
int run_program(int argc, char** argv, ExitCode (*run_other)(const Command& command, char** argv)) noexcept;

/// Runs a command that makes no film, in this process. Linked only into the tools program.
ExitCode run_tool(const Command& command, char** argv);

/// Replaces this process by the tools program beside it. Throws Error(usage) if the tools program cannot be started.
ExitCode become_tools(const Command& command, char** argv);

}  // namespace weft::cli
