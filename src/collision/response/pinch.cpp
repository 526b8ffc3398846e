#include "collision/response/pinch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "collision/proximity/closest_points.hpp"
#include "core/archive.hpp"

namespace weft::collision {
namespace {

// Faces whose distances differ by less than this part meet in the nearest point: far above the rounding of the squared
// distance, far below what tells two features apart.
constexpr double kTie = 1e-9;
// Closer than this the line to the nearest point has no direction [m].
constexpr double kNoDirection = 1e-10;
// Cosine of the angle up to which a face looks the same way as another.
constexpr double kSameWay = 0.5;

const Vec3& at(std::span<const Vec3> x, Index vertex) {
  return x[static_cast<std::size_t>(vertex)];
}

Vec3 face_normal(const Triangle& t, std::span<const Vec3> x) {
  return (at(x, t[1]) - at(x, t[0])).cross(at(x, t[2]) - at(x, t[0])).stableNormalized();
}

double distance_to_box_sq(const Vec3& p, const Triangle& t, std::span<const Vec3> x) {
  const Vec3 low = at(x, t[0]).cwiseMin(at(x, t[1])).cwiseMin(at(x, t[2]));
  const Vec3 high = at(x, t[0]).cwiseMax(at(x, t[1])).cwiseMax(at(x, t[2]));
  return (p - p.cwiseMax(low).cwiseMin(high)).squaredNorm();
}

// Angle of a face at the feature of its own that the weights are on: of a corner, half a turn of an edge, a whole one
// inside.
double angle_at(const Triangle& t, const std::array<double, 3>& weights, std::span<const Vec3> x) {
  const auto on = [&](std::size_t c) { return weights[c] > kTie; };
  const int support = on(0) + on(1) + on(2);
  if (support != 1) return support == 2 ? std::numbers::pi : 2 * std::numbers::pi;
  const std::size_t c = on(0) ? 0 : on(1) ? 1 : 2;
  const Vec3 e = at(x, t[(c + 1) % 3]) - at(x, t[c]), f = at(x, t[(c + 2) % 3]) - at(x, t[c]);
  return std::atan2(e.cross(f).norm(), e.dot(f));
}

// Weights on the corners of `face` of the point where the segment from p to q goes through it.
std::optional<std::array<double, 3>> pierce(const Vec3& p, const Vec3& q, const Triangle& face,
                                            std::span<const Vec3> x) {
  const Vec3 &t0 = at(x, face[0]), &t1 = at(x, face[1]), &t2 = at(x, face[2]);
  const Vec3 way = q - p;
  // Volumes of the segment with each edge of the face: all of one sign if the line goes through.
  const double v0 = way.dot((t1 - p).cross(t2 - p)), v1 = way.dot((t2 - p).cross(t0 - p)),
               v2 = way.dot((t0 - p).cross(t1 - p));
  const double sum = v0 + v1 + v2;
  if (sum == 0 || std::min({v0 / sum, v1 / sum, v2 / sum}) < 0) return std::nullopt;
  const Vec3 n = (t1 - t0).cross(t2 - t0);
  if (n.dot(p - t0) * n.dot(q - t0) > 0) return std::nullopt;
  return std::array<double, 3>{v0 / sum, v1 / sum, v2 / sum};
}

// Whether the boxes of two triangles are closer than a certificate's gap.
bool boxes_meet(const Triangle& a, const Triangle& b, std::span<const Vec3> x) {
  const auto low = [&](const Triangle& t) { return at(x, t[0]).cwiseMin(at(x, t[1])).cwiseMin(at(x, t[2])); };
  const auto high = [&](const Triangle& t) { return at(x, t[0]).cwiseMax(at(x, t[1])).cwiseMax(at(x, t[2])); };
  const Vec3 low_a = low(a), high_a = high(a), low_b = low(b), high_b = high(b);
  return (low_a - high_b).maxCoeff() < kFloor && (low_b - high_a).maxCoeff() < kFloor;
}

bool is_apart(const Triangle& cloth, std::span<const Triangle> obstacle, std::span<const Vec3> x) {
  return std::none_of(obstacle.begin(), obstacle.end(), [&](const Triangle& face) {
    return boxes_meet(cloth, face, x) && !find_certificate({cloth, face}, x, x);
  });
}

// Where triangle and obstacle cross: pushed along the normals of the faces crossed.
void append_crossings(const Triangle& cloth, int side, std::span<const Triangle> obstacle, std::span<const Vec3> x,
                      std::vector<PinchTouch>& touches) {
  for (const Triangle& face : obstacle) {
    if (!boxes_meet(cloth, face, x)) continue;
    const auto weights = find_crossing(cloth, face, x);
    if (!weights) continue;
    touches.push_back({{cloth[0], cloth[1], cloth[2], face[0]},
                       {(*weights)[0], (*weights)[1], (*weights)[2], -1},
                       side * face_normal(face, x),
                       0});
  }
}

}  // namespace

SurfacePoint nearest_point(const Vec3& p, std::span<const Triangle> triangles, std::span<const Vec3> x,
                           const Vec3& towards) {
  const auto looks_there = [&](const Triangle& t) { return face_normal(t, x).dot(towards) > kSameWay; };
  const bool some = !towards.isZero() && std::any_of(triangles.begin(), triangles.end(), looks_there);
  SurfacePoint best;
  double best_sq = std::numeric_limits<double>::infinity();
  Vec3 difference = Vec3::Zero(), outward = Vec3::Zero();
  for (const Triangle& t : triangles) {
    if (distance_to_box_sq(p, t, x) > (1 + kTie) * best_sq || (some && !looks_there(t))) continue;
    const ClosestPoints points = closest_vertex_face(p, at(x, t[0]), at(x, t[1]), at(x, t[2]));
    if (points.distance_sq > (1 + kTie) * best_sq) continue;
    const std::array<double, 3> weights{-points.weights[1], -points.weights[2], -points.weights[3]};
    if (points.distance_sq < (1 - kTie) * best_sq) {
      best.face = t;
      best.weights = weights;
      best_sq = points.distance_sq;
      difference = points.difference;
      outward.setZero();
    }
    // Another point just as near, across a thin body, does not count.
    if ((points.difference - difference).squaredNorm() > kTie * best_sq + kNoDirection * kNoDirection) continue;
    outward += angle_at(t, weights, x) * face_normal(t, x);
  }
  const double distance = std::sqrt(best_sq);
  const double sign = outward.dot(difference) < 0 ? -1 : 1;
  best.height = sign * distance;
  best.normal = distance > kNoDirection ? Vec3(sign * difference / distance) : outward.stableNormalized();
  return best;
}

std::optional<std::array<double, 3>> find_crossing(const Triangle& a, const Triangle& b, std::span<const Vec3> x) {
  std::array<double, 3> sum{0, 0, 0};
  int count = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t next = (c + 1) % 3;
    if (pierce(at(x, a[c]), at(x, a[next]), b, x)) {
      // Where on the edge: by the heights of its ends over the face.
      const Vec3 n = face_normal(b, x);
      const double from = std::abs(n.dot(at(x, a[c]) - at(x, b[0]))),
                   to = std::abs(n.dot(at(x, a[next]) - at(x, b[0])));
      const double share = from + to > 0 ? from / (from + to) : 0.5;
      sum[c] += 1 - share;
      sum[next] += share;
      ++count;
    }
    if (const auto weights = pierce(at(x, b[c]), at(x, b[next]), a, x)) {
      for (std::size_t k = 0; k < 3; ++k) sum[k] += (*weights)[k];
      ++count;
    }
  }
  if (count == 0) return std::nullopt;
  for (double& weight : sum) weight /= count;
  return sum;
}

