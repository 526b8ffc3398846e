// Textures for surfaces, from PNG, JPEG and TGA files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace weft::image {

/// A picture with alpha. Row-major, top row first, four bytes (R, G, B, A) per pixel, sRGB encoded, alpha not
/// premultiplied.
struct Picture {
  int width = 0, height = 0;  ///< [pixels]
  std::vector<std::uint8_t> rgba;
};

/// Maximum width and height of a picture [pixels]; current OpenGL implementations support textures of this size.
inline constexpr int kMaxPictureSide = 16384;

/// Maximum size of the file of a picture [bytes].
inline constexpr std::uintmax_t kMaxPictureBytes = std::uintmax_t{64} << 20;

/// Whether the bytes start with a TGA header. The format has no magic bytes, so all header fields with restricted
/// values are checked.
bool is_targa(std::string_view bytes);

/// Decodes a PNG (any depth, palette, with or without alpha), JPEG or TGA file. Throws std::runtime_error with
/// the reason.
Picture decode_picture(std::string_view bytes);

/// Reads and decodes a file as decode_picture() does. Throws Error(asset_unreadable) with the name of the file.
Picture read_picture(const std::filesystem::path& file);

}  // namespace weft::image
