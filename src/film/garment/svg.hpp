// Reads outlines of pattern pieces from drawings.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "film/garment/outline.hpp"

namespace weft::garment {

/// Maximum size of a drawing [bytes]; a pattern of ten pieces has some kilobytes.
inline constexpr std::uintmax_t kMaxSvgBytes = std::uintmax_t{16} << 20;

struct DrawnPanel {
  Outline outline;                 ///< [m], y upward
  std::vector<std::string> names;  ///< one per curve; empty if the drawing names none
};

/// Loads the path, polygon or rect with this id or this Inkscape label, or with a number, such as "path:2" for the
/// second path, from an SVG file. The file's width, height and viewBox define the unit; without a viewBox it is the CSS
/// pixel (96 to the inch). Transforms of the element and of its ancestors apply, and places of nested drawings. If a
/// path is an outline with its seam allowance around it, the former counts. If the id or label is that of a group, the
/// one closed outline in the group is loaded (seam allowances and marks of FreeSewing do not count), together with the
/// texts. A text "edge: hem" names the edge whose curves are nearest to the start of the text; an edge extends from
/// corner to corner, or to the curve that is nearer to another text. Edges without a text are named by their number,
/// counted from 1 at the first corner. A text "origin" marks the origin of the panel, by default that of the group.
/// Other texts are ignored. Throws Error(asset_unreadable) with "file:line:column: element: what is wrong".
DrawnPanel load_svg_panel(const std::filesystem::path& file, const std::string& id);

}  // namespace weft::garment
