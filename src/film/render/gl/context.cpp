#include "film/render/gl/context.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>

#include "core/error.hpp"
#include "core/installation.hpp"

namespace weft::render {
namespace {

const char* text(const Gl& gl, GLenum name) {
  const auto* found = reinterpret_cast<const char*>(gl.GetString(name));
  return found ? found : "unknown";
}

/// If the program runs from its unpacked archive (`ninja bundle`), makes EGL use the Mesa driver in that archive.
/// Without this setting, libEGL and Mesa would search system folders for each other's files.
void use_own_mesa() {
  const std::filesystem::path libraries = own_installation().libraries, vendor = libraries / "egl_vendor.json";
  std::error_code none;
  if (libraries.empty() || !std::filesystem::exists(vendor, none)) return;
  setenv("__EGL_VENDOR_LIBRARY_FILENAMES", vendor.c_str(), 1);
  setenv("LIBGL_DRIVERS_PATH", (libraries / "dri").c_str(), 1);
}

/// Sets environment variables that Mesa reads once, when the process makes its first context.
void set_rasteriser_environment(int threads) {
  use_own_mesa();
  // Makes EGL use llvmpipe. On a graphics card, pictures would differ slightly, and rasteriser_cpu_seconds() would find
  // no llvmpipe threads.
  setenv("LIBGL_ALWAYS_SOFTWARE", "1", 0);
  // llvmpipe of Mesa 22.3 crashes with 512-bit vectors and 4x multisampling, but not with its default width.
  const char* width = std::getenv("LP_NATIVE_VECTOR_WIDTH");
  if (width && std::string_view(width) == "512") unsetenv("LP_NATIVE_VECTOR_WIDTH");
  if (threads > 0) setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
}

}  // namespace

void Context::load_functions(Loader loader, const std::string& backend) {
  const int version = gladLoadGLContext(&gl_, loader);
  if (version < GLAD_MAKE_VERSION(4, 5)) {
    throw Error(ExitCode::usage, "{}: expected OpenGL 4.5 core, got {}.{}; install Mesa 20 or newer", backend,
                GLAD_VERSION_MAJOR(version), GLAD_VERSION_MINOR(version));
  }
  description_ = fmt::format("{}; {}; {}; OpenGL {}", backend, text(gl_, GL_VENDOR), text(gl_, GL_RENDERER),
                             text(gl_, GL_VERSION));
}

double rasteriser_cpu_seconds() {
  double seconds = 0;
  std::error_code error;
  for (std::filesystem::directory_iterator task("/proc/self/task", error), end; !error && task != end;
       task.increment(error)) {
    std::string name;
    std::ifstream(task->path() / "comm") >> name;
    if (!name.starts_with("llvmpipe")) continue;
    double nanoseconds = 0;
    std::ifstream(task->path() / "schedstat") >> nanoseconds;
    seconds += 1e-9 * nanoseconds;
  }
  return seconds;
}

std::unique_ptr<Context> make_context(Backend backend, int threads) {
  set_rasteriser_environment(threads);
  switch (backend) {
    case Backend::osmesa:
      return make_osmesa_context();
    case Backend::egl:
      return make_egl_context();
    case Backend::automatic:
      break;
  }
  std::string osmesa_error;
  try {
    return make_osmesa_context();
  } catch (const Error& error) {
    osmesa_error = error.what();
  }
  try {
    return make_egl_context();
  } catch (const Error& error) {
    throw Error(
        ExitCode::usage,
        "no OpenGL without a window on this machine: install libosmesa6, or libegl1 and libgl1-mesa-dri\n  {}\n  {}",
        osmesa_error, error.what());
  }
}

}  // namespace weft::render
