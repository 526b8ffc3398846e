#include "core/installation.hpp"

#include <errno.h>  // program_invocation_name

#include <system_error>

namespace weft {

namespace fs = std::filesystem;

namespace {
Installation assumed;
}  // namespace

void set_own_installation(const Installation& installation) {
  assumed = installation;
}

Installation own_installation() {
  if (!assumed.program.empty()) return assumed;
  std::error_code none;
  const fs::path running = fs::read_symlink("/proc/self/exe", none);
  // bin/NAME of an archive starts lib/ld-linux-x86-64.so.2, which runs libexec/NAME and calls it bin/NAME
  // (.packaging/start.c).
  const fs::path started = program_invocation_name, libraries = running.parent_path(), top = libraries.parent_path();
  const fs::path code = top / "libexec" / started.filename();
  if (running.filename().string().starts_with("ld-linux") && fs::is_regular_file(code, none))
    return {top / "bin" / started.filename(), code, libraries};
  return {running, running, {}};
}

}  // namespace weft
