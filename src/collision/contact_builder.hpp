// From features that are near each other to contacts: how stiff they are, from which distance on, and how rough.
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

/// Coulomb coefficients of two bodies while they slide and before.
struct Friction {
  double sliding = 0, static_friction = 0;
};
struct PairFriction {
  std::size_t a = 0, b = 0;  ///< bodies, in any order
  Friction friction;
};

struct ContactParameters {
  double stiffness = 100;                   ///< least stiffness of a contact [N/m]
  double step = 0.01;                       ///< step that contacts are stiff enough for [s]
  std::vector<PairFriction> friction = {};  ///< of pairs with coefficients of their own
};

/// The motion of all vertices over a step: in one straight piece, or with the last one beginning at x_from.
struct StepMotion {
  std::span<const Vec3> x_t0, x_from, x_t1;  ///< [m]
  double h = 0;                              ///< [s]
  std::span<const std::uint8_t> failures{};  ///< how often each particle was pushed away in it before; empty: never
  bool is_straight() const { return x_t0.data() == x_from.data(); }
};

/// Share of its stiffness that a proximity pushes with: all of a vertex and a face. An edge pair pushes with all of it
/// where its direction lies well inside of the wedges of both edges: an edge of a box against smooth cloth, a crease
/// across a crease. It fades out towards the flat, where vertices and faces keep the layers apart, towards directions
/// outside of a wedge, where a face at the edge is closer, and towards the ends of either edge: nothing is switched on
/// or off while cloth rests. Between two smooth layers that leaves a fifth of the contacts. Between blocks, without
/// cloth, only what is outside of a wedge fades: faces that lie on each other touch where their rims cross, and no
/// vertex needs to be there.
double stiffness_share(const Proximity& proximity, bool with_cloth = true);

class ContactBuilder {
 public:
  /// `bodies` and `masses`, those of the particles [kg], must outlive it.
  ContactBuilder(const Bodies& bodies, const ContactParameters& parameters, std::span<const double> masses);

  /// Contacts of a step from here on.
  void begin_step() { in_contact_.clear(); }

  /// Adds the contacts of proximities, as far as they have a share. Those of pinched cloth and its obstacle are left
  /// out: their direction does not tell the side.
  void add(std::span<const Proximity> proximities, const PinchedPairs& pinched, const StepMotion& motion,
           ContactResponse& response);

  /// Adds the contact of pinched cloth and its obstacle, which pushes to the side that the cloth belongs to, at no more
  /// than the speed of healing and without friction: softly while there is no room, which is nothing to clamp cloth
  /// for, else as others do.
  void add_pinched(const PinchedPairs::Push& push, const StepMotion& motion, ContactResponse& response) const;

  /// Adds contacts of the closest features of two triangles that would meet; false if these push with all their
  /// stiffness already. On the first piece of a way what is closer than the range without being pushed is only kept
  /// from coming closer. On those that follow it is pushed away, and every corner is kept on its own side of the plane
  /// between the triangles: what slides past the features that were closest meets there. `features`: the closest ones
  /// at x_from.
  bool add_failing(const CornerPair& pair, const ClosestFeatures& features, const StepMotion& motion,
                   ContactResponse& response);

  /// Of two skins.
  const Friction& friction_of(std::size_t a, std::size_t b) const { return friction_[a * bodies_.skins().size() + b]; }

 private:
  void add_walls(const CornerPair& pair, const FeaturePair& closest, const StepMotion& motion,
                 ContactResponse& response) const;
  void add_corners(const CornerPair& pair, const FeaturePair& closest, const StepMotion& motion,
                   ContactResponse& response) const;
  bool is_particle(Index vertex) const { return static_cast<std::size_t>(vertex) < masses_.size(); }
  bool is_cloth(Index vertex) const { return is_particle(vertex) && !bodies_[bodies_.body_of(vertex)].rigid; }
  std::optional<Contact> build(const FeaturePair& pair, double share, double range_limit,
                               const StepMotion& motion) const;

  const Bodies& bodies_;
  double stiffness_, step_;
  std::vector<Friction> friction_;  // of each pair of bodies
  std::span<const double> masses_;
  std::set<FeatureKey> in_contact_;  // features that push with all their stiffness
};

}  // namespace weft::collision
