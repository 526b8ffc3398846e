// Parameters of contact detection and contact response.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace weft::model {

/// What keeps cloth off obstacles. All other contacts are springs.
enum class Response { springs, velocity_constraints };
enum class Bounds { box, dop18, dop26 };
enum class TreeKind { binary, quad, oct };

/// Methods of the broad and narrow phase (Etzmuß et al. 2001, "Collision Detection"). They change the speed, not the
/// result; exceptions: `coherence` and, in rare cases, `bounds`.
struct Search {
  Bounds bounds = Bounds::box;    ///< k-DOPs with k = 6, 18, 26
  TreeKind tree = TreeKind::oct;  ///< two, four or eight children per node
  int leaf = 8;                   ///< maximum number of triangles per leaf
  bool open_longer_side = false;  ///< of two overlapping nodes, replace only the longer one by its children, not both
  bool separation_lists = false;  ///< start each traversal at the pairs of nodes where the previous one stopped
  bool velocity_cones = false;    ///< keep the bounds of slow nodes while their vertices stay inside
  bool normal_cones = false;      ///< skip regions that cannot touch themselves, because all their normals are similar
  bool coherence = false;         ///< keep closest points of surfaces with little relative motion
  bool reuse = true;              ///< keep candidate pairs for several steps, until a vertex has
                                  ///< moved too far (Numerics::Contact::verlet_margin)
};

/// Coulomb friction between two objects, at least one of them a cloth. It replaces the geometric
/// mean of their own coefficients.
struct FrictionPair {
  std::string first, second;              ///< names of cloths or bodies; equal names: a cloth with itself
  double friction = 0.3;                  ///< coefficient of kinetic friction
  std::optional<double> static_friction;  ///< coefficient of static friction, at least `friction`; absent: `friction`
};

/// Parameters of all contacts.
struct Contact {
  bool self = true;                 ///< whether cloths collide with themselves and with other cloths
  bool obstacles = true;            ///< whether cloths and bodies collide with bodies
  double stiffness = 0;             ///< [N/m]; a contact has this stiffness, or that of
                                    ///< Numerics::Contact::inertial_stiffness if it is larger
  std::vector<FrictionPair> pairs;  ///< pairs of objects with friction of their own
  Search search;
  Response response = Response::springs;
};

}  // namespace weft::model
