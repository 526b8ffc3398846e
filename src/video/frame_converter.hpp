// sRGB pictures to the colours of H.264 video.
#pragma once

#include <filesystem>

#include "image/image.hpp"
#include "video/libav.hpp"

namespace weft::video {

/// RGB to the BT.709 matrix in limited range, chroma sited left as H.264 has it by default, or to RGB as it is.
class FrameConverter {
 public:
  /// `file` names the video in errors. Sizes in pixels; odd ones grow by one, but not as RGB.
  FrameConverter(int width, int height, std::filesystem::path file, AVPixelFormat format = AV_PIX_FMT_YUV420P);

  int padded_width() const { return rgb_ ? width_ : width_ + width_ % 2; }
  int padded_height() const { return rgb_ ? height_ : height_ + height_ % 2; }

  /// A frame of the padded size with its colours declared and pixels not set. Throws Error(output_failed).
  FramePtr make_frame() const;

  /// Writes the picture into `frame`, repeating the last column and row where the size is odd. Throws
  /// Error(output_failed).
  void convert(const image::Image& image, AVFrame& frame);

 private:
  int width_, height_;
  AVPixelFormat format_;
  bool rgb_;
  std::filesystem::path file_;
  ScalerPtr scaler_;
  image::Image padded_;  // only for odd sizes
};

}  // namespace weft::video
