// EGL without a surface (EGL_MESA_platform_surfaceless), for Mesa 25.1 and later, which do not include OSMesa.
#include <array>

#include "core/error.hpp"
#include "film/render/gl/context.hpp"
#include "film/render/gl/shared_library.hpp"

namespace weft::render {
namespace {

constexpr const char* kEgl = "libEGL.so.1";

// The EGL 1.5 types and constants that this file uses; thus the build needs no EGL headers. Values: Khronos registry,
// egl.xml.
using EglHandle = void*;
using EglInt = int;
using EglBoolean = unsigned;
using EglEnum = unsigned;
constexpr EglEnum kPlatformSurfaceless = 0x31DD, kOpenGlApi = 0x30A2;
constexpr EglInt kSurfaceType = 0x3033, kRenderableType = 0x3040, kOpenGlBit = 0x0008, kNone = 0x3038;
constexpr EglInt kMajorVersion = 0x3098, kMinorVersion = 0x30FB, kProfileMask = 0x30FD, kCoreProfile = 0x1;

class EglContext : public Context {
 public:
  EglContext() {
    display_ = get_platform_display_(kPlatformSurfaceless, nullptr, nullptr);
    check(display_ && initialize_(display_, nullptr, nullptr), "eglInitialize of the surfaceless platform");
    check(bind_api_(kOpenGlApi), "eglBindAPI(EGL_OPENGL_API)");
    const std::array<EglInt, 5> wanted{kSurfaceType, 0, kRenderableType, kOpenGlBit, kNone};
    EglHandle config = nullptr;
    EglInt count = 0;
    check(choose_config_(display_, wanted.data(), &config, 1, &count) && count == 1, "eglChooseConfig");
    const std::array<EglInt, 7> attributes{kMajorVersion, 4, kMinorVersion, 5, kProfileMask, kCoreProfile, kNone};
    context_ = create_context_(display_, config, nullptr, attributes.data());
    check(context_, "eglCreateContext of OpenGL 4.5 core");
    make_current();
    load_functions(get_proc_, std::string("EGL surfaceless (") + kEgl + ")");
  }

  // All contexts of the process share the display, which stays initialised.
  ~EglContext() override { destroy_context_(display_, context_); }
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  void make_current() override {
    check(bind_api_(kOpenGlApi) && make_current_(display_, nullptr, nullptr, context_), "eglMakeCurrent");
  }

  void release() override { make_current_(display_, nullptr, nullptr, nullptr); }

 private:
  void check(bool good, const char* what) const {
    if (!good) throw Error(ExitCode::internal, "{}: {} failed with EGL error {:#x}", kEgl, what, get_error_());
  }

  SharedLibrary library_{kEgl};
  EglHandle (*get_platform_display_)(EglEnum, void*, const std::intptr_t*) = library_.function("eglGetPlatformDisplay");
  EglBoolean (*initialize_)(EglHandle, EglInt*, EglInt*) = library_.function("eglInitialize");
  EglBoolean (*bind_api_)(EglEnum) = library_.function("eglBindAPI");
  EglBoolean (*choose_config_)(EglHandle, const EglInt*, EglHandle*, EglInt,
                               EglInt*) = library_.function("eglChooseConfig");
  EglHandle (*create_context_)(EglHandle, EglHandle, EglHandle, const EglInt*) = library_.function("eglCreateContext");
  EglBoolean (*destroy_context_)(EglHandle, EglHandle) = library_.function("eglDestroyContext");
  EglBoolean (*make_current_)(EglHandle, EglHandle, EglHandle, EglHandle) = library_.function("eglMakeCurrent");
  EglInt (*get_error_)() = library_.function("eglGetError");
  Loader get_proc_ = library_.function("eglGetProcAddress");
  EglHandle display_ = nullptr, context_ = nullptr;
};

}  // namespace

std::unique_ptr<Context> make_egl_context() {
  return std::make_unique<EglContext>();
}

}  // namespace weft::render
