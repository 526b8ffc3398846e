#include "physics/untangle/ways_out.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace weft::untangle {
namespace {

// Cost of a thread that still goes through the body after the moves; the cost of other threads is
// their squared strain (stretch_cost()).
constexpr double kBlockedCost = 25;
// Depth of a thread's midpoint in the body, relative to the length of the thread. Above kBlockedDepth, the thread goes
// through the body; below kFreeDepth, it does not; in between, this is uncertain.
constexpr double kBlockedDepth = 0.25, kFreeDepth = 0.1;
// Cost of a displacement by the size of the region, so that, of two ways out with equal stretch, the shorter one is
// chosen.
constexpr double kDisplacementCost = 0.05;
// Cost of moving a whole mesh, high enough that the region moves alone if it can; and the longest move of a whole mesh,
// relative to the size of the region.
constexpr double kWholeMeshCost = 0.3, kMaxWholeMeshRatio = 1.1;
// Maximum number of particles outside of the region that pass through the body's surface when the whole mesh moves,
// relative to all particles of the mesh. If more pass, the move probably takes a garment off its wearer.
constexpr double kMaxThroughFraction = 0.1;

// The 26 directions from a cell of a cubic grid to its neighbours, nearest first.
std::vector<Vec3> directions() {
  std::vector<Vec3> all;
  for (const int steps : {1, 2, 3})
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z)
          if (std::abs(x) + std::abs(y) + std::abs(z) == steps) all.push_back(Vec3(x, y, z).normalized());
  return all;
}

/// State of the threads of the moved particles after a move.
struct Threads {
  double blocked = 0;  // fraction deeper than kBlockedDepth
  bool free = true;    // whether all are less deep than kFreeDepth
};
Threads threads_after(const UntangleInput& input, const ForbiddenRegion& solid, std::span<const Move> moves,
                      const std::vector<Index>& move_of, std::span<const Vec3> x) {
  std::size_t blocked = 0, all = 0;
  Threads threads;
  for (const Move& move : moves) {
    for (const Index j : input.neighbours[move.particle]) {
      if (move_of[j] >= 0 && j < move.particle) continue;
      const double depth = solid.midpoint_depth(move.target, move_of[j] >= 0 ? moves[move_of[j]].target : x[j]);
      ++all;
      blocked += depth > kBlockedDepth;
      threads.free = threads.free && depth < kFreeDepth;
    }
  }
  if (all > 0) threads.blocked = static_cast<double>(blocked) / static_cast<double>(all);
  return threads;
}

// Mean normal of the triangles around the moved particles.
Vec3 mean_normal(const collision::Surface& cloth, const std::vector<Index>& move_of, std::span<const Vec3> x) {
  Vec3 sum = Vec3::Zero();
  for (const collision::Triangle& t : cloth.triangles)
    if (move_of[t[0]] >= 0 || move_of[t[1]] >= 0 || move_of[t[2]] >= 0)
      sum += (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
  return sum.stableNormalized();
}

// Whether a region reaches into the bounding box of the solid, or one of its threads crosses the surface. The space
// behind a layer has no end. Cloth that is far behind and apart from the layer, such as the back of a coat that is worn
// over an apron, may stay there.
bool reaches(const UntangleInput& input, const ForbiddenRegion& solid, std::span<const Index> members,
             std::span<const Vec3> x) {
  return std::ranges::any_of(members, [&](Index i) {
    return solid.is_near(x[i], 0) ||
           std::ranges::any_of(input.neighbours[i], [&](Index j) { return solid.crosses_surface(x[i], x[j]); });
  });
}

// The particle `first` and all that are connected to it by particles with a flag. Clears the flags of the result.
std::vector<Index> take_connected(const UntangleInput& input, Index first, std::vector<std::uint8_t>& flags) {
  std::vector<Index> members{first};
  flags[first] = 0;
  for (std::size_t m = 0; m < members.size(); ++m)
    for (const Index j : input.neighbours[members[m]])
      if (flags[j] != 0) {
        flags[j] = 0;
        members.push_back(j);
      }
  return members;
}

}  // namespace

