// Turns near pairs into contacts: sets stiffness, activation distance and friction.
#pragma once

#include <array>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "physics/collision/bodies.hpp"
#include "physics/collision/proximity/proximities.hpp"
#include "physics/collision/response/certificate.hpp"
#include "physics/collision/response/contact_response.hpp"
#include "physics/collision/response/pinch.hpp"

namespace weft::collision {

/// Coulomb coefficients of a pair of bodies: while it slides, and before it slides.
struct Friction {
  double sliding = 0, static_friction = 0;
};
struct PairFriction {
  std::size_t a = 0, b = 0;  ///< bodies, in any order
  Friction friction;
};

struct ContactParameters {
  double stiffness = 100;                   ///< minimum of the full stiffness, see stiffness_fraction() [N/m]
  double step = 0.01;                       ///< h in Numerics::Contact::inertial_stiffness [s]
  std::vector<PairFriction> friction = {};  ///< pairs with coefficients of their own
};

/// Motion of all vertices over a step. `x_from` is x_t0, or where Engine::continue_from continued the step.
struct StepMotion {
  std::span<const Vec3> x_t0, x_from, x_t1;  ///< [m]
  double h = 0;                              ///< [s]
  bool is_straight() const { return x_t0.data() == x_from.data(); }
};

/// Fraction of the full stiffness that a near pair gets: 1 for vertex-face pairs. For edge pairs it fades from 1 to 0
///   - as both surfaces become flat at the edges: vertices and faces then keep the layers apart (one sharp edge
///     suffices for 1, such as a box edge on smooth cloth);
///   - as the contact direction leaves a wedge (see Proximity): a neighbouring face is then closer;
///   - as a closest point approaches the end of an edge. With these ramps, no contact switches on or off while cloth
/// rests. Without cloth (a rigid body against another one or an obstacle) only the second condition counts, because the
/// rims of stacked boxes may cross where no vertex is near.
double stiffness_fraction(const Proximity& proximity, bool with_cloth = true);

class ContactBuilder {
 public:
  /// `bodies` and `masses` (of the particles [kg]) must outlive it.
  ContactBuilder(const Bodies& bodies, const ContactParameters& parameters, std::span<const double> masses);

  /// Clears the record of features in contact.
  void begin_step() { in_contact_.clear(); }

  /// Adds a contact for each near pair whose stiffness fraction is not 0. Skips pairs of pinched cloth and its
  /// obstacle, because their normal does not show on which side the cloth belongs.
  void add(std::span<const Proximity> proximities, const PinchedPairs& pinched, const StepMotion& motion,
           ContactResponse& response);

  /// Adds the contact that pushes pinched cloth back to its own side of the obstacle, without friction. Its activation
  /// distance grows as in new contacts (Numerics::Contact::range_growth_time). If the exit is blocked, the stiffness is
  /// reduced, so that two obstacles do not clamp the cloth.
  void add_pinched(const PinchedPairs::Push& push, const StepMotion& motion, ContactResponse& response) const;

  /// Adds contacts for a failing pair: two triangles without a separating plane. `features`: their closest features at
  /// x_from. Adds a contact of these features, unless one of full stiffness exists; then returns false. If
  /// motion.is_straight(), the contact only prevents the features from coming closer. In a continued step, it restores
  /// the activation distance, and further contacts keep each particle on its side of the plane between the triangles,
  /// because other features could slide past the closest ones. With velocity constraints, a pair with an obstacle gets
  /// walls (see VelocityConstraints) for the corners of the other triangle instead.
  bool add_failing(const CornerPair& pair, const ClosestFeatures& features, const StepMotion& motion,
                   ContactResponse& response);

  /// Friction coefficients of two contact materials, by number.
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
  std::set<FeatureKey> in_contact_;  // features that have full stiffness already
};

}  // namespace weft::collision
