#pragma once

namespace weft {

/// Of the program; the same as in CMakeLists.txt.
inline constexpr const char* kVersion = "0.1.0";
inline constexpr const char* kVersionDate = "2026-11-21";  // on which it got that number; manual pages have one

}  // namespace weft
