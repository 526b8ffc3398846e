// Conversion of sRGB pictures to the colours of video frames.
#pragma once

#include <filesystem>

#include "film/image/image.hpp"
#include "film/video/libav.hpp"

namespace weft::video {

/// Converts RGB to BT.709 in limited range, with the chroma siting (left) that H.264 assumes by default. If the pixel
/// format of the video is RGB, colours stay RGB.
class FrameConverter {
 public:
  /// `width`, `height` [pixels]: odd values are increased by one unless `format` is RGB. `file`: the video, for errors.
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
  FramePtr source_;  // the padded picture; libav allocates it, because swscale reads beyond the last pixel
};

}  // namespace weft::video
