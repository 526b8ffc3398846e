#include "collision/engine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/archive.hpp"

namespace weft::collision {
namespace {

// Contacts are prepared up to this multiple of the range: those that come into range during the step are then in its
// solve. Beyond, whatever would meet is found by the failing certificates.
constexpr double kReachOfRange = 1.5;
// Bounds of slow steps are enlarged by this much more, in reaches, so that the candidates hold for several steps.
constexpr double kSkin = 0.5;
// Stiffness of a contact against m/h² of its particles: a particle that arrives with speed v then comes to rest within
// v h / 100, so even a heavy cloth stops well inside the range.
constexpr double kInertialStiffness = 100;

// An edge pair pushes with all its stiffness if its direction lies well inside of the wedges of both edges, by this sum
// of sines: an edge of a box against smooth cloth, a crease across a crease. It fades out towards the flat, where
// vertices and faces keep the layers apart, and towards directions outside of a wedge, where a face at the edge is
// closer: nothing is switched on or off while cloth rests. Between two smooth layers that leaves a fifth of the
// contacts.
constexpr double kFlattest = 0.05, kSharp = 0.2;
constexpr double kOutsideWedge = 0.1;
// It fades out too where the closest point comes this near to an end of either edge (in shares of it).
constexpr double kEndOfEdge = 0.1;

// Speed at which cloth is pushed out of an obstacle that it was pinched into [m/s]: out of 5 mm within a frame, and not
// enough to hop over 2 mm.
constexpr double kHealingSpeed = 0.2;
// Share of the stiffness of a contact that does so: it has nothing to stop, and full stiffness between two obstacles
// clamps the cloth and costs twice the Newton iterations.
constexpr double kHealingShare = 0.05;

double ramp(double from, double to, double value) {
  return std::clamp((value - from) / (to - from), 0.0, 1.0);
}

std::array<Index, 4> sorted(std::array<Index, 4> vertices) {
  std::sort(vertices.begin(), vertices.end());
  return vertices;
}

// Share of its stiffness that a proximity pushes with.
double share(const Proximity& proximity) {
  if (proximity.kind == ProximityKind::vertex_face) return 1;
  const auto& outside = proximity.outside_wedge;
  double least = 1;
  for (double weight : proximity.weights) least = std::min(least, std::abs(weight));
  return ramp(kFlattest, kSharp, -outside[0] - outside[1]) *
         ramp(-kOutsideWedge, 0, -std::max(outside[0], outside[1])) * ramp(0, kEndOfEdge, least);
}

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

double contact_range(const Body& a, const Body& b) {
  return 0.5 * (a.thickness + b.thickness);
}

}  // namespace

Engine::Engine(std::vector<Body> bodies, const EngineParameters& parameters, std::span<const Vec3> x,
               std::vector<double> masses)
    : bodies_(std::move(bodies)), parameters_(parameters), masses_(std::move(masses)) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    triangles_.insert(triangles_.end(), bodies_[b].triangles.begin(), bodies_[b].triangles.end());
    body_of_.insert(body_of_.end(), static_cast<std::size_t>(bodies_[b].vertex_count), b);
  }
  double range = 0;
  for (const Body& a : bodies_) range = std::max(range, a.thickness);
  reach_ = kReachOfRange * range;

  Index first = 0;
  for (const Body& body : bodies_) {
    const auto count = static_cast<Index>(body.triangles.size());
    surfaces_.push_back({std::span(triangles_).subspan(static_cast<std::size_t>(first), body.triangles.size()), first,
                         body.first_vertex, body.vertex_count});
    if (body.deformable) deformable_.push_back(surfaces_.back());
    first += count;
  }
  prepare_friction();
  broad_phase_ = BroadPhase(surfaces_, x, parameters_.search);
  finder_ = ProximityFinder(triangles_, static_cast<Index>(body_of_.size()));
  pinched_ = PinchedPairs(static_cast<Index>(masses_.size()), body_of_);
  if (parameters_.velocity_constraints) constraints_ = VelocityConstraints(masses_);
  separation_ =
      Separation(triangles_, parameters_.self ? std::span<const Surface>(deformable_) : std::span<const Surface>());
}

// The geometric mean of both coefficients, or what the pair has of its own.
void Engine::prepare_friction() {
  for (const Body& a : bodies_) {
    for (const Body& b : bodies_) {
      const double mean = std::sqrt(a.friction * b.friction);
      friction_.push_back({mean, mean});
    }
  }
  for (const PairFriction& pair : parameters_.friction)
    friction_[pair.a * bodies_.size() + pair.b] = friction_[pair.b * bodies_.size() + pair.a] = pair.friction;
}

