// Outlines of pattern pieces from drawings.
#pragma once

#include <filesystem>
#include <string>

#include "garment/outline.hpp"

namespace weft::garment {

/// Larger drawings are refused: a pattern of ten pieces has some kilobytes.
inline constexpr std::uintmax_t kMaxSvgBytes = std::uintmax_t{16} << 20;

/// The outline of the path, polygon or rect with this id in an SVG file [m], y upward. Lengths follow width, height and
/// viewBox of the file, without them CSS pixels (96 to the inch); transforms of the element and of what it is in apply.
/// Throws Error(asset_unreadable) with "file:line:column: element: what is wrong".
Outline load_svg_outline(const std::filesystem::path& file, const std::string& id);

}  // namespace weft::garment
