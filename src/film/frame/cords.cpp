#include "film/frame/cords.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/catmull_rom.hpp"

namespace weft::frame {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr int kStrands = 3;
constexpr double kHalfGrooveDepth = 0.1;  // half the depth of the grooves between strands [radii of the rope]
// Number of sides of a ring, the polygonal cross-section of a tube, for ropes with and without strands.
constexpr int kSidesOfStrands = 15, kSidesOfCord = 10;
constexpr int kRingsPerStrandTurn = 8;  // minimum, unless kMaxRingsPerPiece allows fewer
constexpr int kMaxRingsPerPiece = 12;
// Maximum number of rings of a rope with strands. If the strands need more rings, they are too fine
// to be visible, and the rope is drawn without strands.
constexpr std::size_t kMaxRings = 8000;

bool is_closed(const Surface& chain) {
  return chain.triangles.back()[1] == chain.triangles.front()[0];
}

// Normal of the first ring. It changes continuously with the tangent, except where the tangent is opposite to
// `reference`: there, the strands would turn by twice the azimuth of the smallest swing. Ropes that hang or lie along
// an axis are far from this direction.
Vec3 first_normal(const Vec3& tangent) {
  const Vec3 reference = Vec3(2, 3, -1).normalized();
  return Quat::FromTwoVectors(reference, tangent) * reference.unitOrthogonal();
}

// Transports a normal from the ring at `x` to the ring at `next_x` without rotation about the tangent (W. Wang, B.
// Jüttler, D. Zheng & Y. Liu, "Computation of Rotation Minimizing Frames", 2008).
Vec3 transport_normal(const Vec3& normal, const Vec3& x, const Vec3& tangent, const Vec3& next_x,
                      const Vec3& next_tangent) {
  const Vec3 v = next_x - x;
  const double c = v.squaredNorm();
  if (!(c > 0)) return normal;
  const Vec3 n = normal - 2 / c * v.dot(normal) * v, t = tangent - 2 / c * v.dot(tangent) * v;
  const Vec3 w = next_tangent - t;
  const double d = w.squaredNorm();
  return d > 0 ? Vec3(n - 2 / d * w.dot(n) * w) : n;
}

// Triangles between neighbouring rings. Triangles to a vertex in the middle of each end close an
// open tube.
std::vector<std::array<Index, 3>> tube_faces(Index rings, Index sides, bool closed) {
  std::vector<std::array<Index, 3>> faces;
  const auto vertex = [&](Index ring, Index side) { return ring % rings * sides + side % sides; };
  for (Index r = 0; r < (closed ? rings : rings - 1); ++r)
    for (Index k = 0; k < sides; ++k) {
      faces.push_back({vertex(r, k), vertex(r, k + 1), vertex(r + 1, k + 1)});
      faces.push_back({vertex(r, k), vertex(r + 1, k + 1), vertex(r + 1, k)});
    }
  for (Index k = 0; k < sides && !closed; ++k) {
    faces.push_back({rings * sides, vertex(0, k + 1), vertex(0, k)});
    faces.push_back({rings * sides + 1, vertex(rings - 1, k), vertex(rings - 1, k + 1)});
  }
  return faces;
}

}  // namespace

bool Cords::has_chains(const FrameSnapshot& snapshot) {
  return std::ranges::any_of(snapshot.surfaces, [](const auto& surface) { return is_chain(*surface); });
}

SnapshotPtr Cords::sweep(const SnapshotPtr& snapshot) {
  return has_chains(*snapshot) ? std::make_shared<const FrameSnapshot>(sweep(*snapshot)) : snapshot;
}

FrameSnapshot Cords::sweep(const FrameSnapshot& snapshot) {
  FrameSnapshot swept = snapshot;
  for (std::size_t s = 0; s < swept.surfaces.size(); ++s) {
    if (!is_chain(*swept.surfaces[s])) continue;
    const Tube& tube = tube_of(swept.surfaces[s]);
    swept.states[s] = state_of(tube, swept.states[s]);
    swept.surfaces[s] = tube.surface;
  }
  return swept;
}

