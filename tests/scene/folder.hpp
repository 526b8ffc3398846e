#pragma once

#include <string>

namespace weft::scene {

/// Where the files lie that the tests of scenes read.
inline const std::string kFolder = WEFT_SOURCE_DIR "/tests/scene/";

}  // namespace weft::scene
