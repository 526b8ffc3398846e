#include "film/garment/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "film/garment/svg_elements.hpp"
#include "film/garment/triangulation.hpp"

namespace weft::garment {
namespace {

/// A text that names an edge.
struct Label {
  std::string text;
  Vec2 place;  ///< [m]
};

/// The outlines and labels of a panel in a group.
struct Group {
  std::vector<pugi::xml_node> outlines;  ///< paths, polygons and rects
  std::vector<pugi::xml_node> others;    ///< circles, ellipses and polylines: marks if there are outlines
  std::vector<Label> edges;
  std::optional<Vec2> origin;
};

/// The text of a node and of its descendants.
std::string words_in(const pugi::xml_node& node) {
  std::string words = node.value();
  for (const pugi::xml_node& child : node.children()) words += words_in(child);
  return words;
}

void read_text(const Drawing& drawing, const pugi::xml_node& node, Group& group) {
  std::istringstream stream(words_in(node));
  std::string first, name, more;
  stream >> first;
  if (first != "origin" && !first.starts_with("edge:")) return;
  const auto coordinate = [&](const char* key) {
    const pugi::xml_attribute own = node.attribute(key);
    return parse_coordinate((own ? own : node.child("tspan").attribute(key)).value());
  };
  const auto x = coordinate("x"), y = coordinate("y");
  if (!x || !y || node.child("textPath"))
    drawing.refuse(node, "expected x and y where a label stands, got something else");
  // An absent coordinate is 0 (SVG 1.1, section 10.4). Illustrator writes texts with a transform, but without x and y.
  const Vec2 place = drawing.to_metres(node) * Vec2(*x, *y);
  if (!place.allFinite()) drawing.refuse(node, "expected finite coordinates, got infinite or undefined ones");
  if (first == "origin") {
    group.origin = place;
    return;
  }
  name = first.substr(5);
  if (name.empty()) stream >> name;
  const auto is_name_character = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
  };
  if (name.empty() || !std::ranges::all_of(name, is_name_character) || stream >> more)
    drawing.refuse(node, "expected edge: and a name of letters, digits, _ and -, got something else");
  group.edges.push_back({name, place});
}

/// Whether an element of FreeSewing is a seam allowance, a scale box or another mark, not the outline of a panel.
bool is_mark(const pugi::xml_node& node) {
  constexpr std::array<std::string_view, 6> kMarks{"sa", "scalebox", "note", "mark", "help", "hidden"};
  std::istringstream classes(node.attribute("class").value());
  return std::any_of(std::istream_iterator<std::string>(classes), {},
                     [&](const std::string& name) { return std::ranges::find(kMarks, name) != kMarks.end(); });
}

void read_group(const Drawing& drawing, const pugi::xml_node& node, Group& group) {
  for (const pugi::xml_node& child : node.children()) {
    const std::string_view kind = child.name();
    if (kind == "text") {
      read_text(drawing, child, group);
    } else if (is_mark(child)) {
      continue;
    } else if (kind == "g") {
      read_group(drawing, child, group);
    } else if (kind == "polygon" || kind == "rect" || (kind == "path" && is_closed_line(child))) {
      group.outlines.push_back(child);
    } else if (kind == "circle" || kind == "ellipse" || (kind == "polyline" && is_closed_line(child))) {
      group.others.push_back(child);
    }
  }
}

// Distance of a point from a curve, which is taken as 16 straight lines.
double distance(const Curve& curve, const Vec2& from) {
  constexpr int kPieces = 16;
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kPieces; ++i)
    nearest = std::min(nearest, distance_sq(from, curve.at(double(i) / kPieces), curve.at(double(i + 1) / kPieces)));
  return std::sqrt(nearest);
}

/// The edge name of each curve: the nearest label of its edge, or the number of the edge if the edge has no label.
std::vector<std::string> name_edges(const Outline& outline, const std::vector<Label>& labels) {
  const std::size_t n = outline.size();
  const std::vector<std::size_t> edge = edges_between_corners(outline);
  std::vector<std::vector<const Label*>> of_edge(*std::ranges::max_element(edge) + 1);
  for (const Label& label : labels) {
    const auto nearest =
        std::ranges::min_element(outline, {}, [&](const Curve& c) { return distance(c, label.place); });
    of_edge[edge[static_cast<std::size_t>(nearest - outline.begin())]].push_back(&label);
  }
  std::vector<std::string> names;
  for (std::size_t k = 0; k < n; ++k) {
    const auto& own = of_edge[edge[k]];
    const auto away = [&](const Label* label) { return (outline[k].at(0.5) - label->place).norm(); };
    names.push_back(own.empty() ? std::to_string(edge[k] + 1) : (*std::ranges::min_element(own, {}, away))->text);
  }
  return names;
}

DrawnPanel read_panel_group(const Drawing& drawing, const pugi::xml_node& node) {
  Group group;
  read_group(drawing, node, group);
  if (group.outlines.empty()) group.outlines = std::move(group.others);
  if (group.outlines.size() != 1)
    drawing.refuse(node,
                   fmt::format("expected a group with one closed outline, got {}; name the outline itself by its id",
                               group.outlines.size()));
  DrawnPanel panel{drawing.outline(group.outlines[0]), {}};
  if (!group.edges.empty()) panel.names = name_edges(panel.outline, group.edges);
  // Without an origin text, uses the origin of the group, so that the panel does not change if the group is moved on
  // the sheet.
  const Vec2 origin = group.origin.value_or(drawing.to_metres(node) * Vec2(0, 0));
  for (Curve& curve : panel.outline)
    for (Vec2& p : curve.control) p -= origin;
  return panel;
}

}  // namespace

DrawnPanel load_svg_panel(const std::filesystem::path& file, const std::string& id) {
  const Drawing drawing(file);
  const pugi::xml_node element = drawing.find(id);
  if (std::string_view(element.name()) == "g") return read_panel_group(drawing, element);
  return {drawing.outline(element), {}};
}

}  // namespace weft::garment
