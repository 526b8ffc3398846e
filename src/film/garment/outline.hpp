// Outlines of panels: closed chains of curves, written as SVG paths.
#pragma once

#include <array>
#include <charconv>
#include <string>
#include <string_view>
#include <vector>

#include "core/types.hpp"

namespace weft::garment {

/// A cubic Bézier curve with its control points. On a straight line, the inner control points are at 1/3 and 2/3.
struct Curve {
  std::array<Vec2, 4> control;
  bool continues_arc = false;  ///< whether the curve and the preceding one are pieces of the same SVG arc

  const Vec2& start() const { return control[0]; }
  const Vec2& end() const { return control[3]; }
  Vec2 at(double t) const;
  Curve reversed() const { return {{control[3], control[2], control[1], control[0]}, continues_arc}; }
};

Curve straight(const Vec2& from, const Vec2& to);

/// A closed chain: each curve starts at the end of the preceding one, the first at the end of the last.
using Outline = std::vector<Curve>;

/// As std::from_chars(), but also accepts a leading plus sign, as SVG does.
std::from_chars_result parse_number(std::string_view text, double& value);

struct ParsedPath {
  Outline outline;
  /// Description, such as: expected a number, got "x" at character 12. Empty if there is no mistake.
  std::string mistake;
};
struct ParsedPaths {
  std::vector<Outline> outlines;  ///< one or more, if there is no mistake
  std::string mistake;            ///< as ParsedPath::mistake
};

/// Reads closed outlines from path data of SVG 1.1 (section 8.3), in the units of the data. Each outline must end with
/// Z or at its start point, with a gap of at most kMaxClosingGap (outline.cpp). Splits an arc into cubic curves of at
/// most a quarter turn each (maximum error: 3e-4 of the radius). Ignores curves of zero length.
ParsedPaths parse_paths(std::string_view data);

/// As parse_paths(), but reports a mistake if the data have several outlines.
ParsedPath parse_path(std::string_view data);

/// Whether two consecutive curves meet at a corner, that is, at an angle above kMinCornerAngle (outline.cpp).
bool has_corner(const Curve& before, const Curve& after);

/// For each curve, the number of its edge. An edge extends from one corner to the next; edge 0 starts at the first
/// corner. Without corners, all curves belong to edge 0.
std::vector<std::size_t> edges_between_corners(const Outline& outline);

/// Number of points of each curve in sample_points().
inline constexpr int kPointsPerCurve = 16;

/// kPointsPerCurve points on each curve of a chain, at equal steps of the curve parameter, from the start of each
/// curve. The end of the chain is not included.
std::vector<Vec2> sample_points(const std::vector<Curve>& chain);

/// Arc length along a chain of curves; finds the point at a given fraction of the length.
class Arclength {
 public:
  explicit Arclength(const std::vector<Curve>& chain);

  double length() const { return sums_.back(); }
  /// The point at `fraction` times the length from the start.
  Vec2 at(double fraction) const;

 private:
  std::vector<Vec2> points_;
  std::vector<double> sums_;  // length from the start to each point
};

}  // namespace weft::garment
