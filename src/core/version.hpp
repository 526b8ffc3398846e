#pragma once

namespace weft {

/// Of the program; the same as in CMakeLists.txt.
inline constexpr const char* kVersion = "0.1.0";

}  // namespace weft
