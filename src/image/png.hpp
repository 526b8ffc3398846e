// PNG files through libpng.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "image/image.hpp"
#include "image/picture.hpp"

namespace weft::image {

/// Key and text pairs stored as tEXt chunks.
using Metadata = std::map<std::string, std::string>;

/// Writes an sRGB PNG under a temporary name, then renames the file. Throws Error(output_failed).
void write_png(const std::filesystem::path& file, const Image& image, const Metadata& metadata = {});

/// The same with 16 bits per channel.
void write_png(const std::filesystem::path& file, const Image16& image, const Metadata& metadata = {});

/// Encodes a picture as PNG in memory. Throws Error(output_failed).
std::string png_bytes(const Image& image);

/// The same with alpha.
std::string png_bytes(const Picture& picture);

/// Reads an 8-bit PNG (gray, palette and alpha are converted to RGB over white). Throws Error(asset_unreadable).
Image read_png(const std::filesystem::path& file, Metadata* metadata = nullptr);

/// Reads the metadata before the pixels, without decoding these. Throws Error(asset_unreadable).
Metadata read_png_metadata(const std::filesystem::path& file);

}  // namespace weft::image
