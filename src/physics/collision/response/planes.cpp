#include "physics/collision/response/planes.hpp"

#include <algorithm>
#include <cmath>

#include "core/archive.hpp"
#include "core/numerics.hpp"
#include "core/parallel_append.hpp"

namespace weft::collision {
namespace {

Lanes8 dot(const Points8& a, const Points8& b) {
  return a.axis[0] * b.axis[0] + a.axis[1] * b.axis[1] + a.axis[2] * b.axis[2];
}

Points8 minus(const Points8& a, const Points8& b) {
  return {{a.axis[0] - b.axis[0], a.axis[1] - b.axis[1], a.axis[2] - b.axis[2]}};
}

Points8 cross(const Points8& a, const Points8& b) {
  return {{a.axis[1] * b.axis[2] - a.axis[2] * b.axis[1], a.axis[2] * b.axis[0] - a.axis[0] * b.axis[2],
           a.axis[0] * b.axis[1] - a.axis[1] * b.axis[0]}};
}

/// One triangle in each lane.
struct Triangles8 {
  Points8 corner[3];
};

}  // namespace

// Tests face normals and the direction between the centres for eight pairs at once, in float. This takes a twelfth of
// the time of a search in double with branches. If none of these directions separates a pair, find_failing() searches
// further.
void Planes::find_planes_for_eight(std::size_t first, std::size_t count) {
  const auto gather = [&](bool side_b) {
    Triangles8 result;
    for (int c = 0; c < 3; ++c) {
      const Lanes4* row[8];
      for (std::size_t l = 0; l < 8; ++l) {
        const TrianglePair& pair = pairs_.view()[first + std::min(l, count - 1)];
        const Triangle& t = triangles_[side_b ? pair.b : pair.a];
        row[l] = &rounded_[t[c]];
      }
      result.corner[c] = transpose(row);
    }
    return result;
  };
  Triangles8 a = gather(false), b = gather(true);
  // `rounding` bounds the rounding errors of the gap. Coordinates are rounded twice, by 2^-24 of their values; dot
  // products, by a few times as much, because relative coordinates are at most twice the largest coordinate. `rounding`
  // also contains the least gap that separates() requires, and half of it again for the error of the length of n. It
  // uses only coordinates of the pair, so other bodies do not affect the result.
  Lanes8 rounding = a.corner[0].axis[0];
  for (const Triangles8* side : {&a, &b})
    for (const Points8& corner : side->corner)
      for (const Lanes8& coordinate : corner.axis) {
        raise_to(rounding, coordinate);
        raise_to(rounding, -coordinate);
      }
  rounding = rounding * 0x1p-19F + static_cast<float>(1.5 * numerics.separation.least_gap);
  // Coordinates relative to a corner, so that the rounding of dot products scales with the size of the triangles.
  const Points8 origin = a.corner[0];
  for (int c = 0; c < 3; ++c) a.corner[c] = minus(a.corner[c], origin), b.corner[c] = minus(b.corner[c], origin);

  Lanes8 best_gap{};
  Points8 best_n{};
  const auto try_direction = [&](const Points8& direction, bool initial) {
    const Lanes8 length_sq = dot(direction, direction);
    Lanes8 length;
    for (int l = 0; l < 8; ++l) length[l] = std::sqrt(length_sq[l]);
    const Lanes8 scale = length_sq > 0 ? 1 / length : Lanes8{};
    const Points8 n{{direction.axis[0] * scale, direction.axis[1] * scale, direction.axis[2] * scale}};
    Lanes8 a_low = dot(n, a.corner[0]), a_high = a_low, b_low = dot(n, b.corner[0]), b_high = b_low;
    for (int c = 1; c < 3; ++c) {
      const Lanes8 along_a = dot(n, a.corner[c]), along_b = dot(n, b.corner[c]);
      lower_to(a_low, along_a), raise_to(a_high, along_a), lower_to(b_low, along_b), raise_to(b_high, along_b);
    }
    const Lanes8 above = a_low - b_high, below = b_low - a_high;
    const Lanes8 gap = above < below ? below : above, sign = above >= below ? Lanes8{} + 1 : Lanes8{} - 1;
    const IntLanes8 is_better = initial ? IntLanes8{} - 1 : gap > best_gap;
    best_gap = is_better ? gap : best_gap;
    for (int axis = 0; axis < 3; ++axis) best_n.axis[axis] = is_better ? sign * n.axis[axis] : best_n.axis[axis];
  };
  Points8 centres = b.corner[0];
  for (int axis = 0; axis < 3; ++axis)
    centres.axis[axis] = a.corner[1].axis[axis] + a.corner[2].axis[axis] - b.corner[0].axis[axis] -
                         b.corner[1].axis[axis] - b.corner[2].axis[axis];
  try_direction(centres, true);
  try_direction(cross(a.corner[1], a.corner[2]), false);
  try_direction(cross(minus(b.corner[1], b.corner[0]), minus(b.corner[2], b.corner[0])), false);
  for (std::size_t l = 0; l < count; ++l)
    planes_[first + l] = {{best_n.axis[0][l], best_n.axis[1][l], best_n.axis[2][l]}, best_gap[l] - rounding[l]};
}

void Planes::watch(std::span<const TrianglePair> pairs, std::span<const Vec3> x) {
  pairs_.clear();
  pairs_.append(pairs);
  watch(x);
}

void Planes::watch(std::span<const Vec3> x) {
  planes_.resize(pairs_.size());
  is_separated_.assign(pairs_.size(), 0);
  rounded_.resize(x.size());
  parallel_for(x.size(), kGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      rounded_[v] = Lanes4{static_cast<float>(x[v][0]), static_cast<float>(x[v][1]), static_cast<float>(x[v][2]), 0.0F};
  });
  parallel_for(pairs_.size(), kGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; p += 8) find_planes_for_eight(p, std::min<std::size_t>(8, end - p));
  });
}

