// OpenGL 4.5 core contexts without a window, from a library that is opened at run time.
#pragma once

#include <glad/gl.h>

#include <memory>
#include <string>

#include "film/render/renderer.hpp"

namespace weft::render {

/// Table of the OpenGL functions of one context. Each context has its own table, because the functions of the backends
/// differ.
using Gl = GladGLContext;

/// An OpenGL 4.5 core context. It has no usable default framebuffer: draw only into framebuffers made in it.
class Context {
 public:
  virtual ~Context() = default;

  /// Binds the context to the calling thread. Throws Error(internal) with the library's message.
  virtual void make_current() = 0;
  /// Unbinds the context, so that another thread can bind it.
  virtual void release() = 0;

  const Gl& gl() const { return gl_; }
  /// The backend, such as "OSMesa (libOSMesa.so.8)", followed by the driver's vendor, renderer and version of OpenGL.
  const std::string& description() const { return description_; }

 protected:
  using Loader = GLADapiproc (*)(const char* name);
  /// Fills gl_ and description_; the context must be current. Throws Error(usage) if the driver provides less
  /// than 4.5 core.
  void load_functions(Loader loader, const std::string& backend);

 private:
  Gl gl_{};
  std::string description_;
};

/// Makes a context and binds it to the calling thread. `automatic`: OSMesa, or EGL if OSMesa fails.
/// `threads`: number of threads of the software rasteriser (0: its default). The driver reads this
/// number only for the first context of the process. Throws Error(usage) if the library or one of
/// its functions is missing or the driver provides less than OpenGL 4.5, and Error(internal) if a
/// call fails. If both libraries fail for `automatic`, throws Error(usage) with both errors.
std::unique_ptr<Context> make_context(Backend backend, int threads);

/// CPU time that all llvmpipe threads of the process have used so far [s]. Threads that have ended do not count. 0 for
/// other drivers.
double rasteriser_cpu_seconds();

/// Make a context of one backend, and bind it to the calling thread. Throw as make_context() does.
std::unique_ptr<Context> make_osmesa_context();
std::unique_ptr<Context> make_egl_context();

/// Binds a context to the calling thread during its own lifetime.
class CurrentContext {
 public:
  explicit CurrentContext(Context& context) : context_(context) { context_.make_current(); }
  ~CurrentContext() { context_.release(); }
  CurrentContext(const CurrentContext&) = delete;
  CurrentContext& operator=(const CurrentContext&) = delete;

 private:
  Context& context_;
};

}  // namespace weft::render
