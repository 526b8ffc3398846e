#include "physics/collision/contact_builder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/numerics.hpp"
#include "core/parallel_append.hpp"

namespace weft::collision {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();
// Number of near pairs that become contacts in one batch: enough work for 16 threads, with little memory.
constexpr std::size_t kNearPairsPerBatch = 16 * kFineGrainSize;

double ramp(double from, double to, double value) {
  return std::clamp((value - from) / (to - from), 0.0, 1.0);
}

// Limits the activation distance in a step over h [s] to `gap` [m] plus the fraction h /
// Numerics::Contact::range_growth_time of the full activation distance.
void limit_range_growth(Contact& contact, double gap, double h) {
  const double range = std::min(contact.range, gap + contact.full_range * h / numerics.contact.range_growth_time);
  contact.depth -= contact.range - range;
  contact.range = range;
}

// Distance of the two points of a pair along its normal, at the start of the step [m]; 0 if it is
// negative.
double gap_at_start(const FeaturePair& pair, const StepMotion& motion) {
  double gap = 0;
  for (std::size_t k = 0; k < 4; ++k) gap += pair.weights[k] * pair.normal.dot(motion.x_t0[pair.vertices[k]]);
  return std::max(gap, 0.0);
}

// Pairs a corner of the triangle `corners` with the closest point of the other triangle.
FeaturePair pair_with_corner(Index corner, const Triangle& corners, const FeaturePair& closest) {
  FeaturePair result = closest;
  double side = 0;
  std::size_t place = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    if (std::ranges::find(corners, closest.vertices[k]) == corners.end()) continue;
    side += std::exchange(result.weights[k], 0);
    place = k;
  }
  result.vertices[place] = corner;
  result.weights[place] = side > 0 ? 1 : -1;
  return result;
}

}  // namespace

double stiffness_fraction(const Proximity& proximity, bool with_cloth) {
  const auto& outside = proximity.outside_wedge;
  const double inside_wedges = ramp(-numerics.contact.ramp_width, 0, -std::max(outside[0], outside[1]));
  if (!with_cloth || proximity.kind == ProximityKind::vertex_face) return inside_wedges;
  double smallest_weight = 1;
  for (double weight : proximity.weights) smallest_weight = std::min(smallest_weight, std::abs(weight));
  return ramp(numerics.contact.flat_fold(), 2 * numerics.contact.ramp_width, -outside[0] - outside[1]) * inside_wedges *
         ramp(0, numerics.contact.ramp_width, smallest_weight);
}

// Tabulates friction for all pairs of materials: coefficients given for their bodies, or else the geometric mean.
ContactBuilder::ContactBuilder(const Bodies& bodies, const ContactParameters& parameters,
                               std::span<const double> masses)
    : bodies_(bodies), stiffness_(parameters.stiffness), step_(parameters.step), masses_(masses) {
  for (const ContactMaterial& a : bodies.materials()) {
    for (const ContactMaterial& b : bodies.materials()) {
      const double mean = std::sqrt(a.friction * b.friction);
      friction_.push_back({mean, mean});
      for (const PairFriction& pair : parameters.friction)
        if ((pair.a == a.body && pair.b == b.body) || (pair.a == b.body && pair.b == a.body))
          friction_.back() = pair.friction;
    }
  }
}

void ContactBuilder::add(std::span<const Proximity> proximities, const PinchedPairs& pinched, const StepMotion& motion,
                         ContactResponse& response) {
  struct Built {
    const Proximity* proximity;
    double fraction;
    std::optional<Contact> contact;
  };
  if (proximities.size() > kNearPairsPerBatch) {
    for (; !proximities.empty(); proximities = proximities.subspan(std::min(kNearPairsPerBatch, proximities.size())))
      add(proximities.first(std::min(kNearPairsPerBatch, proximities.size())), pinched, motion, response);
    return;
  }
  std::vector<Built> all;
  parallel_append(proximities.size(), kFineGrainSize, all, [&](std::size_t begin, std::size_t end, auto& list) {
    for (const Proximity& proximity : proximities.subspan(begin, end - begin)) {
      const bool with_cloth = std::ranges::any_of(proximity.vertices, [&](Index v) { return is_cloth(v); });
      const double fraction = stiffness_fraction(proximity, with_cloth);
      if (!(fraction > 0) || pinched.are_pinched(proximity.vertices)) continue;
      auto contact = build(proximity, fraction, kNoLimit, motion);
      if (contact) limit_range_growth(*contact, gap_at_start(proximity, motion), motion.h);
      list.push_back({&proximity, fraction, contact});
    }
  });
  for (const auto& [proximity, fraction, contact] : all) {
    if (contact) response.add(*contact, motion.x_t0);
    if (fraction == 1) in_contact_.insert(feature_key(proximity->kind, proximity->vertices));
  }
}

void ContactBuilder::add_pinched(const PinchedPairs::Push& push, const StepMotion& motion,
                                 ContactResponse& response) const {
  const double fraction = push.is_exit_clear ? 1 : numerics.contact.blocked_exit_factor;
  auto contact = build(push.exit_pair, fraction, kNoLimit, motion);
  if (!contact) return;
  limit_range_growth(*contact, push.exit_pair.distance, motion.h);
  contact->full_range = kNoLimit;  // makes the spring linear
  contact->friction = contact->static_friction = 0;
  response.add(*contact, motion.x_t0);
}

