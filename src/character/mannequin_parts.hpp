// What the tables of the mannequin share: sizes of one build, and shapes placed in centimetres.
#pragma once

#include "character/loft.hpp"

namespace weft::character {

/// What turns table values into metres for one build.
struct Scale {
  double length = 0.01;  ///< along the body
  double girth = 0.01;   ///< across it
  double masculinity = 0;

  double blend(double woman, double man) const { return woman + masculinity * (man - woman); }
};

/// A row of a table: place along the axis, middle, half width, depth to front and back, exponent.
using Rows = std::vector<Section>;

/// Scales sections; `grows` tells whether they take part in the girth.
Rows scaled(Rows rows, const Scale& scale, bool grows = true);

/// An ellipsoid around a point, given to the left, forward and up [cm], as its half axes are. It is turned about its
/// middle: first nodding by `pitch`, + forward, then by `yaw`, + to the left [degrees].
Loft ellipsoid(const Scale& scale, const Vec3& middle, const Vec3& half, double pitch = 0, double yaw = 0);

/// Head with its face, ears and hair; the neck is there.
void add_head(BlendedBody& body, const Scale& scale);

/// The hand of an arm that lies as `arm`, whose origin is the shoulder.
void add_hand(BlendedBody& body, const Scale& scale, const LoftFrame& arm);

/// Where hair grows, in centimetres, for a height of kTableHeight: the distance from the hairline, which is the same
/// seen from both sides, negative where there is hair. `backward`: y.
double hairline_distance(double backward, double up);

/// Middle of the knot of hair: backward, up [cm], and about how far it reaches.
inline const Vec2 kKnot(9.6, 167.6);
inline constexpr double kKnotRadius = 3.3;

}  // namespace weft::character
