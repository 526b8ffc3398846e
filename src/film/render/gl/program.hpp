// Shader programs from the sources in shaders/, which the build embeds in the library.
#pragma once

#include <string>
#include <vector>

#include "film/render/gl/objects.hpp"

namespace weft::render {

/// A linked program of a vertex shader and an optional fragment shader.
class Program {
 public:
  Program() = default;
  /// `vertex` and `fragment`: file names in shaders/; `fragment` is empty if the program draws no colours. `defines`:
  /// macros that are defined before the sources, such as "CLOTH" or "LIGHTS 2". Throws Error(internal) with the message
  /// of the compiler or linker.
  Program(const Gl& gl, const std::string& vertex, const std::string& fragment,
          const std::vector<std::string>& defines = {});

  void use() const { gl_->UseProgram(program_.name()); }
  /// Location of a uniform; -1 if the compiler removed it as unused. OpenGL ignores values set at -1.
  GLint uniform(const char* name) const { return gl_->GetUniformLocation(program_.name(), name); }

 private:
  const Gl* gl_ = nullptr;
  ProgramName program_;
};

/// Source of a file in shaders/, with each line `#include "name"` replaced by the source of that file.
std::string shader_source(const std::string& file);

}  // namespace weft::render
