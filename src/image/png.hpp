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

/// Writes an sRGB PNG under a temporary name, then renames it. Throws Error(output_failed) with the system's reason.
void write_png(const std::filesystem::path& file, const Image& image, const Metadata& metadata = {});

/// The same with 16 bits a channel.
void write_png(const std::filesystem::path& file, const Image16& image, const Metadata& metadata = {});

/// The bytes of such a file. Throws Error(output_failed).
std::string png_bytes(const Image& image);

/// The same with alpha.
std::string png_bytes(const Picture& picture);

/// Reads an 8-bit PNG (gray, palette and alpha are converted to RGB over white). Throws Error(asset_unreadable).
Image read_png(const std::filesystem::path& file, Metadata* metadata = nullptr);

/// What stands before its pixels, which are not looked at. Throws Error(asset_unreadable).
Metadata read_png_metadata(const std::filesystem::path& file);

}  // namespace weft::image
