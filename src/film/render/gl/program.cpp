#include "film/render/gl/program.hpp"

#include <sstream>
#include <string_view>

#include "core/error.hpp"
#include "embedded_shaders.hpp"

namespace weft::render {
namespace {

std::string_view embedded_file(const std::string& file) {
  for (const auto& shader : kEmbeddedShaders) {
    if (shader.name == file) return shader.text;
  }
  throw Error(ExitCode::internal, "shaders/{}: not among the shaders built into this program", file);
}

/// Makes and deletes shaders for GlObject. Program deletes its shaders as soon as it has linked them.
struct ShaderKind {
  static GLuint create(const Gl& gl, GLenum stage) { return gl.CreateShader(stage); }
  static void destroy(const Gl& gl, GLuint name) { gl.DeleteShader(name); }
};
using Shader = GlObject<ShaderKind>;

std::string shader_log(const Gl& gl, GLuint shader) {
  GLint length = 0;
  gl.GetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length), '\0');
  gl.GetShaderInfoLog(shader, length, nullptr, log.data());
  return log;
}

Shader compile(const Gl& gl, GLenum stage, const std::string& file, const std::vector<std::string>& defines) {
  std::string source = "#version 450 core\n";
  for (const std::string& define : defines) source += "#define " + define + "\n";
  source += "#line 1\n" + shader_source(file);
  Shader shader(gl, stage);
  const char* text = source.c_str();
  gl.ShaderSource(shader.name(), 1, &text, nullptr);
  gl.CompileShader(shader.name());
  GLint good = GL_FALSE;
  gl.GetShaderiv(shader.name(), GL_COMPILE_STATUS, &good);
  if (!good) throw Error(ExitCode::internal, "shaders/{}: {}", file, shader_log(gl, shader.name()));
  return shader;
}

}  // namespace

std::string shader_source(const std::string& file) {
  constexpr std::string_view kInclude = "#include \"";
  std::istringstream lines{std::string(embedded_file(file))};
  std::string source, line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (line.starts_with(kInclude)) {
      const std::string included = line.substr(kInclude.size(), line.rfind('"') - kInclude.size());
      source += "#line 1\n" + shader_source(included) + "#line " + std::to_string(number + 1) + "\n";
    } else {
      source += line + "\n";
    }
  }
  return source;
}

Program::Program(const Gl& gl, const std::string& vertex, const std::string& fragment,
                 const std::vector<std::string>& defines)
    : gl_(&gl), program_(gl) {
  const Shader vertex_shader = compile(gl, GL_VERTEX_SHADER, vertex, defines);
  gl.AttachShader(program_.name(), vertex_shader.name());
  Shader fragment_shader;
  if (!fragment.empty()) {
    fragment_shader = compile(gl, GL_FRAGMENT_SHADER, fragment, defines);
    gl.AttachShader(program_.name(), fragment_shader.name());
  }
  gl.LinkProgram(program_.name());
  GLint good = GL_FALSE;
  gl.GetProgramiv(program_.name(), GL_LINK_STATUS, &good);
  if (!good) {
    std::string log(1024, '\0');
    GLsizei length = 0;
    gl.GetProgramInfoLog(program_.name(), static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    throw Error(ExitCode::internal, "shaders/{} with shaders/{}: {}", vertex, fragment, log);
  }
}

}  // namespace weft::render
