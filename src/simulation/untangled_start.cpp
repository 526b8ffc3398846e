// What CollisionStage does before the first step for cloth that may be taken apart.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/error.hpp"
#include "core/log.hpp"
#include "simulation/collision_stage.hpp"
#include "untangle/untangle.hpp"

namespace weft::simulation {
namespace {

// Edges of one triangle only, as a share of all, up to which a body counts as closed: eyes and soles of characters.
constexpr double kClosedBorder = 0.02;

untangle::Kind kind_of(const environment::BodyObject& body) {
  if (body.infinite_floor) return untangle::Kind::floor;
  const mesh::EdgeSet edges = mesh::collect_edges(body.colliding_triangles());
  const auto border = std::ranges::count_if(edges.edges, [](const mesh::Edge& e) { return e.triangles[1] < 0; });
  const bool closed = static_cast<double>(border) <= kClosedBorder * static_cast<double>(edges.edges.size());
  return closed && !edges.edges.empty() ? untangle::Kind::solid : untangle::Kind::open;
}

}  // namespace

bool untangles(const scene::Scene& scene) {
  return std::ranges::any_of(scene.cloths,
                             [](const scene::Cloth& c) { return c.start == scene::ClothStart::untangle; });
}

void CollisionStage::untangle(const scene::Scene& scene, std::span<const integrator::HeldParticle> held,
                              Moment& start) {
  const collision::Bodies& bodies = engine_.bodies();
  std::vector<untangle::Kind> kinds(environment_.cloths.size(), untangle::Kind::cloth);
  for (const std::size_t b : bodies_) kinds.push_back(kind_of(environment_.bodies[b]));
  std::vector<std::uint8_t> movable(start.x.size(), 0);
  std::vector<Vec3> rest;
  for (std::size_t c = 0; c < environment_.cloths.size(); ++c) {
    const std::vector<Vec3>& x = environment_.cloths[c].mesh.positions;
    if (scene.cloths[c].start == scene::ClothStart::untangle)
      std::fill_n(movable.begin() + static_cast<std::ptrdiff_t>(rest.size()), x.size(), std::uint8_t{1});
    rest.insert(rest.end(), x.begin(), x.end());
  }
  for (const integrator::HeldParticle& particle : held) movable[particle.constraint.particle] = 0;

  const untangle::Fabric fabric(bodies, std::move(kinds), start.x, rest, movable);
  const untangle::Report report = untangle::untangle(fabric, {scene.contact.self, !bodies_.empty()}, start.x);
  if (!report.locked.empty()) {
    std::string regions;
    for (const untangle::InsideRegion& region : report.locked) {
      regions += fmt::format("{}'{}' in '{}' around ({:.3g}, {:.3g}, {:.3g}) m, {:.3g} m across, ",
                             regions.empty() ? "" : "; ", names_[region.cloth], names_[region.body], region.centre.x(),
                             region.centre.y(), region.centre.z(), region.size);
      regions +=
          std::isfinite(region.shortest) ? fmt::format("by {:.2f} m", region.shortest) : "no straight way is free";
    }
    throw Error(ExitCode::scene_invalid,
                "{}: expected a start that can be untangled, got {} pairs of triangles that cross, and cloth that an "
                "obstacle goes through; it would have to move: {}; 'weft thumbnail --start' draws it; move it",
                scene.file.string(), report.pairs_before, regions);
  }
  if (report.pairs_before > 0 || report.farthest > 0)
    log::info(
        fmt::format("untangled the start: {} pairs of triangles crossed, {} do after {} rounds; particles moved by "
                    "up to {:.3g} m, threads are up to {:.3g} % longer",
                    report.pairs_before, report.pairs_after, report.rounds, report.farthest, 100 * report.stretch));
}

}  // namespace weft::simulation
