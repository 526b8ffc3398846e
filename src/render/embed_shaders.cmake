# Writes OUTPUT, a header with the text of every file in FOLDER: cmake -DFOLDER=... -DOUTPUT=... -P embed_shaders.cmake
file(GLOB files ${FOLDER}/*)
set(entries "")
foreach(file IN LISTS files)
  file(READ "${file}" text)
  cmake_path(GET file FILENAME name)
  string(APPEND entries "    {\"${name}\", R\"glsl(${text})glsl\"},\n")
endforeach()
file(WRITE ${OUTPUT} "#pragma once

#include <string_view>

namespace weft::render {

struct EmbeddedShader {
  std::string_view name, source;
};

inline constexpr EmbeddedShader kEmbeddedShaders[] = {
${entries}};

}  // namespace weft::render
")
