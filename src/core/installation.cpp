#include "core/installation.hpp"

#include <errno.h>  // program_invocation_name

#include <system_error>

namespace weft {

namespace fs = std::filesystem;

namespace {
Installation overridden_installation;
}  // namespace

void set_own_installation(const Installation& installation) {
  overridden_installation = installation;
}

Installation own_installation() {
  if (!overridden_installation.program.empty()) return overridden_installation;
  std::error_code none;
  const fs::path running = fs::read_symlink("/proc/self/exe", none);
  // In an archive, bin/NAME starts the loader lib/ld-linux-x86-64.so.2, which runs libexec/NAME with argument 0 set to
  // bin/NAME (.packaging/start.c).
  const fs::path started = program_invocation_name, libraries = running.parent_path(), top = libraries.parent_path();
  const fs::path code = top / "libexec" / started.filename();
  if (running.filename().string().starts_with("ld-linux") && fs::is_regular_file(code, none))
    return {top / "bin" / started.filename(), code, libraries};
  return {running, running, {}};
}

}  // namespace weft