Index Engine::triangle_of(const Triangle& corners) const {
  const Surface& surface = surfaces_[body_of(corners[0])];
  const auto has_all = [&](const Triangle& t) {
    return std::all_of(corners.begin(), corners.end(), [&](Index v) { return has_vertex(t, v); });
  };
  const auto found = std::find_if(surface.triangles.begin(), surface.triangles.end(), has_all);
  return static_cast<Index>(found - surface.triangles.begin());
}

// All pairs of triangles that could come within the reach on the way from x_t0 to x_t1.
void Engine::collect(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) {
  double motion = 0;
  for (std::size_t i = 0; i < x_t0.size(); ++i) motion = std::max(motion, (x_t1[i] - x_t0[i]).cwiseAbs().maxCoeff());
  const double margin = (0.5 + (parameters_.reuse && motion < kSkin * reach_ ? kSkin : 0.0)) * reach_;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const auto first = static_cast<std::size_t>(bodies_[b].first_vertex);
    const auto count = static_cast<std::size_t>(bodies_[b].vertex_count);
    const auto start = x_t0.subspan(first, count), end = x_t1.subspan(first, count);
    // A still obstacle keeps the bounds it has.
    const auto same_as = [&](const std::vector<Vec3>& x) {
      return x.size() == x_t0.size() &&
             std::equal(start.begin(), start.end(), x.begin() + static_cast<std::ptrdiff_t>(first));
    };
    const bool still = !bodies_[b].deformable && margin == margin_ &&
                       std::equal(start.begin(), start.end(), end.begin()) && same_as(from_) && same_as(to_);
    if (!still) broad_phase_.refit(b, x_t0, x_t1, margin);
  }
  candidates_.clear();
  for (std::size_t a = 0; a < bodies_.size(); ++a) {
    if (!bodies_[a].deformable) continue;
    if (parameters_.self) broad_phase_.self_pairs(a, candidates_);
    for (std::size_t b = a + 1; b < bodies_.size(); ++b)
      if (bodies_[b].deformable ? parameters_.self : parameters_.obstacles) broad_phase_.pairs(a, b, candidates_);
  }
  from_.assign(x_t0.begin(), x_t0.end());
  to_.assign(x_t1.begin(), x_t1.end());
  margin_ = margin;
  separation_.watch(candidates_.apart.view(), x_t0);
  near_.clear();
  separation_.append_closer(2 * margin, near_.apart);
  std::swap(near_.one_shared, candidates_.one_shared);
  finder_.gather(near_, deformable_, x_t0, 2 * margin, kFlattest);
}

// Whether the gathered features still hold every pair within the reach at x.
bool Engine::near_start(std::span<const Vec3> x) const {
  if (margin_ < 0) return false;
  const double skin = margin_ - 0.5 * reach_;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!((x[i] - from_[i]).squaredNorm() <= skin * skin)) return false;
  return true;
}

// Whether all vertices are in the bounds that the candidates were collected with.
bool Engine::inside_bounds(std::span<const Vec3> x) const {
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec3 out = (x[i] - from_[i].cwiseMax(to_[i])).cwiseMax(from_[i].cwiseMin(to_[i]) - x[i]);
    if (!(out.maxCoeff() <= margin_)) return false;
  }
  return true;
}

// A contact of one particle with an obstacle constrains its velocity; false for all others.
bool Engine::constrain(const Touch& touch, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) {
  Index particle = -1;
  Vec3 point_t0 = Vec3::Zero(), point_t1 = Vec3::Zero();  // of the obstacle
  double side = 0;
  const Body *cloth = nullptr, *obstacle = nullptr;
  for (int k = 0; k < 4; ++k) {
    const auto v = static_cast<std::size_t>(touch.vertices[k]);
    const double weight = touch.weights[k];
    if (weight == 0) continue;
    if (v >= masses_.size()) {
      obstacle = &bodies_[body_of_[v]];
      point_t0 += std::abs(weight) * x_t0[v];
      point_t1 += std::abs(weight) * x_t1[v];
    } else if (std::abs(weight) >= 1 - 1e-9) {
      particle = touch.vertices[k];
      cloth = &bodies_[body_of_[v]];
      side = weight > 0 ? 1 : -1;
    }
  }
  if (particle < 0 || obstacle == nullptr) return false;
  const Vec3 normal = side * touch.normal;
  const double distance = normal.dot(x_t0[static_cast<std::size_t>(particle)] - point_t0);
  if (distance <= 0) return false;  // pinched
  const Friction& friction = friction_of(static_cast<std::size_t>(cloth - bodies_.data()),
                                         static_cast<std::size_t>(obstacle - bodies_.data()));
  constraints_.add(particle, normal, distance, std::min(touch.range_limit, contact_range(*cloth, *obstacle)),
                   point_t1 - point_t0, friction.sliding, friction.at_rest);
  return true;
}