std::vector<InsideRegion> find_inside(const UntangleInput& input, const ForbiddenRegion& solid,
                                      std::span<const Vec3> x) {
  const Index particles = input.particles();
  std::vector<std::uint8_t> inside(particles, 0);
  for (Index i = 0; i < particles; ++i)
    inside[i] = input.can_move[input.bodies.body_of(i)] != 0 && solid.contains(x[i]);
  std::vector<Index> move_of(x.size(), -1);  // per vertex: index among the moves of the present region
  std::vector<InsideRegion> regions;
  for (Index first = 0; first < particles; ++first) {
    if (!inside[first]) continue;
    const std::vector<Index> members = take_connected(input, first, inside);
    if (!reaches(input, solid, members, x)) continue;
    InsideRegion region;
    region.cloth = input.bodies.body_of(first);
    region.body = solid.number();
    for (std::size_t m = 0; m < members.size(); ++m) move_of[members[m]] = static_cast<Index>(m);
    // Extend the box half-way to neighbours, so that a region of one particle has the size of a cell of the mesh.
    Box3 box;
    for (const Index i : members) {
      box.extend(x[i]);
      for (const Index j : input.neighbours[i]) box.extend(0.5 * (x[i] + x[j]));
    }
    region.centre = box.center();
    region.size = box.sizes().maxCoeff();

    const double height = input.min_height[region.cloth];
    double best = std::numeric_limits<double>::infinity();
    const auto try_moves = [&](const std::function<Vec3(const Vec3&)>& out_of) {
      std::vector<Move> moves;
      double farthest = 0;
      for (const Index i : members) {
        moves.push_back({i, out_of(x[i])});
        if (!moves.back().target.allFinite()) return;
        farthest = std::max(farthest, (moves.back().target - x[i]).norm());
      }
      const Threads threads = threads_after(input, solid, moves, move_of, x);
      const double whole = stretch_cost(input, moves, x) + kBlockedCost * threads.blocked +
                           kDisplacementCost * farthest / std::max(region.size, height);
      if (threads.free) region.shortest = std::min(region.shortest, farthest);
      if (whole >= best) return;
      best = whole;
      region.blocked = threads.blocked;
      region.farthest = farthest;
      region.moves = std::move(moves);
    };
    try_moves([&](const Vec3& p) -> Vec3 {
      const ForbiddenRegion::Exit exit = solid.find_exit(p);
      return exit.place + height * exit.normal;
    });
    // Tries a move of the region's whole mesh along d. All its particles must be movable. The move must take the
    // region out of the body, take no particle into it, and leave no thread blocked.
    const auto try_whole_mesh = [&](const Vec3& d) {
      double way = 0;
      for (const Index i : members) way = std::max(way, solid.distance_out(x[i], d) + height);
      const double whole = kWholeMeshCost + kDisplacementCost * way / std::max(region.size, height);
      if (!(way <= kMaxWholeMeshRatio * region.size) || whole >= best) return;
      std::vector<Move> moves;
      std::size_t through = 0;
      std::vector<std::uint8_t> all(static_cast<std::size_t>(particles), 1);
      for (const Index i : take_connected(input, first, all)) {
        const Vec3 target = x[i] + way * d;
        if (!input.movable[i] || solid.contains(target)) return;
        through += move_of[i] < 0 && solid.crosses_surface(x[i], target);
        moves.push_back({i, target});
      }
      if (static_cast<double>(through) > kMaxThroughFraction * static_cast<double>(moves.size())) return;
      for (const Move& move : moves)
        for (const Index j : input.neighbours[move.particle])
          if (solid.midpoint_depth(move.target, x[j] + way * d) > kBlockedDepth) return;
      best = whole;
      region.blocked = 0;
      region.farthest = way;
      region.shortest = std::min(region.shortest, way);
      region.moves = std::move(moves);
    };
    std::vector<Vec3> ways = directions();
    const Vec3 normal = mean_normal(input.bodies.surfaces()[region.cloth], move_of, x);
    if (!normal.isZero()) ways.insert(ways.begin(), {normal, -normal});
    for (const Vec3& d : ways)
      try_moves([&](const Vec3& p) -> Vec3 { return p + (solid.distance_out(p, d) + height) * d; });
    if (best > kWholeMeshCost) {
      for (const Vec3& d : ways) try_whole_mesh(d);
    }
    for (const Index i : members) move_of[i] = -1;
    regions.push_back(std::move(region));
  }
  return regions;
}

}  // namespace weft::untangle
