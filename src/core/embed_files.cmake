# Writes the header OUTPUT, which defines NAME: an array of EmbeddedFile with the text of each file below FOLDER. Thus
# the program contains these files, and does not read them when it runs. Call:
#   cmake -DFOLDER=... -DOUTPUT=... -DNAME=kEmbeddedShaders -P embed_files.cmake
file(GLOB_RECURSE files RELATIVE ${FOLDER} ${FOLDER}/*)
set(entries "")
foreach(file IN LISTS files)
  file(READ "${FOLDER}/${file}" text)
  string(APPEND entries "    {\"${file}\", R\"embedded(${text})embedded\"},\n")
endforeach()
file(WRITE ${OUTPUT} "#pragma once

#include \"core/embedded_file.hpp\"

namespace weft {

inline constexpr EmbeddedFile ${NAME}[] = {
${entries}};

}  // namespace weft
")
