// Declarations for the sources of the mannequin: scale factors, and shapes that are placed in table units.
#pragma once

#include "film/character/loft.hpp"

namespace weft::character {

/// Converts values of the tables to metres. The tables are in centimetres, for a body of the height kTableHeight
/// ("table units"); the metres are those of a MannequinBuild.
struct Scale {
  double length = 0.01;  ///< metres per table unit along the body
  double girth = 0.01;   ///< metres per table unit across the body
  double masculinity = 0;

  /// Interpolates by masculinity.
  double blend(double woman, double man) const { return woman + masculinity * (man - woman); }
};

/// A table of cross-sections. Each row has: position along the axis, centre (two values), half width, depth to the
/// front, depth to the back, exponent.
using Rows = std::vector<Section>;

/// Scales sections to metres. Widths and depths scale with the girth if `grows`, else with the length.
Rows scale_sections(Rows rows, const Scale& scale, bool grows = true);

/// An ellipsoid. `middle` and `half`: its centre and half axes, as components to the left, forward and up [table
/// units]. It is rotated about its centre, first by `pitch`, then by `yaw` [degrees]. A positive pitch tilts the top
/// forward; a positive yaw turns the front to the left.
Loft ellipsoid(const Scale& scale, const Vec3& middle, const Vec3& half, double pitch = 0, double yaw = 0);

/// Adds the head with face, ears and hair. The neck must be added before.
void add_head(BlendedBody& body, const Scale& scale);

/// Adds the hand of the arm with the frame `arm`, whose origin is the shoulder, and its mirror image.
void add_hand(BlendedBody& body, const Scale& scale, const LoftFrame& arm);

/// Distance from the hairline, negative inside the hair, on a body of the height kTableHeight [cm]. The hairline is the
/// same on both sides of the head. `backward`, `up`: the y and the z coordinate [cm].
double hairline_distance(double backward, double up);

/// Centre of the knot of hair (backward, up) and its approximate radius [cm].
inline const Vec2 kKnot(9.6, 167.6);
inline constexpr double kKnotRadius = 3.3;

}  // namespace weft::character
