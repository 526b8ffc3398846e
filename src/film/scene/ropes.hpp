// Material constants and start shapes of ropes, and the one-dimensional cloth that is simulated for a rope.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "film/scene/scene.hpp"

namespace weft::scene {

/// Constants of a kind of rope. `mass` and `stretch` are those of a rope divided by the square of its diameter [m²].
struct RopeMaterial {
  std::string name;
  double mass;            ///< [kg/m per m²]
  double stretch;         ///< stiffness: force per strain [N per m²]
  double bending_length;  ///< cube root of (bending stiffness / weight per length) [diameters]
};
const std::vector<RopeMaterial>& rope_materials();

/// Mass and stiffness of one rope. Values that the scene omits follow from the material.
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
/// The start shape of a rope. If hangs_slack(), the rope hangs as a catenary. `up`: up axis of the scene.
RopeShape start_shape(const Rope& rope, UpAxis up);

/// Default length of a piece [diameters].
inline constexpr double kRopePiece = 3;
using model::kMinRopePiece;
/// Minimum horizontal distance between the ends of a rope [diameters], if hangs_slack().
inline constexpr double kMinRopeSpan = 4;
/// Whether the scene gives only the ends of a rope, and start_length() exceeds their distance.
bool hangs_slack(const Rope& rope);

/// Rest length at the start [m]. If the scene gives none, returns nullopt: the length of the path through the points or
/// between the ends applies.
std::optional<double> start_length(const Rope& rope);

/// The one-dimensional cloth that is simulated for a rope.
Cloth as_cloth(const Rope& rope);
/// Appends the cloths of all ropes to those of the scene.
void add_rope_cloths(Scene& scene);
void remove_rope_cloths(Scene& scene);

}  // namespace weft::scene