bool ContactBuilder::add_failing(const CornerPair& pair, const ClosestFeatures& features, const StepMotion& motion,
                                 ContactResponse& response) {
  const double distance = std::sqrt(features.points.distance_sq);
  const FeaturePair closest{features.vertices, features.points.weights, features.points.difference / distance, distance,
                            features.kind};
  const bool is_new = in_contact_.insert(feature_key(features.kind, features.vertices)).second;
  if (motion.is_first_solve() && !is_new) return false;
  const bool with_obstacle = is_particle(pair.a[0]) != is_particle(pair.b[0]);
  if (response.form() == ResponseForm::velocity_constraints && with_obstacle) {
    add_walls(pair, closest, motion, response);
    return is_new;
  }
  if (auto contact = is_new ? build(closest, 1, motion.is_first_solve() ? distance : kNoLimit, motion) : std::nullopt) {
    limit_range_growth(*contact, distance, motion.h);
    response.add(*contact, motion.x_t0);
  }
  if (!motion.is_first_solve()) add_corners(pair, closest, motion, response);
  return is_new;
}

// Adds a wall for each corner of the triangle that does not belong to the obstacle. The walls are perpendicular to the
// line between the closest points of the pair.
void ContactBuilder::add_walls(const CornerPair& pair, const FeaturePair& closest, const StepMotion& motion,
                               ContactResponse& response) const {
  const Triangle& cloth = is_particle(pair.a[0]) ? pair.a : pair.b;
  for (Index corner : cloth)
    if (const auto contact = build(pair_with_corner(corner, cloth, closest), 1, closest.distance, motion))
      response.add_wall(*contact, motion.x_t0);
}

// Adds a contact between each corner that is a particle and a plane. The plane goes through the
// closest point of the other triangle and has the normal of `closest`. A corner behind its plane
// gets no contact. The activation distance is at most the gap at x_from, so the contact exerts no
// force there. The contact has no friction, because the contact of the closest features has
// friction.
void ContactBuilder::add_corners(const CornerPair& pair, const FeaturePair& closest, const StepMotion& motion,
                                 ContactResponse& response) const {
  for (const Triangle& corners : {pair.a, pair.b}) {
    for (Index corner : std::span(corners).first(corners[1] == corners[2] ? 2 : 3)) {  // an edge repeats its second end
      if (!is_particle(corner)) continue;
      const FeaturePair corner_pair = pair_with_corner(corner, corners, closest);
      if (corner_pair.vertices == closest.vertices && corner_pair.weights == closest.weights) continue;
      double gap = 0;
      for (std::size_t k = 0; k < 4; ++k)
        gap += corner_pair.weights[k] * corner_pair.normal.dot(motion.x_from[corner_pair.vertices[k]]);
      auto contact = build(corner_pair, 1, gap, motion);
      if (!contact || gap <= 0) continue;
      contact->friction = contact->static_friction = 0;
      response.add(*contact, motion.x_t0);
    }
  }
}

// Builds the contact of a pair of features with this fraction of its full stiffness. `range_limit`: upper bound of the
// activation distance [m]. Returns nullopt if neither side has a particle.
std::optional<Contact> ContactBuilder::build(const FeaturePair& pair, double fraction, double range_limit,
                                             const StepMotion& motion) const {
  Contact contact;
  Vec3 relative = Vec3::Zero();
  contact.normal = pair.normal;
  double mass = 0, mass_weight = 0;
  std::array<double, 2> side_mass{}, side_weight{};
  bool is_rigid = false;
  std::array<std::size_t, 2> sides{};
  for (std::size_t k = 0; k < 4; ++k) {
    const Index v = pair.vertices[k];
    const double weight = pair.weights[k];
    if (weight == 0) continue;
    sides[weight > 0 ? 0 : 1] = bodies_.material_of(v);
    contact.relative_start += weight * motion.x_t0[v];
    relative += weight * motion.x_from[v];
    if (is_particle(v)) {
      contact.particles[k] = v;
      contact.weights[k] = weight;
      mass += std::abs(weight) * masses_[v];
      mass_weight += std::abs(weight);
      side_mass[weight > 0 ? 0 : 1] += std::abs(weight) * masses_[v];
      side_weight[weight > 0 ? 0 : 1] += std::abs(weight);
      is_rigid |= bodies_[bodies_.body_of(v)].rigid;
    } else {
      contact.against_obstacle = true;
      contact.obstacle_start += weight * motion.x_t0[v];
      contact.obstacle_end += weight * motion.x_t1[v];
    }
  }
  if (mass_weight == 0) return std::nullopt;
  // If a rigid body touches cloth or another rigid body, the mass of the lighter side determines the stiffness.
  if (is_rigid && side_weight[0] > 0 && side_weight[1] > 0) {
    const std::size_t lighter = side_mass[0] * side_weight[1] < side_mass[1] * side_weight[0] ? 0 : 1;
    mass = side_mass[lighter], mass_weight = side_weight[lighter];
  }
  contact.full_range = 0.5 * (bodies_.materials()[sides[0]].thickness + bodies_.materials()[sides[1]].thickness);
  contact.range = std::min(range_limit, contact.full_range);
  contact.depth = contact.range - contact.normal.dot(relative);
  contact.stiffness =
      fraction * std::max(stiffness_, numerics.contact.inertial_stiffness * mass / mass_weight / (step_ * step_));
  const Friction& friction = friction_of(sides[0], sides[1]);
  contact.friction = friction.sliding;
  contact.static_friction = friction.static_friction;
  return contact;
}

}  // namespace weft::collision
