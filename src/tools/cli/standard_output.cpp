#include "tools/cli/standard_output.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "core/error.hpp"

namespace weft::cli {

void write_standard_output(std::string_view text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0) return;
  if (errno != EPIPE)
    throw Error(ExitCode::output_failed, "standard output cannot be written: {}", std::strerror(errno));
}

}  // namespace weft::cli