const Cords::Tube& Cords::tube_of(const std::shared_ptr<const Surface>& chain) {
  const auto known = tubes_.find(chain.get());
  if (known != tubes_.end()) return known->second;
  Tube tube{chain, nullptr, 2, kSidesOfCord, is_closed(*chain)};
  const std::size_t pieces = chain->triangles.size();
  const double lay = chain->appearance.thread_spacing, piece = chain->uv[1].x() - chain->uv[0].x();
  const double rings_for_strands = lay > 0 ? std::ceil(kRingsPerStrandTurn * piece / lay) : 0;
  if (rings_for_strands > 0 && rings_for_strands * static_cast<double>(pieces) <= kMaxRings) {
    tube.rings_per_piece = std::clamp(static_cast<int>(rings_for_strands), 1, kMaxRingsPerPiece);
    tube.sides = kSidesOfStrands;
  }
  auto surface = std::make_shared<Surface>(*chain);
  surface->appearance.thickness = surface->appearance.thread_spacing = 0;
  surface->crease_angle = 180;
  const Index rings = static_cast<Index>(pieces) * tube.rings_per_piece + (tube.closed ? 0 : 1);
  surface->triangles = tube_faces(rings, tube.sides, tube.closed);
  surface->uv.clear();
  for (Index r = 0; r < rings; ++r)
    for (Index k = 0; k < tube.sides; ++k)
      surface->uv.emplace_back(piece * r / tube.rings_per_piece, static_cast<double>(k) / tube.sides);
  if (!tube.closed)
    for (const Index r : {Index{0}, rings - 1}) surface->uv.emplace_back(piece * r / tube.rings_per_piece, 0.5);
  tube.surface = std::move(surface);
  return tubes_.emplace(chain.get(), std::move(tube)).first->second;
}

SurfaceState Cords::state_of(const Tube& tube, const SurfaceState& chain) {
  const Appearance& look = tube.chain->appearance;
  const double radius = 0.5 * look.thickness;
  const auto pieces = static_cast<int>(tube.chain->triangles.size());
  const int rings = pieces * tube.rings_per_piece + (tube.closed ? 0 : 1);
  std::vector<Vec3> middles, tangents;
  for (int r = 0; r < rings; ++r) {
    const int piece = r / tube.rings_per_piece, ring = r % tube.rings_per_piece;
    middles.push_back(ring == 0 ? chain.positions[static_cast<std::size_t>(piece)]
                                : spline_point(chain.positions, tube.closed, piece,
                                               static_cast<double>(ring) / tube.rings_per_piece));
  }
  const auto middle = [&](int r) -> const Vec3& {
    return middles[static_cast<std::size_t>(tube.closed ? (r + rings) % rings : std::clamp(r, 0, rings - 1))];
  };
  for (int r = 0; r < rings; ++r) {
    const Vec3 chord = middle(r + 1) - middle(r - 1);
    tangents.push_back(chord.squaredNorm() > 0 ? Vec3(chord.normalized()) : r > 0 ? tangents.back() : Vec3::UnitZ());
  }
  std::vector<Vec3> normals{first_normal(tangents[0])};
  for (std::size_t r = 1; r < middles.size(); ++r)
    normals.push_back(transport_normal(normals[r - 1], middles[r - 1], tangents[r - 1], middles[r], tangents[r]));

  // `turn`: angle by which the strands wind around the rope from its start to its end [rad]. On a closed rope, the
  // strands must continue from the last ring to the first. `turn` is then a number of whole turns plus `off`, which is
  // the angle at ring 0 from the normal that was transported around the whole rope to normals[0].
  const double lay = look.thread_spacing, length = tube.chain->uv[1].x() * pieces;
  const bool has_strands = tube.sides == kSidesOfStrands && lay > 0;
  double turn = has_strands ? kTurn * length / lay : 0;
  if (tube.closed) {
    const Vec3 back = transport_normal(normals.back(), middles.back(), tangents.back(), middles[0], tangents[0]);
    const double off = std::atan2(tangents[0].dot(back.cross(normals[0])), back.dot(normals[0]));
    turn = std::round(turn / kTurn) * kTurn + off;
  }
  SurfaceState state;
  for (int r = 0; r < rings; ++r) {
    const auto i = static_cast<std::size_t>(r);
    const Vec3& n = normals[i];
    const Vec3 b = tangents[i].cross(n);
    const double twist = turn * r / (pieces * tube.rings_per_piece);
    for (int k = 0; k < tube.sides; ++k) {
      const double own = kTurn * k / tube.sides, angle = own + twist;
      const double size = radius * (has_strands ? 1 - kHalfGrooveDepth * (1 - std::cos(kStrands * own)) : 1);
      state.positions.emplace_back(middles[i] + size * (std::cos(angle) * n + std::sin(angle) * b));
    }
  }
  if (!tube.closed) state.positions.insert(state.positions.end(), {middles.front(), middles.back()});
  if (chain.heat.empty()) return state;
  for (int r = 0; r < rings; ++r) {
    const double s = static_cast<double>(r % tube.rings_per_piece) / tube.rings_per_piece;
    const auto count = chain.heat.size(), p = static_cast<std::size_t>(r / tube.rings_per_piece);
    const auto value = static_cast<float>((1 - s) * chain.heat[p % count] + s * chain.heat[(p + 1) % count]);
    state.heat.insert(state.heat.end(), static_cast<std::size_t>(tube.sides), value);
  }
  if (!tube.closed) state.heat.insert(state.heat.end(), {chain.heat.front(), chain.heat.back()});
  return state;
}

}  // namespace weft::frame
