// Outlines of pattern pieces from drawings.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "garment/outline.hpp"

namespace weft::garment {

/// Larger drawings are refused: a pattern of ten pieces has some kilobytes.
inline constexpr std::uintmax_t kMaxSvgBytes = std::uintmax_t{16} << 20;

struct DrawnPanel {
  Outline outline;                 ///< [m], y upward
  std::vector<std::string> names;  ///< of its curves; empty where the drawing names none
};

/// The path, polygon or rect with this id, or this label of Inkscape, in an SVG file. Lengths follow width, height and
/// viewBox of the file, without them CSS pixels (96 to the inch); transforms of the element and of what it is in apply.
/// Or the group with this id or label: its one closed outline (seam allowances, of class "sa", do not count), with
/// texts that say more. "edge: hem" names the edge whose curves are nearest to where the text begins; an edge goes from
/// corner to corner, or to the curve that is nearer to another text; edges without texts are called 1, 2, 3 and so on.
/// "origin" stands where the origin of the panel is, else that is the sheet's. Other texts do not matter. Throws
/// Error(asset_unreadable) with "file:line:column: element: what is wrong".
DrawnPanel load_svg_panel(const std::filesystem::path& file, const std::string& id);

}  // namespace weft::garment
