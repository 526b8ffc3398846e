// Starting other programs, or this one again.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace weft::cli {

/// File name of the tools program, which has all commands.
inline constexpr const char* kToolsName = "weft-tools";

/// Path of the program `weft`: the running one, or if this is the tools program, the one beside it.
std::filesystem::path own_program();

/// Starts `arguments[0]`, searched as by a shell, with empty input. Its standard output and standard error go to the
/// file `log`, or to this process's output if `log` is empty. The process is killed when the calling thread ends.
/// Throws Error(output_failed) if it cannot be started or `log` cannot be written.
pid_t start_process(const std::vector<std::string>& arguments, const std::filesystem::path& log);

struct ProcessResult {
  int exit_code = 0;   ///< 127: program not started; 128 and above: ended by a signal
  std::string output;  ///< of standard output; standard error goes to that of this process
};

/// Runs a program and waits for its end. Throws Error(output_failed) only if no pipe can be made for the output.
ProcessResult run_process(const std::vector<std::string>& arguments);

}  // namespace weft::cli
