// OpenEXR files with many named channels, for compositing programs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "film/image/png.hpp"

namespace weft::image {

/// Channels of the same size, row-major, top row first. The part of a channel's name before the dot is its layer, as in
/// "normal.X". The channels R, G, B and A, which have no layer, are the picture in linear RGB.
struct Layers {
  struct Channel {
    std::string name;
    std::vector<float> values;
    bool half = false;  ///< stored with 16 bits instead of 32
  };
  int width = 0, height = 0;  ///< [pixels]
  std::vector<Channel> channels;

  bool empty() const { return channels.empty(); }
};

/// Writes the channels with ZIP compression under a temporary name, then renames the file. The colour primaries are
/// those of Rec. 709, which sRGB shares. Throws Error(output_failed) with the reason.
void write_exr(const std::filesystem::path& file, const Layers& layers, const Metadata& metadata = {});

/// Size of the picture in a file [pixels], and those attributes of the file that are texts.
struct ExrHeader {
  int width = 0, height = 0;
  Metadata metadata;
};
/// Throws Error(asset_unreadable) if the file is not a complete OpenEXR file.
ExrHeader read_exr_header(const std::filesystem::path& file);

}  // namespace weft::image
