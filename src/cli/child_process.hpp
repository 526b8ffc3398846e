// Other programs, and this one again.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace weft::cli {

/// File name of the program that holds the commands which make no film.
inline constexpr const char* kToolsName = "weft-tools";

/// The program that was called; where this process is that of the tools, the one beside it.
std::filesystem::path own_program();

/// Starts `words[0]`, looked up as a shell does, without input; what it prints goes to `log`, empty: where ours does.
/// Killed with the calling thread. Throws Error(output_failed) where it cannot be started or `log` cannot be written.
pid_t start_process(const std::vector<std::string>& words, const std::filesystem::path& log);

struct ProcessResult {
  int exit_code = 0;   ///< 127: there is no such program; 128 and more: ended by a signal
  std::string output;  ///< what it printed; its errors go where ours go
};

/// Waits for its end.
ProcessResult run_process(const std::vector<std::string>& words);

}  // namespace weft::cli
