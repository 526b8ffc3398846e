// Names of heat quantities in files.
#pragma once

#include <string_view>

#include "film/frame/frame_snapshot.hpp"

namespace weft::frame {

/// Name of the property in files that holds the heat; empty if there is none.
inline std::string_view name_of(Stage::Heat heat) {
  constexpr std::string_view kNames[] = {"", "strain", "speed"};
  return kNames[static_cast<std::size_t>(heat)];
}

}  // namespace weft::frame
