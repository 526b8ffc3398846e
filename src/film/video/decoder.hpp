// Reads video files frame by frame.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "film/image/image.hpp"

namespace weft::video {

/// Reads the pictures of a video in display order. All functions throw Error(asset_unreadable) with libav's message.
class Decoder {
 public:
  explicit Decoder(const std::filesystem::path& file);
  ~Decoder();
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  int width() const;   ///< [pixels]
  int height() const;  ///< [pixels]
  /// Whether the codec is lossy, so that the pictures differ from those given to the encoder.
  bool lossy() const;
  double fps() const;  ///< frames per second, 0 if the file does not state it
  const std::map<std::string, std::string>& metadata() const;

  /// Returns the next picture, or nullopt after the last one.
  std::optional<image::Image> next();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace weft::video
