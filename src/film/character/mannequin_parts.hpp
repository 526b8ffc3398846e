// Shared by the tables of the mannequin: scale factors of one build, and shapes placed in centimetres.
#pragma once

#include "film/character/loft.hpp"

namespace weft::character {

/// Converts table values to metres for one build.
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

/// An ellipsoid with its centre and half axes given to the left, forward and up [cm]. It is rotated about its centre:
/// first by `pitch`, + forward, then by `yaw`, + to the left [degrees].
Loft ellipsoid(const Scale& scale, const Vec3& middle, const Vec3& half, double pitch = 0, double yaw = 0);

/// Adds the head with face, ears and hair; call it after the neck is added.
void add_head(BlendedBody& body, const Scale& scale);

/// Adds the hand of an arm with the frame `arm`, whose origin is the shoulder.
void add_hand(BlendedBody& body, const Scale& scale, const LoftFrame& arm);

/// Distance from the hairline [cm], negative inside the hair, on a body of height kTableHeight. The hairline is the
/// same on both sides. `backward`: the y coordinate.
double hairline_distance(double backward, double up);

/// Centre of the knot of hair (backward, up) and its approximate radius [cm].
inline const Vec2 kKnot(9.6, 167.6);
inline constexpr double kKnotRadius = 3.3;

}  // namespace weft::character
