#pragma once

namespace weft {

/// Version of the program. CMakeLists.txt states the same version.
inline constexpr const char* kVersion = "0.1.0";
inline constexpr const char* kVersionDate = "2026-11-21";  // date of this version, for manual pages

}  // namespace weft
