// CollisionStage::lift_bodies() and untangle(): move bodies and cloth off the surfaces that they touch or cross, before
// the first step.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "core/error.hpp"
#include "core/log.hpp"
#include "core/numerics.hpp"
#include "physics/simulation/collision_stage.hpp"
#include "physics/untangle/untangle.hpp"

namespace weft::simulation {
namespace {

// Maximum ratio of border edges to all edges at which a body counts as closed. Characters are open at eyes and soles.
constexpr double kClosedBorder = 0.02;

untangle::SurfaceKind kind_of(const model::Body& body) {
  if (body.infinite_floor) return untangle::SurfaceKind::floor;
  const mesh::EdgeSet edges = mesh::collect_edges(body.colliding_triangles());
  const auto border = std::ranges::count_if(edges.edges, [](const mesh::Edge& e) { return e.triangles[1] < 0; });
  const bool closed = static_cast<double>(border) <= kClosedBorder * static_cast<double>(edges.edges.size());
  return closed && !edges.edges.empty() ? untangle::SurfaceKind::solid : untangle::SurfaceKind::open;
}

// Whether a cloth that is not yet put on will be worn over this one.
bool is_layer(const model::Model& model, std::size_t cloth, std::span<const std::size_t> put_on) {
  for (std::size_t c = 0; c < model.cloths.size(); ++c)
    if (std::ranges::find(put_on, c) == put_on.end() &&
        std::ranges::find(model.cloths[c].over, model.cloths[cloth].name) != model.cloths[c].over.end())
      return true;
  return false;
}

}  // namespace

double CollisionStage::lift_bodies(const Vec3& up, double t, SystemState& start) {
  constexpr int kMaxStackHeight = 32;  // maximum number of bodies in a stack; each round frees one more from that below
  const std::size_t cloths = model_.cloths.size();
  const collision::Bodies& bodies = engine_.bodies();
  const auto is_free = [&](std::size_t body) {
    return bodies[body].frame >= 0 && t >= model_.bodies[bodies_[body - cloths]].dynamics->release;
  };
  const auto height = [&](std::size_t body) {  // of the body's centre, along `up` [m]
    double sum = 0;
    for (std::size_t k = 0; bodies[body].frame >= 0 && k < mesh::RigidFrame::kParticles; ++k)
      sum += up.dot(start.x[static_cast<std::size_t>(bodies[body].frame) + k]);
    return sum / mesh::RigidFrame::kParticles;
  };
  const auto may_be_untangled = [&](std::size_t body) {
    return body < cloths && model_.cloths[body].may_be_untangled();
  };
  const std::vector<Vec3> given = start.x;
  // First considers all surfaces. If some still touch at the end, starts again without cloth that untangle() may move.
  for (const bool with_all : {true, false}) {
    const auto find_pairs = [&] {
      std::vector<std::array<std::size_t, 2>> pairs;
      for (const collision::CornerPair& pair : engine_.find_intersections(start.x)) {
        const std::size_t a = bodies.body_of(pair.a[0]), b = bodies.body_of(pair.b[0]);
        if (with_all || (!may_be_untangled(a) && !may_be_untangled(b))) pairs.push_back({a, b});
      }
      return pairs;
    };
    std::map<std::size_t, int> lifts;
    for (int round = 0; round <= kMaxStackHeight; ++round) {
      std::set<std::size_t> touching;
      for (const auto& [a, b] : find_pairs()) {
        if (is_free(a) && (!is_free(b) || height(a) > height(b)))
          touching.insert(a);
        else if (is_free(b))
          touching.insert(b);
      }
      if (touching.empty()) break;
      for (const std::size_t body : touching) {
        ++lifts[body];
        for (std::size_t k = 0; k < mesh::RigidFrame::kParticles; ++k)
          start.x[static_cast<std::size_t>(bodies[body].frame) + k] += numerics.separation.restored_gap * up;
      }
      rigid_.place(start.x);
    }
    int max_lift = 0;
    for (const auto& [body, count] : lifts) max_lift = std::max(max_lift, count);
    if (lifts.empty() || find_pairs().empty()) return max_lift * numerics.separation.restored_gap;
    start.x = given;
  }
  return 0;
}

void CollisionStage::untangle(std::span<const integrator::HeldParticle> held, std::span<const std::size_t> put_on,
                              SystemState& start) {
  // Cloths that are already put on (`put_on`) do not move, like obstacles. They come last, so that new cloth is moved
  // out of bodies first, then out of the put-on cloths.
  std::vector<std::size_t> order;  // numbers of the engine's bodies
  const std::size_t cloths = model_.cloths.size();
  for (std::size_t c = 0; c < cloths; ++c)
    if (std::ranges::find(put_on, c) == put_on.end()) order.push_back(c);
  for (std::size_t b = 0; b < bodies_.size(); ++b) order.push_back(cloths + b);
  if (model_.contact.self) order.insert(order.end(), put_on.begin(), put_on.end());

  collision::Bodies bodies;
  std::vector<untangle::SurfaceKind> kinds;
  std::vector<Vec3> x, rest;
  std::vector<std::uint8_t> movable, is_held(start.v.size(), 0);
  for (const integrator::HeldParticle& particle : held) is_held[particle.constraint.particle] = 1;
  for (const std::size_t b : order) {
    const collision::Surface& surface = engine_.bodies().surfaces()[b];
    const auto first = static_cast<std::size_t>(surface.first_vertex);
    std::vector<collision::Triangle> triangles(surface.triangles.begin(), surface.triangles.end());
    for (collision::Triangle& t : triangles)
      for (Index& v : t) v -= surface.first_vertex;
    const bool is_new = b < cloths && std::ranges::find(put_on, b) == put_on.end();
    bodies.add(triangles, surface.vertex_count, {.deformable = is_new, .thickness = engine_.bodies()[b].thickness});
    if (is_new)
      kinds.push_back(untangle::SurfaceKind::cloth);
    else if (b >= cloths)
      kinds.push_back(kind_of(model_.bodies[bodies_[b - cloths]]));
    else
      kinds.push_back(is_layer(model_, b, put_on) ? untangle::SurfaceKind::layer : untangle::SurfaceKind::open);
    for (std::size_t v = first; v < first + static_cast<std::size_t>(surface.vertex_count); ++v) {
      x.push_back(start.x[v]);
      movable.push_back(is_new && model_.cloths[b].may_be_untangled() && is_held[v] == 0);
    }
    const std::vector<Vec3>& given = b < cloths ? model_.cloths[b].mesh.positions : rest;
    if (is_new) rest.insert(rest.end(), given.begin(), given.end());
  }

  const untangle::UntangleInput input(bodies, std::move(kinds), x, rest, movable);
  const untangle::Report report = untangle::untangle(input, model_.contact.self, x);
  if (!report.locked_regions.empty()) {
    std::string regions;
    for (const untangle::InsideRegion& region : report.locked_regions) {
      regions += fmt::format("{}'{}' in '{}' around ({:.3g}, {:.3g}, {:.3g}) m, {:.3g} m across, ",
                             regions.empty() ? "" : "; ", names_[order[region.cloth]], names_[order[region.body]],
                             region.centre.x(), region.centre.y(), region.centre.z(), region.size);
      regions +=
          std::isfinite(region.shortest) ? fmt::format("by {:.2f} m", region.shortest) : "no straight way is free";
    }
    throw Error(ExitCode::scene_invalid,
                "{}: expected a start that can be untangled, got {} pairs of triangles that cross, and cloth that an "
                "obstacle goes through; it would have to move: {}; 'weft thumbnail --start' draws it; move it, or have "
                "the body raise its arms as sleeves do (stance_arms) or grow into it (grow)",
                model_.source, report.pairs_before, regions);
  }
  if (report.pairs_before > 0 || report.farthest > 0)
    log::note(
        fmt::format("untangled the start: {} pairs of triangles crossed, {} do after {} rounds; particles moved by "
                    "up to {:.3g} m, threads are up to {:.3g} % longer",
                    report.pairs_before, report.pairs_after, report.rounds, report.farthest, 100 * report.stretch));
  std::size_t next = 0;
  for (const std::size_t b : order) {
    if (b >= cloths) break;
    for (Vec3& moved : engine_.bodies().part(b, std::span(start.x))) moved = x[next++];
  }
}

}  // namespace weft::simulation
