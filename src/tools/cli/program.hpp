#pragma once

#include "core/error.hpp"
#include "tools/cli/options.hpp"

namespace weft::cli {

/// Runs the command line given to main() and returns the exit code. Never throws. The commands of run_tool() are passed
/// to `run_other`.
int run_program(int argc, char** argv, ExitCode (*run_other)(const Command& command, char** argv)) noexcept;

/// Runs, in this process, a command that only the tools program has: join, sweep, farm, doctor, bench, diff, accept,
/// review or export. Linked only into the tools program.
ExitCode run_tool(const Command& command, char** argv);

/// Replaces this process by the tools program beside it. Throws Error(usage) if the tools program cannot be started.
ExitCode become_tools(const Command& command, char** argv);

}  // namespace weft::cli
