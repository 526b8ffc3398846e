// OSMesa (off-screen Mesa) draws into memory, without display or device. Mesa 25.1 and later do not include OSMesa.
#include <array>
#include <cstdint>

#include "core/error.hpp"
#include "film/render/gl/context.hpp"
#include "film/render/gl/shared_library.hpp"

namespace weft::render {
namespace {

constexpr const char* kOsMesa = "libOSMesa.so.8";

// The OSMesa 8 types and constants that this file uses; thus the build needs no OSMesa headers. Values: GL/osmesa.h.
using OsmesaHandle = void*;
constexpr int kOsmesaFormat = 0x22, kOsmesaDepthBits = 0x30, kOsmesaProfile = 0x33, kOsmesaCoreProfile = 0x34;
constexpr int kOsmesaMajorVersion = 0x36, kOsmesaMinorVersion = 0x37;

class OsmesaContext : public Context {
 public:
  OsmesaContext() {
    const std::array<int, 11> attributes{kOsmesaFormat,
                                         GL_RGBA,
                                         kOsmesaDepthBits,
                                         0,
                                         kOsmesaProfile,
                                         kOsmesaCoreProfile,
                                         kOsmesaMajorVersion,
                                         4,
                                         kOsmesaMinorVersion,
                                         5,
                                         0};
    context_ = create_(attributes.data(), nullptr);
    if (!context_) throw Error(ExitCode::internal, "{}: makes no OpenGL 4.5 core context", kOsMesa);
    make_current();
    load_functions(get_proc_, std::string("OSMesa (") + kOsMesa + ")");
  }

  ~OsmesaContext() override { destroy_(context_); }
  OsmesaContext(const OsmesaContext&) = delete;
  OsmesaContext& operator=(const OsmesaContext&) = delete;

  void make_current() override {
    if (!make_current_(context_, pixels_.data(), GL_UNSIGNED_BYTE, kSide, kSide)) {
      throw Error(ExitCode::internal, "{}: OSMesaMakeCurrent failed", kOsMesa);
    }
  }

  void release() override { make_current_(nullptr, nullptr, 0, 0, 0); }

 private:
  // OSMesa requires a buffer. Weft draws only into framebuffer objects, so this one is small and unused.
  static constexpr int kSide = 4;
  std::array<std::uint8_t, kSide * kSide * 4> pixels_{};

  SharedLibrary library_{kOsMesa};
  OsmesaHandle (*create_)(const int*, OsmesaHandle) = library_.function("OSMesaCreateContextAttribs");
  void (*destroy_)(OsmesaHandle) = library_.function("OSMesaDestroyContext");
  GLboolean (*make_current_)(OsmesaHandle, void*, GLenum, GLsizei, GLsizei) = library_.function("OSMesaMakeCurrent");
  Loader get_proc_ = library_.function("OSMesaGetProcAddress");
  OsmesaHandle context_ = nullptr;
};

}  // namespace

std::unique_ptr<Context> make_osmesa_context() {
  return std::make_unique<OsmesaContext>();
}

}  // namespace weft::render
