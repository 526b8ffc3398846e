// Names of the heat quantities (Stage::Heat) in files.
#pragma once

#include <string_view>

#include "film/frame/frame_snapshot.hpp"

namespace weft::frame {

/// Name of the vertex property in which files store the heat; empty for Heat::none.
inline std::string_view name_of(Stage::Heat heat) {
  constexpr std::string_view kNames[] = {"", "strain", "speed"};
  return kNames[static_cast<std::size_t>(heat)];
}

}  // namespace weft::frame
