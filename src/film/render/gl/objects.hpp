// Owners of OpenGL objects. The destructor of an owner deletes its object; the context must then be current.
#pragma once

#include <span>
#include <utility>

#include "film/render/gl/context.hpp"

namespace weft::render {

/// Owner of one GL name. `Kind` defines how the object is made and deleted.
template <class Kind>
class GlObject {
 public:
  GlObject() = default;
  template <class... Args>
  explicit GlObject(const Gl& gl, Args... args) : gl_(&gl), name_(Kind::create(gl, args...)) {}
  ~GlObject() {
    if (name_) Kind::destroy(*gl_, name_);
  }
  GlObject(GlObject&& other) noexcept : gl_(std::exchange(other.gl_, nullptr)), name_(std::exchange(other.name_, 0)) {}
  GlObject& operator=(GlObject&& other) noexcept {
    std::swap(gl_, other.gl_);
    std::swap(name_, other.name_);
    return *this;
  }

  GLuint name() const { return name_; }
  explicit operator bool() const { return name_ != 0; }

 private:
  const Gl* gl_ = nullptr;
  GLuint name_ = 0;
};

/// Makes and deletes objects that OpenGL makes in numbers: `kCreate` and `kDelete` are the functions for n objects.
template <auto kCreate, auto kDelete>
struct NumberedKind {
  template <class... Args>
  static GLuint create(const Gl& gl, Args... args) {
    GLuint name = 0;
    (gl.*kCreate)(args..., 1, &name);
    return name;
  }
  static void destroy(const Gl& gl, GLuint name) { (gl.*kDelete)(1, &name); }
};
struct ProgramKind {
  static GLuint create(const Gl& gl) { return gl.CreateProgram(); }
  static void destroy(const Gl& gl, GLuint name) { gl.DeleteProgram(name); }
};

using Buffer = GlObject<NumberedKind<&Gl::CreateBuffers, &Gl::DeleteBuffers>>;
using VertexArray = GlObject<NumberedKind<&Gl::CreateVertexArrays, &Gl::DeleteVertexArrays>>;
using Texture = GlObject<NumberedKind<&Gl::CreateTextures, &Gl::DeleteTextures>>;  // takes the target
using Framebuffer = GlObject<NumberedKind<&Gl::CreateFramebuffers, &Gl::DeleteFramebuffers>>;
using ProgramName = GlObject<ProgramKind>;

/// Makes a texture with one mip level, sampled with `filter` (GL_NEAREST or GL_LINEAR) and clamped to its edge.
Texture make_texture(const Gl& gl, GLenum format, int width, int height, GLenum filter);

/// Sets how a texture is sampled (GL_TEXTURE_MIN_FILTER and so on).
void set_sampling(const Gl& gl, const Texture& texture, GLint min_filter, GLint mag_filter, GLint wrap_s, GLint wrap_t);

/// Describes an attribute of a vertex array: `size` floats per vertex, which have their own buffer.
void add_attribute(const Gl& gl, const VertexArray& array, GLuint place, const Buffer& buffer, GLint size);

/// Throws Error(internal) if the framebuffer is incomplete. `what`: its name in the message.
void check_framebuffer(const Gl& gl, const Framebuffer& framebuffer, const char* what);

/// Replaces the content of a buffer that changes from frame to frame.
template <class T>
void upload(const Gl& gl, const Buffer& buffer, std::span<const T> data) {
  gl.NamedBufferData(buffer.name(), static_cast<GLsizeiptr>(data.size_bytes()), data.data(), GL_STREAM_DRAW);
}

/// If OpenGL has recorded an error since the last call, throws std::bad_alloc if memory ran out, else Error(internal)
/// that names `what` and the error.
void check_errors(const Gl& gl, const char* what);

}  // namespace weft::render
