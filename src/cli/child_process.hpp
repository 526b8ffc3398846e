// Starting other programs, or this one again.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace weft::cli {

/// File name of the program with the commands that do not make films.
inline constexpr const char* kToolsName = "weft-tools";

/// Path of the program `weft` that was called. In the process of the tools it is the program beside their own.
std::filesystem::path own_program();

/// Starts `words[0]`, searched as a shell does, with empty input. Its output goes to `log`, or if `log` is empty to
/// this process's output. The process is killed when the calling thread ends. Throws Error(output_failed) if it cannot
/// be started or `log` cannot be written.
pid_t start_process(const std::vector<std::string>& words, const std::filesystem::path& log);

struct ProcessResult {
  int exit_code = 0;   ///< 127: program not found; 128 and above: ended by a signal
  std::string output;  ///< its standard output; its standard error goes to that of this process
};

/// Runs a program and waits for its end.
ProcessResult run_process(const std::vector<std::string>& words);

}  // namespace weft::cli
