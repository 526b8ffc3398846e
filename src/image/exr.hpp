// OpenEXR files of many named channels, for programs that compose pictures.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "image/png.hpp"

namespace weft::image {

/// Channels of one size, each row-major with the top row first. The part of a name before its point is its layer:
/// "normal.X"; R, G, B and A by themselves are the picture, linear.
struct Layers {
  struct Channel {
    std::string name;
    std::vector<float> values;
    bool half = false;  ///< 16 bits in the file; else 32
  };
  int width = 0, height = 0;  ///< pixels
  std::vector<Channel> channels;

  bool empty() const { return channels.empty(); }
};

/// Writes them with ZIP compression under a temporary name, then renames it. The primaries are those of Rec. 709, as of
/// sRGB. Throws Error(output_failed) with the reason.
void write_exr(const std::filesystem::path& file, const Layers& layers, const Metadata& metadata = {});

/// What a file says of itself; `width` and `height` in pixels.
struct ExrHeader {
  int width = 0, height = 0;
  Metadata metadata;
};
/// Throws Error(asset_unreadable) for what is no OpenEXR file, or not a whole one.
ExrHeader read_exr_header(const std::filesystem::path& file);

}  // namespace weft::image
