// Starts other programs, or this program again.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace weft::cli {

/// File name of the tools program, which has the commands that `weft` does not have.
inline constexpr const char* kToolsName = "weft-tools";

/// Path of the program `weft`: the running program or, if that is the tools program, `weft` in the
/// same folder. Throws Error(usage) if /proc is not mounted.
std::filesystem::path own_program();

/// The text in quotes, as one word of a shell.
std::string quoted(const std::string& text);

/// Starts the program `arguments[0]` with empty standard input. Searches the program in PATH as a
/// shell does. Standard output and standard error of the program go to the file `log` or, if `log`
/// is empty, to those of this process. The kernel kills the program when the calling thread ends.
/// Throws Error(output_failed) if the program cannot be started or `log` cannot be written.
pid_t start_process(const std::vector<std::string>& arguments, const std::filesystem::path& log);

struct ProcessResult {
  int exit_code = 0;   ///< 127: not started; 128 + n: ended by signal n
  std::string output;  ///< standard output; standard error goes to that of this process
};

/// Runs a program and waits for its end. Throws Error(output_failed) only if it cannot create a pipe for the output.
ProcessResult run_process(const std::vector<std::string>& arguments);

}  // namespace weft::cli
