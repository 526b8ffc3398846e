// Material constants and start shapes of ropes, and the one-dimensional cloth that is simulated for a rope.
#pragma once

#include <string>
#include <vector>

#include "film/scene/scene.hpp"

namespace weft::scene {

/// Constants of a kind of rope. `mass` and `stretch` are the values of a rope divided by the square of its diameter.
struct RopeMaterial {
  std::string name;
  double mass;            ///< mass per length / diameter² [kg/m per m²]
  double stretch;         ///< force per strain / diameter² [N per m²]
  double bending_length;  ///< cube root of (bending stiffness / weight per length) [diameters]
};
const std::vector<RopeMaterial>& rope_materials();

/// Mass and stiffness of one rope. Values that the scene omits follow from material and diameter.
struct RopeNumbers {
  double mass;     ///< [kg/m]
  double stretch;  ///< stiffness EA: force per strain [N]
  double bend;     ///< bending stiffness EI [N·m²]
};
RopeNumbers numbers_of(const Rope& rope);

/// Start positions of the particles of a rope [m], and rest lengths of the pieces between them [m]. A closed rope has
/// as many pieces as particles, an open one has one piece less.
struct RopeShape {
  std::vector<Vec3> places;
  std::vector<double> lengths;
};
/// The start shape of a rope: a catenary if hangs_slack(), else the path through its points or
/// between its ends. `up`: up axis of the scene.
RopeShape start_shape(const Rope& rope, UpAxis up);

using model::kMinRopePiece;
/// Minimum horizontal distance between the ends of a rope that hangs slack (hangs_slack()) [diameters].
inline constexpr double kMinRopeSpan = 4;
/// Whether the scene gives only the ends of a rope, and a rest length at the start that exceeds their distance.
bool hangs_slack(const Rope& rope);

/// The one-dimensional cloth that is simulated for a rope.
Cloth as_cloth(const Rope& rope);
/// Appends as_cloth() of each rope to the cloths of the scene.
void add_rope_cloths(Scene& scene);
/// Removes the cloths that add_rope_cloths() has appended.
void remove_rope_cloths(Scene& scene);

}  // namespace weft::scene
