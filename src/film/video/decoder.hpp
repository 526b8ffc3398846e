// Reads video files frame by frame.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "film/image/image.hpp"
#include "film/video/encoder.hpp"

namespace weft::video {

/// Reads the pictures of a video in display order. The constructor and next() throw Error(asset_unreadable) with the
/// name of the file and the reason.
class Decoder {
 public:
  explicit Decoder(const std::filesystem::path& file);
  ~Decoder();
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  int width() const;   ///< [pixels]
  int height() const;  ///< [pixels]
  /// Whether the pictures may differ from those that the encoder received. H.264 can be lossy or lossless; RGB in H.264
  /// counts as lossless, YUV as lossy.
  bool lossy() const;
  /// The codec of the video; nullopt if it is none of those that Encoder writes.
  std::optional<Codec> codec() const;
  double fps() const;  ///< frames per second; 0 if libav finds no rate
  /// The metadata of the file, with keys in lower case.
  const std::map<std::string, std::string>& metadata() const;

  /// Returns the next picture, or nullopt after the last one.
  std::optional<image::Image> next();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace weft::video
