#pragma once

#include <string>

namespace weft::scene {

/// Folder of the files that the scene tests read.
inline const std::string kFolder = WEFT_SOURCE_DIR "/tests/scene/";

}  // namespace weft::scene
