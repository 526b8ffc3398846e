#include "film/render/gl/objects.hpp"

#include <new>

#include "core/error.hpp"

namespace weft::render {
namespace {

const char* error_name(GLenum error) {
  switch (error) {
    case GL_INVALID_ENUM:
      return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE:
      return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION:
      return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return "GL_INVALID_FRAMEBUFFER_OPERATION";
    default:
      return "an unknown error";
  }
}

}  // namespace

Texture make_texture(const Gl& gl, GLenum format, int width, int height, GLenum filter) {
  Texture texture(gl, GLenum{GL_TEXTURE_2D});
  gl.TextureStorage2D(texture.name(), 1, format, width, height);
  set_sampling(gl, texture, static_cast<GLint>(filter), static_cast<GLint>(filter), GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE);
  return texture;
}

void set_sampling(const Gl& gl, const Texture& texture, GLint min_filter, GLint mag_filter, GLint wrap_s,
                  GLint wrap_t) {
  gl.TextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, min_filter);
  gl.TextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, mag_filter);
  gl.TextureParameteri(texture.name(), GL_TEXTURE_WRAP_S, wrap_s);
  gl.TextureParameteri(texture.name(), GL_TEXTURE_WRAP_T, wrap_t);
}

void add_attribute(const Gl& gl, const VertexArray& array, GLuint place, const Buffer& buffer, GLint size) {
  gl.VertexArrayVertexBuffer(array.name(), place, buffer.name(), 0, static_cast<GLsizei>(size * sizeof(float)));
  gl.EnableVertexArrayAttrib(array.name(), place);
  gl.VertexArrayAttribFormat(array.name(), place, size, GL_FLOAT, GL_FALSE, 0);
  gl.VertexArrayAttribBinding(array.name(), place, place);
}

void check_framebuffer(const Gl& gl, const Framebuffer& framebuffer, const char* what) {
  const GLenum status = gl.CheckNamedFramebufferStatus(framebuffer.name(), GL_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE) {
    throw Error(ExitCode::internal, "{}: OpenGL cannot draw to this framebuffer (status {:#x})", what, status);
  }
}

void check_errors(const Gl& gl, const char* what) {
  const GLenum error = gl.GetError();
  if (error == GL_OUT_OF_MEMORY) throw std::bad_alloc();
  if (error != GL_NO_ERROR) throw Error(ExitCode::internal, "{}: OpenGL reports {}", what, error_name(error));
}

}  // namespace weft::render