// All corners of a triangle of cloth that would meet an obstacle are kept beyond the plane through the obstacle's
// closest point; false for other pairs.
bool Engine::constrain_corners(const CornerPair& pair, const Touch& touch, std::span<const Vec3> x_t0,
                               std::span<const Vec3> x_t1) {
  const auto is_cloth = [&](const Triangle& t) { return static_cast<std::size_t>(t[0]) < masses_.size(); };
  if (is_cloth(pair.a) == is_cloth(pair.b)) return false;
  const double side = is_cloth(pair.a) ? 1 : -1;
  for (Index corner : side > 0 ? pair.a : pair.b) {
    Touch of_corner = touch;
    for (int k = 0; k < 4; ++k)
      if (static_cast<std::size_t>(touch.vertices[k]) < masses_.size()) of_corner.weights[k] = 0;
    for (int k = 0; k < 4; ++k)
      if (static_cast<std::size_t>(touch.vertices[k]) < masses_.size()) {
        of_corner.vertices[k] = corner;
        of_corner.weights[k] = side;
        break;
      }
    constrain(of_corner, x_t0, x_t1);
  }
  return true;
}

void Engine::add_contact(const Touch& touch, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) {
  if (parameters_.velocity_constraints && constrain(touch, x_t0, x_t1)) return;
  Contact contact;
  contact.normal = touch.normal;
  double mass = 0, mass_weight = 0;
  std::array<const Body*, 2> sides{};
  for (int k = 0; k < 4; ++k) {
    const auto v = static_cast<std::size_t>(touch.vertices[k]);
    const double weight = touch.weights[k];
    if (weight == 0) continue;
    sides[weight > 0 ? 0 : 1] = &bodies_[body_of_[v]];
    contact.relative_start += weight * x_t0[v];
    if (v < masses_.size()) {
      contact.particles[k] = touch.vertices[k];
      contact.weights[k] = weight;
      mass += std::abs(weight) * masses_[v];
      mass_weight += std::abs(weight);
    } else {
      contact.obstacle_end += weight * x_t1[v];
    }
  }
  if (mass_weight == 0) return;
  contact.full_range = contact_range(*sides[0], *sides[1]);
  contact.range = std::min(touch.range_limit, contact.full_range);
  contact.stiffness =
      touch.share * std::max(parameters_.stiffness, kInertialStiffness * mass / mass_weight / (step_ * step_));
  const Friction& friction = friction_of(static_cast<std::size_t>(sides[0] - bodies_.data()),
                                         static_cast<std::size_t>(sides[1] - bodies_.data()));
  contact.friction = friction.sliding;
  contact.static_friction = friction.at_rest;
  contacts_.add(contact);
}

void Engine::begin_step(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, double h) {
  step_ = h;
  if (!near_start(x_t0) || !inside_bounds(x_t1)) collect(x_t0, x_t1);
  finder_.find(x_t0, reach_, proximities_);
  contacts_.clear();
  contacts_.set_step(h);
  if (parameters_.velocity_constraints) constraints_.begin_step(h);
  in_contact_.clear();
  if (!pinched_.empty()) add_pinch_contacts(x_t0, x_t1);
  for (const Proximity& proximity : proximities_)
    if (const double part = share(proximity); part > 0 && !is_pinched(proximity.vertices)) {
      add_contact({proximity.vertices, proximity.weights, proximity.normal, part, kNoLimit}, x_t0, x_t1);
      if (part == 1) in_contact_.push_back(sorted(proximity.vertices));
    }
  std::sort(in_contact_.begin(), in_contact_.end());
  if (!apart(x_t0, x_t1)) adopt_failing(x_t0, x_t1);
  if (parameters_.velocity_constraints) constraints_.prepare(x_t0, x_t1);
}

// Pinched cloth is pushed back to its side, at no more than kHealingSpeed towards the obstacle's surface.
void Engine::add_pinch_contacts(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) {
  pinched_.release(broad_phase_, x_t0);
  for (const FeaturePair& push : pinched_.find_pushes(broad_phase_, x_t0, reach_))
    add_contact({push.vertices, push.weights, push.normal, kHealingShare, push.distance + kHealingSpeed * step_}, x_t0,
                x_t1);
}

