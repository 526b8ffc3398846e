// Pictures to lay on surfaces, from PNG, JPEG and TGA files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace weft::image {

/// Rows from the top, R G B A bytes a pixel, colours in sRGB, alpha not multiplied in.
struct Picture {
  int width = 0, height = 0;  ///< pixels
  std::vector<std::uint8_t> rgba;
};

/// Pixels along one side that a picture may have: what every OpenGL takes.
inline constexpr int kMaxPictureSide = 16384;

/// Bytes that the file of a picture may have.
inline constexpr std::uintmax_t kMaxPictureBytes = std::uintmax_t{64} << 20;

/// Whether bytes begin like a TGA file, which has no mark of its own: by all of its header that is not free.
bool is_targa(std::string_view bytes);

/// Decodes a PNG (any depth, palette, with or without alpha), a JPEG or a TGA file. Throws std::runtime_error, which
/// says what is wrong.
Picture decode_picture(std::string_view bytes);

/// The same of a file. Throws Error(asset_unreadable), which names it.
Picture read_picture(const std::filesystem::path& file);

}  // namespace weft::image
