// Off-screen Mesa: draws into memory, needs neither display nor device.
#include <array>
#include <cstdint>

#include "core/error.hpp"
#include "render/gl/context.hpp"
#include "render/gl/shared_library.hpp"

// After glad, whose guard keeps the GL 1.x declarations out that this header would bring.
#include <GL/osmesa.h>

namespace weft::render {
namespace {

constexpr const char* kOsMesa = "libOSMesa.so.8";

class OsmesaContext : public Context {
 public:
  OsmesaContext() {
    const int attributes[] = {OSMESA_FORMAT,
                              OSMESA_RGBA,
                              OSMESA_DEPTH_BITS,
                              0,
                              OSMESA_PROFILE,
                              OSMESA_CORE_PROFILE,
                              OSMESA_CONTEXT_MAJOR_VERSION,
                              4,
                              OSMESA_CONTEXT_MINOR_VERSION,
                              5,
                              0};
    context_ = create_(attributes, nullptr);
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
  // OSMesa insists on a buffer of its own; ours is never drawn to.
  static constexpr int kSide = 4;
  std::array<std::uint8_t, kSide * kSide * 4> pixels_{};

  SharedLibrary library_{kOsMesa};
  decltype(&OSMesaCreateContextAttribs) create_ =
      library_.function<decltype(&OSMesaCreateContextAttribs)>("OSMesaCreateContextAttribs");
  decltype(&OSMesaDestroyContext) destroy_ = library_.function<decltype(&OSMesaDestroyContext)>("OSMesaDestroyContext");
  decltype(&OSMesaMakeCurrent) make_current_ = library_.function<decltype(&OSMesaMakeCurrent)>("OSMesaMakeCurrent");
  Loader get_proc_ = library_.function<Loader>("OSMesaGetProcAddress");
  OSMesaContext context_ = nullptr;
};

}  // namespace

std::unique_ptr<Context> make_osmesa_context() {
  return std::make_unique<OsmesaContext>();
}

}  // namespace weft::render