bool PinchedPairs::concern(const std::array<Index, 4>& vertices) const {
  if (origins_.empty()) return false;
  for (Index particle : vertices)
    for (Index other : vertices)
      if (touches(particle, body_of_[other])) return true;
  return false;
}

void PinchedPairs::list_particles() {
  particles_.clear();
  for (const auto& [key, origin] : origins_) {
    for (Index particle : key.cloth) {
      Origin& of_particle = particles_[{particle, key.body}];
      of_particle.side = origin.side;
      of_particle.outward += origin.outward;
    }
  }
  for (auto& [place, origin] : particles_) origin.outward.normalize();
}

void PinchedPairs::note_origins(std::span<const Surface> surfaces, std::span<const Vec3> x_t0) {
  for (auto& [key, origin] : origins_) {
    if (origin.side != 0) continue;
    for (Index particle : key.cloth) {
      const SurfacePoint near = nearest_point(at(x_t0, particle), surfaces[key.body].triangles, x_t0);
      origin.side = near.height < 0 ? -1 : 1;
      origin.outward += near.normal;
    }
    origin.outward.normalize();
  }
  list_particles();
}

void PinchedPairs::release(std::span<const Surface> surfaces, std::span<const Vec3> x) {
  const std::size_t before = origins_.size();
  std::erase_if(origins_, [&](const auto& pinched) {
    const auto& [key, origin] = pinched;
    const auto& obstacle = surfaces[key.body].triangles;
    return is_apart(key.cloth, obstacle, x) && origin.side * nearest_point(at(x, key.cloth[0]), obstacle, x).height > 0;
  });
  if (origins_.size() != before) list_particles();
}

