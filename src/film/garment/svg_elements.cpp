#include "film/garment/svg_elements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <numbers>
#include <span>
#include <stdexcept>
#include <vector>

#include "core/error.hpp"
#include "core/input_file.hpp"
#include "core/nearest.hpp"
#include "core/nesting.hpp"

namespace weft::garment {
namespace {

// Maximum size of a drawing [bytes]. A pattern of ten panels has some kilobytes.
constexpr std::uintmax_t kMaxSvgBytes = std::uintmax_t{16} << 20;
constexpr double kMetresPerPixel = 0.0254 / 96;
// Maximum distance between the bounding boxes of a seam line and of its seam allowance, on each side of a panel [m].
// Allowances are 10 to 30 mm wide, and wider at corners.
constexpr double kMaxAllowance = 0.06;
// Maximum number of numbers in one attribute.
constexpr std::size_t kMaxNumbers = 20000;
using Affine = Eigen::Affine2d;
using Box = Eigen::AlignedBox2d;

/// Stops a traversal at elements that are nested more deeply than kMaxDepth. Functions that read groups are recursive
/// and could overflow the stack; pugixml is not recursive.
struct DepthLimit : pugi::xml_tree_walker {
  bool for_each(pugi::xml_node&) override { return depth() < kMaxDepth; }
};

bool is_shape(const pugi::xml_node& node) {
  constexpr std::array<std::string_view, 7> kShapes{"path", "polygon", "polyline", "rect", "circle", "ellipse", "g"};
  return std::ranges::find(kShapes, node.name()) != kShapes.end();
}

// Whether the element is drawn itself. Elements inside others such as `defs` are drawn only where another element
// refers to them.
bool is_drawn(const pugi::xml_node& node) {
  constexpr std::array<std::string_view, 6> kNotDrawn{"defs", "marker", "clipPath", "mask", "symbol", "pattern"};
  for (pugi::xml_node above = node.parent(); above; above = above.parent())
    if (std::ranges::find(kNotDrawn, above.name()) != kNotDrawn.end()) return false;
  return true;
}

std::string id_of(const pugi::xml_node& node) {
  const std::string id = node.attribute("id").value();
  return id.empty() ? "" : fmt::format(" \"{}\"", id.substr(0, 40));
}

// The numbers of a text, separated by white space or commas. Returns nothing if the text contains anything else or more
// than kMaxNumbers numbers.
std::optional<std::vector<double>> parse_numbers(std::string_view text) {
  std::vector<double> numbers;
  for (;;) {
    const std::size_t start = text.find_first_not_of(" \t\r\n,");
    if (start == std::string_view::npos) return numbers;
    text.remove_prefix(start);
    double value = 0;
    const auto [end, error] = parse_number(text, value);
    if (error != std::errc() || !std::isfinite(value) || numbers.size() == kMaxNumbers) return std::nullopt;
    numbers.push_back(value);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  }
}

// Converts a length such as "210mm" to metres. Returns nothing for percentages, units relative to a font, and invalid
// text.
std::optional<double> parse_length(std::string_view text) {
  double value = 0;
  const auto [end, error] = parse_number(text, value);
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  const std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
  if (unit.empty() || unit == "px") return value * kMetresPerPixel;
  if (unit == "mm") return value * 1e-3;
  if (unit == "cm") return value * 1e-2;
  if (unit == "in") return value * 0.0254;
  if (unit == "pt") return value * 0.0254 / 72;
  if (unit == "pc") return value * 0.0254 / 6;
  return std::nullopt;
}

// The size of a sheet [m]. Returns nothing if it is ≤ 0 or no length.
std::optional<double> parse_size(std::string_view text) {
  const std::optional<double> length = parse_length(text);
  return length && *length > 0 ? length : std::nullopt;
}

using Numbers = std::optional<std::vector<double>>;
void check_view_box(const Drawing& drawing, const pugi::xml_node& node, const Numbers& box) {
  if (!box || box->size() != 4 || !((*box)[2] > 0) || !((*box)[3] > 0))
    drawing.refuse(node, "viewBox: expected x, y, width > 0 and height > 0, got something else");
}

// Size of one unit of the drawing [m].
double metres_per_unit(const Drawing& drawing) {
  const pugi::xml_node root = drawing.root();
  const auto width = parse_size(root.attribute("width").value());
  const auto box = parse_numbers(root.attribute("viewBox").value());
  if (!root.attribute("viewBox")) {
    // Before version 0.92, Inkscape drew 90 units per inch.
    double version = 0;
    const bool known = parse_number(root.attribute("inkscape:version").value(), version).ec == std::errc();
    return known && version < 0.92 ? 0.0254 / 90 : kMetresPerPixel;
  }
  check_view_box(drawing, root, box);
  if (!width) drawing.refuse(root, "width: expected the size of the sheet, such as 210mm, beside a viewBox, got none");
  double unit = *width / (*box)[2];
  // If the height is also given, the smaller of the two units applies, as in browsers. Refuses files whose
  // preserveAspectRatio demands otherwise.
  if (const auto height = parse_size(root.attribute("height").value())) {
    constexpr double kMaxDifference = 1e-3;  // relative difference of both units due to rounded sizes
    const double up = *height / (*box)[3];
    const std::string_view ratio = root.attribute("preserveAspectRatio").value();
    const bool meets = ratio.find("none") == std::string_view::npos && ratio.find("slice") == std::string_view::npos;
    if (!meets && std::abs(up / unit - 1) > kMaxDifference)
      drawing.refuse(root, fmt::format("preserveAspectRatio: expected meet, as width and height give different scales, "
                                       "got \"{}\"",
                                       ratio.substr(0, 40)));
    unit = std::min(unit, up);
  }
  return unit;
}

// A single transform of SVG 1.1, section 7.6. Returns nothing if it is invalid.
std::optional<Affine> transform_of(std::string_view kind, const std::vector<double>& p) {
  const auto radians = [](double degrees) { return degrees * std::numbers::pi / 180; };
  Affine t = Affine::Identity();
  const std::size_t n = p.size();
  if (kind == "matrix" && n == 6) {
    t.matrix().topRows<2>() << p[0], p[2], p[4], p[1], p[3], p[5];
  } else if (kind == "translate" && (n == 1 || n == 2)) {
    t.translate(Vec2(p[0], n == 2 ? p[1] : 0));
  } else if (kind == "scale" && (n == 1 || n == 2)) {
    t.scale(Vec2(p[0], n == 2 ? p[1] : p[0]));
  } else if (kind == "rotate" && (n == 1 || n == 3)) {
    const Vec2 about = n == 3 ? Vec2(p[1], p[2]) : Vec2(0, 0);
    t.translate(about).rotate(radians(p[0])).translate(-about);
  } else if (kind == "skewX" && n == 1) {
    t.matrix()(0, 1) = std::tan(radians(p[0]));
  } else if (kind == "skewY" && n == 1) {
    t.matrix()(1, 0) = std::tan(radians(p[0]));
  } else {
    return std::nullopt;
  }
  return t;
}

Affine parse_transform(const Drawing& drawing, const pugi::xml_node& node) {
  std::string_view text = node.attribute("transform").value();
  Affine all = Affine::Identity();
  for (;;) {
    const std::size_t start = text.find_first_not_of(" \t\r\n,");
    if (start == std::string_view::npos) return all;
    const std::size_t open = text.find('(', start), close = text.find(')', start);
    std::optional<Affine> one;
    if (open < close && close != std::string_view::npos) {
      std::string_view kind = text.substr(start, open - start);
      kind = kind.substr(0, kind.find_last_not_of(" \t\r\n") + 1);
      if (const auto numbers = parse_numbers(text.substr(open + 1, close - open - 1)))
        one = transform_of(kind, *numbers);
    }
    if (!one) drawing.refuse(node, "transform: expected such as translate(1 2) or rotate(30), got something else");
    all = all * *one;
    text.remove_prefix(close + 1);
  }
}

// The map from coordinates inside a nested svg element to those of its parent.
Affine place_nested(const Drawing& drawing, const pugi::xml_node& node) {
  const auto x = parse_coordinate(node.attribute("x").value()), y = parse_coordinate(node.attribute("y").value());
  const auto width = parse_size(node.attribute("width").value()), height = parse_size(node.attribute("height").value());
  const std::string_view ratio = node.attribute("preserveAspectRatio").as_string("xMidYMid meet");
  if (!x || !y) drawing.refuse(node, "expected x and y as numbers, got something else");
  Affine t = Affine::Identity();
  t.translate(Vec2(*x, *y));
  if (!node.attribute("viewBox")) return t;
  const auto box = parse_numbers(node.attribute("viewBox").value());
  check_view_box(drawing, node, box);
  if (!width || !height || (ratio != "xMidYMid meet" && ratio != "xMidYMid"))
    drawing.refuse(node, "expected width, height and preserveAspectRatio xMidYMid of a nested drawing, got others");
  const Vec2 size = Vec2(*width, *height) / kMetresPerPixel, inner((*box)[2], (*box)[3]);
  const double scale = size.cwiseQuotient(inner).minCoeff();
  return t.translate(0.5 * (size - scale * inner)).scale(scale).translate(-Vec2((*box)[0], (*box)[1]));
}

// Path data of an element that is written as points or as path data; empty for other elements.
std::string line_data(const pugi::xml_node& node) {
  const std::string_view kind = node.name();
  if (kind == "path") return node.attribute("d").value();
  if (kind != "polygon" && kind != "polyline") return {};
  return fmt::format("M {}{}", node.attribute("points").value(), kind == "polygon" ? " Z" : "");
}

// The outlines of an element, in the coordinates of the element.
std::vector<Outline> outlines_of(const Drawing& drawing, const pugi::xml_node& node) {
  const std::string_view kind = node.name();
  const bool is_circle = kind == "circle", is_round = is_circle || kind == "ellipse";
  const auto number = [&](const char* key) { return parse_coordinate(node.attribute(key).value()); };
  std::string data = line_data(node);
  if (is_round) {
    const auto x = number("cx"), y = number("cy"), rx = number(is_circle ? "r" : "rx"),
               ry = number(is_circle ? "r" : "ry");
    if (!x || !y || !rx || !ry || !(*rx > 0) || !(*ry > 0))
      drawing.refuse(node, "expected the centre and radii > 0 as numbers, got something else");
    data = fmt::format("M {0} {1} a {2} {3} 0 0 1 {4} 0 a {2} {3} 0 0 1 {5} 0 Z", *x + *rx, *y, *rx, *ry, -2 * *rx,
                       2 * *rx);
  } else if (kind == "rect") {
    const auto x = number("x"), y = number("y"), width = number("width"), height = number("height");
    if (!x || !y || !width || !height || *width == 0 || *height == 0)
      drawing.refuse(node, "expected x, y, width and height as numbers, got something else");
    const auto round_x = number("rx"), round_y = number("ry");
    if (!round_x || !round_y) drawing.refuse(node, "expected rx and ry as numbers, got something else");
    // If only one radius is given, it applies to both axes. Radii are limited to half the size.
    const auto& rx_or_ry = node.attribute("rx") ? round_x : round_y;
    const auto& ry_or_rx = node.attribute("ry") ? round_y : round_x;
    const double left = *x, top = *y, w = *width, h = *height;
    const double rx = std::min(*rx_or_ry, 0.5 * w), ry = std::min(*ry_or_rx, 0.5 * h);
    if (rx > 0 && ry > 0)
      data = fmt::format(
          "M {0} {1} h {2} a {4} {5} 0 0 1 {4} {5} v {3} a {4} {5} 0 0 1 -{4} {5} "
          "h -{2} a {4} {5} 0 0 1 -{4} -{5} v -{3} a {4} {5} 0 0 1 {4} -{5} Z",
          left + rx, top, w - 2 * rx, h - 2 * ry, rx, ry);
    else
      data = fmt::format("M {} {} h {} v {} h {} Z", left, top, w, h, -w);
  } else if (kind != "path" && kind != "polygon" && kind != "polyline") {
    drawing.refuse(node,
                   "expected a path, polygon, closed polyline, rect, circle or ellipse, got another element; id names "
                   "the outline itself");
  }
  ParsedPaths parsed = parse_paths(data);
  if (!parsed.mistake.empty()) drawing.refuse(node, parsed.mistake);
  // A circle is one edge, though it is written as two arcs.
  if (is_round)
    for (std::size_t k = 1; k < parsed.outlines[0].size(); ++k) parsed.outlines[0][k].continues_arc = true;
  return std::move(parsed.outlines);
}

}  // namespace

Drawing::Drawing(const std::filesystem::path& file) : file_(file) {
  try {
    text_ = read_bytes(file, kMaxSvgBytes);
  } catch (const std::runtime_error& error) {
    refuse(0, fmt::format("expected a file, got none that can be read: {}", error.what()));
  }
  const pugi::xml_parse_result result = document_.load_buffer(text_.data(), text_.size());
  if (!result) refuse(result.offset, fmt::format("expected valid XML: {}", result.description()));
  DepthLimit limit;
  if (!document_.traverse(limit)) refuse(0, fmt::format("expected at most {} nested elements, got more", kMaxDepth));
  unit_ = metres_per_unit(*this);
}

void Drawing::refuse(std::ptrdiff_t offset, const std::string& text) const {
  const auto end = text_.begin() + std::clamp<std::ptrdiff_t>(offset, 0, static_cast<std::ptrdiff_t>(text_.size()));
  const auto line = std::find(std::reverse_iterator(end), text_.rend(), '\n').base();
  throw Error(ExitCode::asset_unreadable, "{}:{}:{}: {}", file_.string(), 1 + std::count(text_.begin(), end, '\n'),
              1 + (end - line), text);
}

void Drawing::refuse(const pugi::xml_node& node, const std::string& text) const {
  refuse(node.offset_debug(), fmt::format("{}{}: {}", node.name(), id_of(node), text));
}

pugi::xml_node Drawing::find(const std::string& id) const {
  for (const char* key : {"id", "inkscape:label"})
    if (const auto found =
            document_.find_node([&](const auto& n) { return !id.empty() && id == n.attribute(key).value(); }))
      return found;
  if (const auto numbered = find_numbered(id)) return numbered;
  refuse(0, fmt::format("expected an element with the id or label \"{}\", got none; {}", id, suggest_ids(id)));
}

// Finds an element by number: "path:2" is the second drawn path. Programs such as Valentina write no ids.
pugi::xml_node Drawing::find_numbered(const std::string& id) const {
  const std::size_t colon = id.find(':');
  if (colon == std::string::npos) return {};
  std::size_t number = 0, seen = 0;
  const auto [end, error] = std::from_chars(id.data() + colon + 1, id.data() + id.size(), number);
  if (error != std::errc() || end != id.data() + id.size()) return {};
  return document_.find_node([&](const pugi::xml_node& node) {
    return is_shape(node) && id.compare(0, colon, node.name()) == 0 && is_drawn(node) && ++seen == number;
  });
}

// Text that suggests ids, for the message about an unknown id.
std::string Drawing::suggest_ids(const std::string& id) const {
  std::vector<std::string> known;
  std::size_t paths = 0;
  document_.find_node([&](const pugi::xml_node& node) {
    paths += std::string_view(node.name()) == "path" && is_drawn(node) ? 1 : 0;
    for (const char* key : {"id", "inkscape:label"})
      if (const std::string text = node.attribute(key).value(); is_shape(node) && !text.empty()) known.push_back(text);
    return false;
  });
  if (known.empty())
    return fmt::format("none of its {} paths has one: \"path:1\" is the first of them, in the order of the file",
                       paths);
  const std::string nearest = nearest_name(id, known);
  if (!nearest.empty()) return fmt::format("did you mean \"{}\"?", nearest);
  constexpr std::size_t kMaxSuggestions = 12;
  const std::size_t named = std::min(known.size(), kMaxSuggestions);
  return fmt::format("it has \"{}\"{}", fmt::join(std::span(known).first(named), "\", \""),
                     named < known.size() ? ", ..." : "");
}

std::optional<double> parse_coordinate(std::string_view text) {
  constexpr std::string_view kSeparators = " \t\r\n,";
  const std::size_t start = text.find_first_not_of(kSeparators);
  if (start == std::string_view::npos) return 0;
  const auto length = parse_length(text.substr(start, text.find_first_of(kSeparators, start) - start));
  if (!length) return std::nullopt;
  return *length / kMetresPerPixel;
}

bool is_closed_line(const pugi::xml_node& node) {
  const std::string data = line_data(node);
  return !data.empty() && parse_paths(data).mistake.empty();
}

Affine Drawing::to_metres(const pugi::xml_node& element) const {
  Affine transform = Affine::Identity();
  for (pugi::xml_node node = element; node && node != root(); node = node.parent()) {
    if (std::string_view(node.name()) == "svg") transform = place_nested(*this, node) * transform;
    transform = parse_transform(*this, node) * transform;
  }
  return Eigen::Scaling(unit_, -unit_) * transform;
}

Outline Drawing::outline(const pugi::xml_node& element) const {
  std::vector<Outline> outlines = outlines_of(*this, element);
  const Affine transform = to_metres(element);
  std::vector<Box> boxes(outlines.size());
  for (std::size_t i = 0; i < outlines.size(); ++i)
    for (Curve& curve : outlines[i])
      for (Vec2& p : curve.control) {
        p = transform * p;
        if (!p.allFinite()) refuse(element, "expected finite coordinates, got infinite or undefined ones");
        boxes[i].extend(p);
      }
  if (outlines.size() == 1) return std::move(outlines[0]);
  // Valentina and Seamly draw one path with two outlines: the seam line, and the seam allowance around it.
  if (outlines.size() == 2)
    for (const std::size_t i : {0, 1}) {
      const Box &inner = boxes[i], &outer = boxes[1 - i];
      const double margin = std::max((inner.min() - outer.min()).maxCoeff(), (outer.max() - inner.max()).maxCoeff());
      if (outer.contains(inner) && margin <= kMaxAllowance) return std::move(outlines[i]);
    }
  refuse(element, fmt::format("expected one outline, or a seam line with its allowance around it, got {} "
                              "outlines",
                              outlines.size()));
}

}  // namespace weft::garment
