// Functions for main() of the programs weft and weft-tools. Includes no header, so that main.cpp compiles fast.
#pragma once

namespace weft::cli {

/// Runs the command line given to main(), and returns the exit code. For commands that only weft-tools has, replaces
/// this process by weft-tools.
int run_weft(int argc, char** argv) noexcept;

/// The same in weft-tools, which runs the commands that weft does not have.
int run_weft_tools(int argc, char** argv) noexcept;

}  // namespace weft::cli
