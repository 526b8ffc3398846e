#include "film/render/gl/shared_library.hpp"

#include <dlfcn.h>

#include "core/error.hpp"

namespace weft::render {

SharedLibrary::SharedLibrary(const std::string& file)
    : file_(file), handle_(dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) {
  if (!handle_) throw Error(ExitCode::usage, "{}: cannot be opened: {}", file, dlerror());
}

SharedLibrary::Function SharedLibrary::function(const char* name) const {
  void* symbol = dlsym(handle_, name);
  if (!symbol) throw Error(ExitCode::usage, "{}: has no function {}", file_, name);
  return {symbol};
}

}  // namespace weft::render
