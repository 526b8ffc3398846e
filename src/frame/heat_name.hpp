// What heat is called in files.
#pragma once

#include <string_view>

#include "frame/frame_snapshot.hpp"

namespace weft::frame {

/// The name of the property that files have for it; empty where there is none.
inline std::string_view name_of(Stage::Heat heat) {
  constexpr std::string_view kNames[] = {"", "strain", "speed"};
  return kNames[static_cast<std::size_t>(heat)];
}

}  // namespace weft::frame
