#include "collision/engine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace weft::collision {
namespace {

// Contacts are prepared up to this multiple of the range: those that come into range during the step are then in its
// solve. Beyond, whatever would meet is found by the failing certificates.
constexpr double kReachOfRange = 1.5;
// Stiffness of a contact against m/h² of its particles: a particle that arrives with speed v then comes to rest within
// v h / 100, so even a heavy cloth stops well inside the range.
constexpr double kInertialStiffness = 100;

// Edge pairs whose closest direction leaves the wedge of either edge by more than this (sine) are no contacts: a face
// at the edge is closer and is one. Between two layers that leaves a quarter of the contacts.
constexpr double kOutsideWedge = 0.1;

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
  margin_ = 0.5 * reach_;

  Index first = 0;
  for (const Body& body : bodies_) {
    const auto count = static_cast<Index>(body.triangles.size());
    const Surface surface{std::span(triangles_).subspan(static_cast<std::size_t>(first), body.triangles.size()), first,
                          body.first_vertex, body.vertex_count};
    trees_.emplace_back(surface, x);
    trees_.back().refit(x, x, margin_);
    if (body.deformable) deformable_.push_back(surface);
    first += count;
  }
  finder_ = ProximityFinder(triangles_, static_cast<Index>(body_of_.size()));
  separation_ = Separation(triangles_);
}

std::array<std::size_t, 2> Engine::bodies_of(const TrianglePair& pair) const {
  return {body_of_[static_cast<std::size_t>(triangle(pair.a)[0])],
          body_of_[static_cast<std::size_t>(triangle(pair.b)[0])]};
}

// All pairs of triangles that could come within the reach on the way from x_t0 to x_t1.
void Engine::collect(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const auto first = static_cast<std::size_t>(bodies_[b].first_vertex);
    const auto count = static_cast<std::size_t>(bodies_[b].vertex_count);
    const auto start = x_t0.subspan(first, count), end = x_t1.subspan(first, count);
    // A still obstacle keeps the bounds it has.
    const bool still = !bodies_[b].deformable && std::equal(start.begin(), start.end(), end.begin()) &&
                       collected_for_.size() == x_t1.size() &&
                       std::equal(end.begin(), end.end(), collected_for_.begin() + static_cast<std::ptrdiff_t>(first));
    if (!still) trees_[b].refit(x_t0, x_t1, margin_);
  }
  candidates_.clear();
  for (std::size_t a = 0; a < bodies_.size(); ++a) {
    if (!bodies_[a].deformable) continue;
    if (parameters_.self) self_pairs(trees_[a], candidates_);
    for (std::size_t b = a + 1; b < bodies_.size(); ++b)
      if (bodies_[b].deformable ? parameters_.self : parameters_.obstacles) pairs(trees_[a], trees_[b], candidates_);
  }
  collected_for_.assign(x_t1.begin(), x_t1.end());
}

void Engine::add_contact(const std::array<Index, 4>& vertices, const std::array<double, 4>& weights, const Vec3& normal,
                         std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) {
  Contact contact;
  contact.normal = normal;
  double mass = 0, mass_weight = 0;
  std::array<const Body*, 2> sides{};
  for (int k = 0; k < 4; ++k) {
    const auto v = static_cast<std::size_t>(vertices[k]);
    if (weights[k] == 0) continue;
    sides[weights[k] > 0 ? 0 : 1] = &bodies_[body_of_[v]];
    contact.relative_start += weights[k] * x_t0[v];
    if (v < masses_.size()) {
      contact.particles[k] = vertices[k];
      contact.weights[k] = weights[k];
      mass += std::abs(weights[k]) * masses_[v];
      mass_weight += std::abs(weights[k]);
    } else {
      contact.obstacle_end += weights[k] * x_t1[v];
    }
  }
  if (mass_weight == 0) return;
  contact.range = contact_range(*sides[0], *sides[1]);
  contact.stiffness = std::max(parameters_.stiffness, kInertialStiffness * mass / mass_weight / (step_ * step_));
  contact.friction = std::sqrt(sides[0]->friction * sides[1]->friction);
  contacts_.add(contact);
}

void Engine::begin_step(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, double h) {
  step_ = h;
  collect(x_t0, x_t1);
  finder_.find(candidates_, deformable_, x_t0, reach_, proximities_);
  contacts_.clear();
  contacts_.set_step(h);
  adopted_.clear();
  for (const Proximity& proximity : proximities_)
    if (std::max(proximity.outside_wedge[0], proximity.outside_wedge[1]) < kOutsideWedge)
      add_contact(proximity.vertices, proximity.weights, proximity.normal, x_t0, x_t1);
  adopt_failing(x_t0, x_t1);
}

int Engine::adopt_failing(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) {
  if (strayed(x_t1)) collect(x_t0, x_t1);
  int fresh = 0;
  for (const TrianglePair& pair : separation_.find_failing(candidates_.apart.view(), x_t0, x_t1)) {
    const ClosestFeatures features = closest_features(triangle(pair.a), triangle(pair.b), x_t0);
    const double distance = std::sqrt(features.points.distance_sq);
    // Within the reach it is among the proximities already.
    if (distance < reach_ || !adopted_.insert(features.vertices).second) continue;
    add_contact(features.vertices, features.points.weights, features.points.difference / distance, x_t0, x_t1);
    ++fresh;
  }
  return fresh;
}

std::optional<TrianglePair> Engine::find_meeting(std::span<const Vec3> x) {
  collect(x, x);
  const auto failing = separation_.find_failing(candidates_.apart.view(), x, x);
  if (failing.empty()) return std::nullopt;
  return failing.front();
}

// Whether a vertex leaves the bounds of the candidates: further than their margin from where it was expected.
bool Engine::strayed(std::span<const Vec3> x_t1) const {
  for (std::size_t i = 0; i < masses_.size(); ++i)
    if (!((x_t1[i] - collected_for_[i]).cwiseAbs().maxCoeff() <= margin_)) return true;
  return false;
}

SeparationReport Engine::finish_step(std::span<const Vec3> x_t0, std::span<Vec3> x_t1,
                                     std::span<const std::uint8_t> movable) {
  // Corrections can carry vertices out of the bounds that the candidates stand for; then these are collected anew.
  constexpr int kCollections = 8;
  SeparationReport report;
  for (int c = 0; c < kCollections; ++c) {
    if (strayed(x_t1)) collect(x_t0, x_t1);
    const SeparationReport pass = separation_.enforce(candidates_.apart.view(), x_t0, x_t1, movable);
    report.corrected_pairs += pass.corrected_pairs;
    report.largest_push = std::max(report.largest_push, pass.largest_push);
    report.separated = pass.separated;
    report.stuck = pass.stuck;
    if (!pass.separated || !strayed(x_t1)) return report;
  }
  report.separated = false;
  return report;
}

double Engine::min_distance() const {
  double least = std::numeric_limits<double>::infinity();
  for (const Proximity& proximity : proximities_) least = std::min(least, proximity.distance);
  return least;
}

}  // namespace weft::collision
