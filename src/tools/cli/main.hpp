// What main() of each of the two programs calls. Includes nothing, so that main.cpp compiles at once.
#pragma once

namespace weft::cli {

/// Runs the command line given to main() and returns the exit code; never throws. Passes commands that only the tools
/// program has on to it.
int run_weft(int argc, char** argv) noexcept;

/// The same with all commands. Linked only into the tools program.
int run_weft_tools(int argc, char** argv) noexcept;

}  // namespace weft::cli