void Planes::set_moved(std::span<const float> moved) {
  moved_.resize(triangles_.size());
  parallel_for(triangles_.size(), kGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      moved_[t] = std::max({moved[triangles_[t][0]], moved[triangles_[t][1]], moved[triangles_[t][2]]});
  });
}

void Planes::append_closer(double radius, std::size_t begin, std::size_t end, PairList& out) const {
  TrianglePair* last = out.reserve_more(end - begin);
  for (std::size_t p = begin; p < end; ++p) {
    const TrianglePair& pair = pairs_.view()[p];
    *last = pair;
    last += planes_[p].gap < static_cast<float>(radius) + moved_[pair.a] + moved_[pair.b] ? 1 : 0;
  }
  out.grow(last);
}

void Planes::find_failing(std::span<const Vec3> reference, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1,
                          std::span<const float> moved, std::span<const std::uint8_t> changed,
                          std::vector<CornerPair>& failing, const CarriedStarts* carried, PlaneKinds which) {
  set_moved(moved);
  changed_.resize(triangles_.size());
  parallel_for(triangles_.size(), kGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const Triangle& corners = triangles_[t];
      changed_[t] = changed[corners[0]] | changed[corners[1]] | changed[corners[2]];
    }
  });
  if (carried != nullptr) carried->compute_all();
  parallel_append(pairs_.size(), kGrainSize, failing, [&](std::size_t begin, std::size_t end, auto& list) {
    find_failing(begin, end, {reference, x_t0, x_t1, carried, which}, list);
  });
}

void Planes::find_failing(std::size_t begin, std::size_t end, const Trajectory& trajectory,
                          std::vector<CornerPair>& failing) {
  const auto& [reference, x_t0, x_t1, carried, which] = trajectory;
  for (std::size_t p = begin; p < end; ++p) {
    const TrianglePair& numbers = pairs_.view()[p];
    const auto a = static_cast<std::size_t>(numbers.a), b = static_cast<std::size_t>(numbers.b);
    Plane& plane = planes_[p];
    const CornerPair pair{triangles_[a], triangles_[b]};
    const std::span<const Vec3> start = carried != nullptr ? carried->of(pair, x_t0) : x_t0;
    const bool starts_at_x_t0 = start.data() == x_t0.data();
    // If the obstacle turns, its vertices move on arcs, so a plane for the straight trajectory
    // between the same ends proves nothing.
    if (starts_at_x_t0 && is_separated_[p] && !changed_[a] && !changed_[b]) continue;
    is_separated_[p] = starts_at_x_t0;
    if (starts_at_x_t0 && plane.gap > moved_[a] + moved_[b]) continue;

    const Vec3 n(plane.n[0], plane.n[1], plane.n[2]);
    if (plane.is_known() && separates(n, pair, start, x_t1)) continue;
    const std::optional<Vec3> found = find_separating_plane(pair, start, x_t1, kinds_of(pair, which));
    if (!found) {
      is_separated_[p] = 0;
      failing.push_back(pair);
      continue;
    }
    const double gap = gap_along(*found, pair, reference) - 1.5 * numerics.separation.least_gap;
    plane = {{static_cast<float>(found->x()), static_cast<float>(found->y()), static_cast<float>(found->z())},
             static_cast<float>(gap > 0 ? (1 - 1e-6) * gap : gap)};
  }
}

template <class Archive>
void Planes::serialize(Archive& archive, std::span<const Vec3> reference) {
  std::vector<std::uint32_t> changed;
  if constexpr (!Archive::kReads) {
    Planes rebuilt(triangles_, obstacles_from_);
    rebuilt.watch(pairs_.view(), reference);
    for (std::size_t p = 0; p < planes_.size(); ++p)
      if (planes_[p] != rebuilt.planes_[p]) changed.push_back(static_cast<std::uint32_t>(p));
  }
  serialize_plain(archive, changed);
  for (std::uint32_t p : changed) {
    if constexpr (Archive::kReads) require(p < planes_.size(), "planes of the pairs near each other");
    serialize_values(archive, planes_[p].n, planes_[p].gap);
  }
}

template void Planes::serialize(ByteWriter&, std::span<const Vec3>);
template void Planes::serialize(ByteReader&, std::span<const Vec3>);

}  // namespace weft::collision
