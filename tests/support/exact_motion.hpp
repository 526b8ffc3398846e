// Exact test whether two triangles, or an edge and a triangle, meet during linear motion: polynomials in time with
// integer coefficients. Shares no code with the collision modules.
#pragma once

#include <array>

#include "core/types.hpp"

namespace weft::support {

/// Two points (an edge) or three (a triangle) that move at constant velocity from t = 0 to t = 1. May be degenerate.
struct MovingSimplex {
  int count = 3;
  std::array<Vec3, 3> t0, t1;

  /// The edge opposite to a corner of a triangle.
  MovingSimplex edge_opposite(int corner) const;
};

/// Result of a test for contact.
struct Contact {
  bool found = false;
  double time = -1;            ///< time of a contact if one is found, not always the first; rounded
  bool integers_used = false;  ///< whether interval arithmetic did not suffice
};

/// Whether a and b, which have no vertex in common, touch or cross at any t in [0, 1]. Exact for the given doubles,
/// which must be finite; touching counts.
Contact find_contact(const MovingSimplex& a, const MovingSimplex& b);

/// For two triangles whose corners i of a and j of b are the same vertex: whether they meet elsewhere. They do if and
/// only if the opposite edge of one meets the other triangle.
Contact find_contact_beside_shared(const MovingSimplex& a, int i, const MovingSimplex& b, int j);

}  // namespace weft::support
