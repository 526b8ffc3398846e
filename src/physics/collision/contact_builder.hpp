// Makes contacts from near pairs and failing pairs: sets their stiffness, activation distance and friction.
#pragma once

#include <array>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "physics/collision/bodies.hpp"
#include "physics/collision/proximity/proximities.hpp"
#include "physics/collision/response/contact_response.hpp"
#include "physics/collision/response/pinch.hpp"
#include "physics/collision/response/separating_plane.hpp"

namespace weft::collision {

/// Coulomb coefficients of a pair of bodies: while they slide, and while they stick.
struct Friction {
  double sliding = 0, static_friction = 0;
};
struct PairFriction {
  std::size_t a = 0, b = 0;  ///< bodies, in any order
  Friction friction;
};

struct ContactParameters {
  double stiffness = 0;                     ///< minimum of the full stiffness [N/m]; see stiffness_fraction()
  double step = 0.01;                       ///< h in Numerics::Contact::inertial_stiffness [s]
  std::vector<PairFriction> friction = {};  ///< pairs with coefficients of their own
};

/// Positions of all vertices in a step. `x_from`: where the solve starts, x_t0 or the argument of
/// Engine::continue_from(). `x_t1`: expected end; in a continued step, equal to x_from.
struct StepMotion {
  std::span<const Vec3> x_t0, x_from, x_t1;  ///< [m]
  double h = 0;                              ///< [s]
  /// Whether the step has not been continued, so that particles move straight from x_t0 to x_t1.
  bool is_first_solve() const { return x_t0.data() == x_from.data(); }
};

/// Fraction of the full stiffness that the contact of a near pair gets. (Full stiffness [N/m]: the larger of
/// ContactParameters::stiffness and Numerics::Contact::inertial_stiffness · m / h², with the weighted mean mass m of
/// the particles [kg] and h = ContactParameters::step.) The fraction falls from 1 to 0
///   - as the contact direction leaves the wedge of a vertex or edge (see Proximity), because a
///     neighbouring face is then closer;
///   - for edge pairs, as both surfaces become flat at the edges, because pairs of a vertex and a
///     face then keep the surfaces apart. If one edge is sharp, such as that of a box on smooth
///     cloth, this ramp is 1;
///   - for edge pairs, as a closest point approaches the end of its edge.
///
/// The ramps prevent contacts of resting cloth from switching on and off. If neither side is cloth (`with_cloth` is
/// false), only the first ramp applies: the rims of stacked boxes may cross where no vertex is near, so their edge
/// pairs must keep their stiffness.
double stiffness_fraction(const Proximity& proximity, bool with_cloth = true);

/// Makes contacts and adds them to a ContactResponse.
class ContactBuilder {
 public:
  /// `bodies` and `masses` (of the particles [kg]) must outlive it.
  ContactBuilder(const Bodies& bodies, const ContactParameters& parameters, std::span<const double> masses);

  /// Call before the contacts of a step, or of a continued step, are added.
  void begin_step() { in_contact_.clear(); }

  /// Adds a contact for each near pair whose stiffness fraction is not 0. Skips pairs of pinched cloth and the limb
  /// that pinches it, because their normal may point to the wrong side of the limb.
  void add(std::span<const Proximity> proximities, const PinchedPairs& pinched, const StepMotion& motion,
           ContactResponse& response);

  /// Adds a contact without friction that pushes pinched cloth back to its own side of the obstacle. Its spring is
  /// linear. Its activation distance exceeds the present gap by at most the fraction h /
  /// Numerics::Contact::range_growth_time of the full activation distance. If the exit is blocked (see
  /// PinchedPairs::Push), multiplies the stiffness by Numerics::Contact::blocked_exit_factor, so that two obstacles do
  /// not clamp the cloth.
  void add_pinched(const PinchedPairs::Push& push, const StepMotion& motion, ContactResponse& response) const;

  /// Adds contacts for a failing pair: two triangles without a separating plane. `features`: their
  /// closest features at x_from. Adds a contact of these features, unless they already have one of
  /// full stiffness. In the first solve of a step, the activation distance of this contact is at
  /// most the present distance, so it only prevents the features from coming closer. In a continued
  /// step, it pushes them farther apart. Further contacts then keep each corner on its side of a
  /// plane through the closest point of the other triangle, because other features could slide past
  /// the closest ones. With velocity constraints, a pair with an obstacle gets no such contacts,
  /// but walls (see VelocityConstraints) for the corners of the other triangle. Returns whether the
  /// features had no contact of full stiffness before.
  bool add_failing(const CornerPair& pair, const ClosestFeatures& features, const StepMotion& motion,
                   ContactResponse& response);

  /// Friction coefficients of the contact materials a and b, which are indices into Bodies::materials().
  const Friction& friction_of(std::size_t a, std::size_t b) const {
    return friction_[a * bodies_.materials().size() + b];
  }

 private:
  void add_walls(const CornerPair& pair, const FeaturePair& closest, const StepMotion& motion,
                 ContactResponse& response) const;
  void add_corners(const CornerPair& pair, const FeaturePair& closest, const StepMotion& motion,
                   ContactResponse& response) const;
  bool is_particle(Index vertex) const { return static_cast<std::size_t>(vertex) < masses_.size(); }
  bool is_cloth(Index vertex) const { return is_particle(vertex) && !bodies_[bodies_.body_of(vertex)].rigid; }
  std::optional<Contact> build(const FeaturePair& pair, double fraction, double range_limit,
                               const StepMotion& motion) const;

  const Bodies& bodies_;
  double stiffness_, step_;
  std::vector<Friction> friction_;  // per pair of contact materials
  std::span<const double> masses_;
  std::set<FeatureKey> in_contact_;  // pairs of features with a contact of full stiffness
};

}  // namespace weft::collision
