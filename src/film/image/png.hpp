// PNG files through libpng.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "film/image/image.hpp"
#include "film/image/picture.hpp"

namespace weft::image {

/// Maximum width and height [pixels]; the software renderer's frame buffer and x264 have the same limit.
inline constexpr int kMaxPngSide = 16384;

/// Pairs of key and text, stored as tEXt chunks, or as iTXt chunks if the text is not ASCII.
using Metadata = std::map<std::string, std::string>;

/// Writes an sRGB PNG under a temporary name, then renames the file. Throws Error(output_failed).
void write_png(const std::filesystem::path& file, const Image& image, const Metadata& metadata = {});

/// Writes a PNG with 16 bits per channel in the same way.
void write_png(const std::filesystem::path& file, const Image16& image, const Metadata& metadata = {});

/// Encodes a picture as PNG in memory. Throws Error(output_failed).
std::string png_bytes(const Image& image);

/// Encodes a picture with alpha as PNG in memory. Throws Error(output_failed).
std::string png_bytes(const Picture& picture);

/// Reads a PNG as 8-bit RGB: converts pictures with 16 bits, grey levels or palettes, and blends transparent pixels
/// over white. `metadata`: receives the texts of the file; may be null. Throws Error(asset_unreadable).
Image read_png(const std::filesystem::path& file, Metadata* metadata = nullptr);

/// Reads the metadata that precede the pixels in the file, without decoding the pixels. Throws Error(asset_unreadable).
Metadata read_png_metadata(const std::filesystem::path& file);

}  // namespace weft::image