std::vector<PinchTouch> PinchedPairs::find_touches(std::span<const Surface> surfaces, std::span<const Vec3> x,
                                                   double reach) const {
  std::vector<PinchTouch> touches;
  std::map<std::pair<Index, std::size_t>, bool> is_back;
  for (const auto& [place, origin] : particles_) {
    const Vec3& p = at(x, place.first);
    const std::span<const Triangle> obstacle = surfaces[place.second].triangles;
    SurfacePoint near = nearest_point(p, obstacle, x);
    is_back[place] = origin.side * near.height > 0;
    // The way out through another face may be shorter, and lead to the wrong side of what pinches.
    if (!is_back[place]) near = nearest_point(p, obstacle, x, origin.outward);
    if (origin.side * near.height >= reach) continue;
    touches.push_back({{place.first, near.face[0], near.face[1], near.face[2]},
                       {1, -near.weights[0], -near.weights[1], -near.weights[2]},
                       origin.side * near.normal,
                       origin.side * near.height});
  }
  for (const auto& [key, origin] : origins_) {
    const auto back = [&, body = key.body](Index v) { return is_back.at({v, body}); };
    if (std::all_of(key.cloth.begin(), key.cloth.end(), back))
      append_crossings(key.cloth, origin.side, surfaces[key.body].triangles, x, touches);
  }
  return touches;
}

template <class Archive>
void PinchedPairs::serialize(Archive& archive) {
  std::vector<std::pair<Key, Origin>> pinched(origins_.begin(), origins_.end());
  exchange_each(archive, pinched, [&](auto& pair) {
    auto& [key, origin] = pair;
    exchange_values(archive, key.cloth, key.body, origin.side, origin.outward);
    if constexpr (Archive::kReads) {
      const auto is_particle = [&](Index v) { return v >= 0 && v < first_obstacle_; };
      require(std::ranges::all_of(key.cloth, is_particle) &&
                  key.body > body_of_[static_cast<std::size_t>(first_obstacle_ - 1)] && key.body <= body_of_.back(),
              "pinched triangles of a cloth and an obstacle");
    }
  });
  if constexpr (Archive::kReads) {
    origins_ = {pinched.begin(), pinched.end()};
    list_particles();
  }
}

template void PinchedPairs::serialize(ByteWriter&);
template void PinchedPairs::serialize(ByteReader&);

}  // namespace weft::collision
