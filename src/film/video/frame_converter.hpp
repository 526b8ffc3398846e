// Conversion of sRGB pictures to the colours of video frames.
#pragma once

#include <filesystem>

#include "film/image/image.hpp"
#include "film/video/libav.hpp"

namespace weft::video {

/// Converts RGB to BT.709 in limited range, with the chroma siting (left) that H.264 assumes by default. If the format
/// of the video is RGB, keeps RGB.
class FrameConverter {
 public:
  /// `file`: name of the video in errors. Sizes are in pixels; odd sizes are increased by one unless the format is RGB.
  FrameConverter(int width, int height, std::filesystem::path file, AVPixelFormat format = AV_PIX_FMT_YUV420P);

  int padded_width() const { return rgb_ ? width_ : width_ + width_ % 2; }
  int padded_height() const { return rgb_ ? height_ : height_ + height_ % 2; }

  /// Returns a frame of the padded size, with its colour space set and its pixels uninitialised. Throws
  /// Error(output_failed).
  FramePtr make_frame() const;

  /// Writes the picture into `frame`; repeats the last column or row if the size is odd. Throws Error(output_failed).
  void convert(const image::Image& image, AVFrame& frame);

 private:
  FramePtr allocate(AVPixelFormat format) const;

  int width_, height_;
  AVPixelFormat format_;
  bool rgb_;
  std::filesystem::path file_;
  ScalerPtr scaler_;
  FramePtr source_;  // the padded picture; memory of libav, since swscale reads beyond the last pixel of its source
};

}  // namespace weft::video
