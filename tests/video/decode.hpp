// Reads a video file as a player does.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "film/image/image.hpp"
#include "film/video/libav.hpp"

namespace weft::video {

struct DecodedFrame {
  AVRational time;  ///< presentation time [s], exact
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
  std::vector<DecodedFrame> frames;  ///< in presentation order
};

/// Decodes all frames. If libav reports an error, records a test failure and returns the frames so far.
DecodedVideo decode(const std::filesystem::path& file);

/// Names of the file's outermost MP4 boxes, in order.
std::vector<std::string> mp4_boxes(const std::filesystem::path& file);

}  // namespace weft::video
