// Outlines of pattern pieces: closed chains of curves, written as SVG paths.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "core/types.hpp"

namespace weft::garment {

/// A cubic Bézier curve by its control points; a straight line has them at thirds.
struct Curve {
  std::array<Vec2, 4> control;
  bool goes_on = false;  ///< with the curve before: both are of one arc

  const Vec2& start() const { return control[0]; }
  const Vec2& end() const { return control[3]; }
  Vec2 at(double t) const;
  Curve reversed() const { return {{control[3], control[2], control[1], control[0]}, goes_on}; }
};

Curve straight(const Vec2& from, const Vec2& to);

/// Each curve starts where the one before ends, the first where the last ends.
using Outline = std::vector<Curve>;

struct ParsedPath {
  Outline outline;
  std::string mistake;  ///< "expected a number, got "x" at character 12"; empty: none
};

/// One closed outline from the path data of SVG 1.1 (section 8.3), in its own units; arcs become cubic curves, a
/// quarter turn each at most (off by 3e-4 of the radius). Curves without length are left out.
ParsedPath parse_path(std::string_view data);

/// Lengths along a chain of curves, to place points at equal distances on it.
class Arclength {
 public:
  explicit Arclength(const std::vector<Curve>& chain);

  double length() const { return sums_.back(); }
  /// The point after this share of the length.
  Vec2 at(double share) const;

 private:
  std::vector<Vec2> points_;
  std::vector<double> sums_;  // length from the start to each point
};

}  // namespace weft::garment
