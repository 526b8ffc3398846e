#pragma once

namespace weft::cli {

/// Runs one command line, as handed to main(), and returns the exit code. Never throws.
int run_program(int argc, char** argv) noexcept;

}  // namespace weft::cli
