// Reads outlines of panels from SVG drawings.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "film/garment/outline.hpp"

namespace weft::garment {

/// A panel of a drawing.
struct DrawnPanel {
  Outline outline;                 ///< [m], y upward
  std::vector<std::string> names;  ///< edge name of each curve; empty if the drawing has none
};

/// Loads the outline of a panel from an SVG file. `id` is the id or Inkscape label of a path, polygon, closed polyline,
/// rect, circle, ellipse or group, or a number such as "path:2" for the second path in the file (paths in definitions
/// such as `defs` do not count). A circle or an ellipse is one curve.
/// - Units: the file's width, height and viewBox define the unit. Without a viewBox, it is the CSS pixel (1/96 inch; in
///   files of Inkscape before 0.92, 1/90 inch). Applies the transforms of the element and of its ancestors, and the
///   positions of nested svg elements.
/// - Path with two outlines, a seam line and the seam allowance around it: loads the seam line.
/// - Group: loads its only closed outline and its texts. Ignores seam allowances and marks of FreeSewing, and, beside a
///   path, polygon or rect, circles, ellipses and polylines, with which buttons and notches are drawn.
/// - Edge names in a group: the text "edge: hem" gives the name "hem" to the edge that is nearest to the start of the
///   text; an edge extends from corner to corner. If several texts name one edge, each curve of the edge gets the name
///   nearest to it. Edges without a text are named by their numbers, counted from 1 at the first corner.
/// - Origin in a group: a text "origin" marks the origin of the panel. Without this text, the panel has the origin of
///   the group. Ignores other texts.
/// Throws Error(asset_unreadable); the message starts with file:line:column.
DrawnPanel load_svg_panel(const std::filesystem::path& file, const std::string& id);

}  // namespace weft::garment
