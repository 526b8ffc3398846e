// Reads a video file as a player does, for tests.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "image/image.hpp"
#include "video/libav.hpp"

namespace weft::video {

struct DecodedFrame {
  AVRational time;  ///< when it is shown [s], exact
  AVColorRange range;
  AVColorSpace matrix;
  AVColorPrimaries primaries;
  AVColorTransferCharacteristic transfer;
  image::Image image;  ///< BT.709 limited range to RGB by the formula of the standard, nearest chroma sample
};

struct DecodedVideo {
  int width = 0, height = 0;  ///< pixels
  AVPixelFormat pixel_format = AV_PIX_FMT_NONE;
  std::map<std::string, std::string> metadata;
  std::vector<DecodedFrame> frames;  ///< in the order of showing
};

/// Decodes all frames. Records a test failure and returns what it has where libav reports an error.
DecodedVideo decode(const std::filesystem::path& file);

/// Names of the file's outermost MP4 boxes, in order.
std::vector<std::string> mp4_boxes(const std::filesystem::path& file);

}  // namespace weft::video