// Whether a pair of features is of pinched cloth and its obstacle: their direction does not tell the side.
bool Engine::is_pinched(const std::array<Index, 4>& vertices) const {
  if (pinched_.empty()) return false;
  for (Index particle : vertices)
    for (Index other : vertices)
      if (pinched_.touches(particle, body_of(other))) return true;
  return false;
}

bool Engine::apart(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) {
  if (!inside_bounds(x_t1)) collect(x_t0, x_t1);
  failing_ = separation_.find_failing(x_t0, x_t1, &pinched_);
  return failing_.empty();
}

int Engine::adopt_failing(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) {
  int fresh = 0;
  for (const CornerPair& pair : failing_) {
    const ClosestFeatures features = closest_features(pair, x_t0);
    const double distance = std::sqrt(features.points.distance_sq);
    const std::array<Index, 4> vertices = sorted(features.vertices);
    const auto place = std::lower_bound(in_contact_.begin(), in_contact_.end(), vertices);
    if (place != in_contact_.end() && *place == vertices) continue;
    in_contact_.insert(place, vertices);
    // What is closer than the range already, without being pushed, is only kept from coming closer.
    const Touch touch{features.vertices, features.points.weights, features.points.difference / distance, 1, distance};
    if (!parameters_.velocity_constraints || !constrain_corners(pair, touch, x_t0, x_t1))
      add_contact(touch, x_t0, x_t1);
    ++fresh;
  }
  return fresh;
}

std::optional<CornerPair> Engine::find_meeting(std::span<const Vec3> x) {
  collect(x, x);
  if (apart(x, x)) return std::nullopt;
  return failing_.front();
}

SeparationReport Engine::push_apart(std::span<const Vec3> x_t0, std::span<Vec3> x_t1,
                                    std::span<const std::uint8_t> movable, bool may_pinch) {
  // Corrections can carry vertices out of the bounds that the candidates stand for; then these are collected anew.
  constexpr int kCollections = 8;
  SeparationReport report;
  PinchedPairs pinched = pinched_;
  for (int c = 0; c < kCollections; ++c) {
    const SeparationReport pass = separation_.enforce(x_t0, x_t1, movable, &pinched);
    report.corrected_pairs += pass.corrected_pairs;
    report.largest_push = std::max(report.largest_push, pass.largest_push);
    report.separated = pass.separated;
    report.stuck = pass.stuck;
    if (!pass.separated) return report;
    if (!inside_bounds(x_t1)) {
      collect(x_t0, x_t1);
      continue;
    }
    if (const auto fresh = first_fresh(pinched, pinched_, broad_phase_); fresh && !may_pinch) {
      report.separated = false;
      report.stuck = *fresh;
      return report;
    }
    pinched.note_origins(broad_phase_, x_t0);
    pinched_ = std::move(pinched);
    return report;
  }
  report.separated = false;
  return report;
}

double Engine::min_distance() const {
  double least = std::numeric_limits<double>::infinity();
  for (const Proximity& proximity : proximities_) least = std::min(least, proximity.distance);
  return least;
}

void Engine::forget() {
  if (!BroadPhase::remembers(parameters_.search)) return;
  broad_phase_.forget();
  margin_ = -1;
}

template <class Archive>
void Engine::exchange(Archive& archive, std::span<const Vec3> x) {
  pinched_.exchange(archive);
  constraints_.exchange(archive);
  bool kept = near_start(x);
  archive.value(kept);
  if (kept)
    exchange_candidates(archive);
  else if constexpr (Archive::kReads)
    margin_ = -1;
}

// Candidates and features follow from the two positions that they were collected for.
template <class Archive>
void Engine::exchange_candidates(Archive& archive) {
  std::vector<Vec3> from = from_, to = to_;
  for (const Body& body : bodies_) {
    if (!body.moving) continue;
    const auto first = static_cast<std::size_t>(body.first_vertex),
               bytes = static_cast<std::size_t>(body.vertex_count) * sizeof(Vec3);
    for (std::vector<Vec3>* x : {&from, &to}) archive.raw(x->data() + first, bytes);
  }
  if constexpr (Archive::kReads) {
    const auto finite = [](const Vec3& x) { return x.allFinite(); };
    require(std::ranges::all_of(from, finite) && std::ranges::all_of(to, finite), "finite points");
    collect(from, to);
  }
  separation_.exchange(archive);
}

template void Engine::exchange(ByteWriter&, std::span<const Vec3>);
template void Engine::exchange(ByteReader&, std::span<const Vec3>);

}  // namespace weft::collision
