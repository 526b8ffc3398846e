// Turns near pairs into contacts: sets stiffness, activation distance and friction.
#pragma once

#include <array>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "collision/bodies.hpp"
#include "collision/proximity/proximities.hpp"
#include "collision/response/certificate.hpp"
#include "collision/response/contact_response.hpp"
#include "collision/response/pinch.hpp"
#include "core/types.hpp"

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
  double stiffness = 100;                   ///< minimum stiffness of a contact, before stiffness_fraction() [N/m]
  double step = 0.01;                       ///< time step for which contacts must be stiff enough [s]
  std::vector<PairFriction> friction = {};  ///< pairs with coefficients of their own
};

/// Motion of all vertices over a step. `x_from` is x_t0, or where Engine::continue_from continued the step.
struct StepMotion {
  std::span<const Vec3> x_t0, x_from, x_t1;  ///< [m]
  double h = 0;                              ///< [s]
  bool is_straight() const { return x_t0.data() == x_from.data(); }
};

/// Fraction of the full stiffness that a near pair gets. Vertex-face pairs get 1. Edge pairs get 1 if the contact
/// direction lies well inside the wedges (see Proximity) of both edges and the closest points lie well inside the
/// edges, as for a box edge on smooth cloth or two crossed creases. The fraction fades to 0 as the surface becomes flat
/// (vertices and faces then keep the layers apart), as the direction leaves a wedge (a neighbouring face is then
/// closer), and towards the ends of an edge. So no contact switches on or off while cloth rests. Between two smooth
/// layers a fifth of the contacts remain. Without cloth (two rigid bodies) the fraction fades only outside a wedge,
/// because the rims of stacked boxes may cross where no vertex is near.
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

  /// Adds the contact that pushes pinched cloth back to its own side of the obstacle, without friction and no faster
  /// than contacts open (`Contact::opening_time`). If the exit is blocked, the stiffness is reduced, so that two
  /// obstacles do not clamp the cloth.
  void add_pinched(const PinchedPairs::Push& push, const StepMotion& motion, ContactResponse& response) const;

  /// Adds contacts between the closest features of two triangles without a separating plane; returns false if these
  /// features have full stiffness already. Before Engine::continue_from the contact only prevents a pair inside the
  /// activation distance from coming closer. After it, the contact restores the activation distance, and further
  /// contacts keep each corner on its side of the plane between the triangles, because other features could slide past
  /// the closest ones and meet there. With velocity constraints, the corners of cloth near an obstacle get walls
  /// instead. `features`: the closest features at x_from.
  bool add_failing(const CornerPair& pair, const ClosestFeatures& features, const StepMotion& motion,
                   ContactResponse& response);

  /// Coefficients for two contact materials, by number.
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
