// Shader programs from the sources in shaders/, which are embedded in the library when it is built.
#pragma once

#include <string>
#include <vector>

#include "render/gl/objects.hpp"

namespace weft::render {

/// One linked program.
class Program {
 public:
  Program() = default;
  /// `vertex` and `fragment` are file names in shaders/; `fragment` may be empty where only depth is drawn. `defines`
  /// ("CLOTH", "TAPS 16") come before the sources. Throws Error(internal) with the compiler's words.
  Program(const Gl& gl, const std::string& vertex, const std::string& fragment,
          const std::vector<std::string>& defines = {});

  void use() const { gl_->UseProgram(program_.name()); }
  /// Place of a uniform; -1 where the compiler found it unused, which GL then ignores.
  GLint uniform(const char* name) const { return gl_->GetUniformLocation(program_.name(), name); }

 private:
  const Gl* gl_ = nullptr;
  ProgramName program_;
};

/// Source of a file of shaders/ with each `#include "name"` line replaced by that file.
std::string shader_source(const std::string& file);

}  // namespace weft::render
