# Writes the header OUTPUT, which defines NAME: an array of EmbeddedFile with the text of each of FILES, which are below
# FOLDER. Thus the program contains these files, and does not read them when it runs. Call:
#   cmake -DFOLDER=... -DFILES=... -DOUTPUT=... -DNAME=kEmbeddedShaders -P embed_files.cmake
set(entries "")
foreach(file IN LISTS FILES)
  file(READ ${file} text)
  cmake_path(RELATIVE_PATH file BASE_DIRECTORY ${FOLDER})
  string(APPEND entries "    {\"${file}\", R\"embedded(${text})embedded\"},\n")
endforeach()
file(WRITE ${OUTPUT} "#pragma once

#include \"core/embedded_file.hpp\"

namespace weft {

inline constexpr EmbeddedFile ${NAME}[] = {
${entries}};

}  // namespace weft
")
