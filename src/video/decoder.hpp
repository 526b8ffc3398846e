// Video files, frame by frame.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "image/image.hpp"

namespace weft::video {

/// Reads the pictures of a video in the order in which they are shown. Errors are Error(asset_unreadable) with libav's
/// words.
class Decoder {
 public:
  explicit Decoder(const std::filesystem::path& file);
  ~Decoder();
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  int width() const;   ///< pixels
  int height() const;  ///< pixels
  /// Whether its encoder has changed the pictures.
  bool lossy() const;
  double fps() const;  ///< frames a second, 0 where the file does not tell
  const std::map<std::string, std::string>& metadata() const;

  /// The next picture; none past the last one.
  std::optional<image::Image> next();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace weft::video
