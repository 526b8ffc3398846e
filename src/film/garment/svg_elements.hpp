// Elements of SVG drawings: their places in the file, units, transforms and outlines.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "core/types.hpp"
#include "film/garment/outline.hpp"

namespace weft::garment {

/// A parsed SVG file. Converts elements to outlines in metres, with y upward. Reports errors with their place in the
/// file: its functions throw Error(asset_unreadable).
class Drawing {
 public:
  explicit Drawing(const std::filesystem::path& file);

  [[noreturn]] void refuse(std::ptrdiff_t offset, const std::string& text) const;
  [[noreturn]] void refuse(const pugi::xml_node& node, const std::string& text) const;

  pugi::xml_node root() const { return document_.document_element(); }
  /// The element with an id or Inkscape label, or with a number such as "path:2"; refuses others.
  pugi::xml_node find(const std::string& id) const;

  Eigen::Affine2d to_metres(const pugi::xml_node& element) const;
  /// The outline of the panel that the element draws [m].
  Outline outline(const pugi::xml_node& element) const;

 private:
  pugi::xml_node find_numbered(const std::string& id) const;
  std::string suggest_ids(const std::string& id) const;

  std::filesystem::path file_;
  std::string text_;
  pugi::xml_document document_;
  double unit_ = 1;  // size of one unit of the drawing [m]
};

/// A coordinate or a length of an element, in units of the element, which are CSS pixels; 0 if the text is empty. Of a
/// list, such as the places of all letters of a text, returns the first. Returns nothing if it is no length.
std::optional<double> parse_coordinate(std::string_view text);

/// Whether an element is a path or polyline whose data give closed outlines.
bool is_closed_line(const pugi::xml_node& node);

}  // namespace weft::garment
