// Where OpenGL comes from: a library opened at run time that makes a 4.5 core context without a window.
#pragma once

#include <glad/gl.h>

#include <memory>
#include <string>

#include "render/renderer.hpp"

namespace weft::render {

/// All functions of one context. Kept per context, as the two backends bring their own copies of each function.
using Gl = GladGLContext;

/// An OpenGL 4.5 core context. There is no default framebuffer to speak of: draw into own ones only.
class Context {
 public:
  virtual ~Context() = default;

  /// Binds the context to the calling thread. Throws Error(internal) with the library's words.
  virtual void make_current() = 0;
  /// Unbinds it, so that another thread may take it.
  virtual void release() = 0;

  const Gl& gl() const { return gl_; }
  /// "OSMesa 8 (libOSMesa.so.8)" and why it was chosen, then the strings of the driver.
  const std::string& description() const { return description_; }

 protected:
  using Loader = GLADapiproc (*)(const char* name);
  /// Fills gl_ and description_; the context must be current. Throws where the driver gives less than 4.5 core.
  void load_functions(Loader loader, const std::string& backend);

 private:
  Gl gl_{};
  std::string description_;
};

/// Makes a context, bound to the calling thread. `automatic` takes OSMesa, or EGL where there is no OSMesa.
/// `threads` are those of the software rasteriser (0: its own choice); the driver reads them once a process, so
/// the first context decides. Throws Error(internal) naming each library tried and what it said.
std::unique_ptr<Context> make_context(Backend backend, int threads);

/// CPU seconds that the threads of llvmpipe have taken so far, in all contexts; 0 of a driver that draws elsewhere.
double rasteriser_cpu_seconds();

std::unique_ptr<Context> make_osmesa_context();
std::unique_ptr<Context> make_egl_context();

/// Binds a context for a scope.
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
