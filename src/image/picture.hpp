// Pictures to lay on surfaces, from PNG and JPEG files.
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

/// Decodes a PNG (any depth, palette, with or without alpha) or a JPEG file. Throws std::runtime_error, which says what
/// is wrong.
Picture decode_picture(std::string_view bytes);

/// The same of a file, likewise.
Picture read_picture(const std::filesystem::path& file);

}  // namespace weft::image
