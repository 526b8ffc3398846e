// Shared by the tables of the mannequin: scale factors for one physique, and shapes placed in table units.
#pragma once

#include "film/character/loft.hpp"

namespace weft::character {

/// Converts table values, which are centimetres at a body height of kTableHeight, to metres for one MannequinBuild.
struct Scale {
  double length = 0.01;  ///< metres per table unit along the body
  double girth = 0.01;   ///< metres per table unit across the body
  double masculinity = 0;

  double blend(double woman, double man) const { return woman + masculinity * (man - woman); }
};

/// Rows of a table: position along the axis, centre, half width, depth to front and back, exponent.
using Rows = std::vector<Section>;

/// Scales sections to metres; widths and depths by the girth if `grows`, else by the length.
Rows scaled(Rows rows, const Scale& scale, bool grows = true);

/// An ellipsoid. `middle` and `half`: its centre and half axes as components to the left, forward and up [table units].
/// It is rotated about its centre: first by `pitch`, which tilts the top forward if positive, then by `yaw`, which
/// turns the front to the left if positive [degrees].
Loft ellipsoid(const Scale& scale, const Vec3& middle, const Vec3& half, double pitch = 0, double yaw = 0);

/// Adds the head with face, ears and hair; call it after the neck is added.
void add_head(BlendedBody& body, const Scale& scale);

/// Adds both hands: that of the arm with the frame `arm`, whose origin is the shoulder, and its mirror image.
void add_hand(BlendedBody& body, const Scale& scale, const LoftFrame& arm);

/// Distance from the hairline [cm], negative inside the hair, on a body of height kTableHeight. The hairline is the
/// same on both sides. `backward`: the y coordinate.
double hairline_distance(double backward, double up);

/// Centre of the knot of hair (backward, up) and its approximate radius [cm].
inline const Vec2 kKnot(9.6, 167.6);
inline constexpr double kKnotRadius = 3.3;

}  // namespace weft::character
