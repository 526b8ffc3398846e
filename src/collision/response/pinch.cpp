#include "collision/response/pinch.hpp"

#include <algorithm>

#include "collision/proximity/surface_point.hpp"
#include "core/archive.hpp"

namespace weft::collision {
namespace {

// The faces of an obstacle that a certificate has to be looked for against: others are apart by their boxes.
std::vector<Triangle> faces_near(const Triangle& cloth, const BroadPhase& surfaces, std::size_t obstacle,
                                 std::span<const Vec3> x) {
  return triangles_near(cloth, surfaces, obstacle, x, kFloor);
}

bool is_apart(const Triangle& cloth, const BroadPhase& surfaces, std::size_t obstacle, std::span<const Vec3> x) {
  return std::ranges::all_of(faces_near(cloth, surfaces, obstacle, x), [&](const Triangle& face) {
    return find_certificate({cloth, face}, x, x).has_value();
  });
}

// Where triangle and obstacle cross: pushed along the normals of the faces crossed.
void append_crossings(const Triangle& cloth, int side, const BroadPhase& surfaces, std::size_t obstacle,
                      std::span<const Vec3> x, std::vector<FeaturePair>& pushes) {
  for (const Triangle& face : faces_near(cloth, surfaces, obstacle, x)) {
    const auto weights = find_crossing(cloth, face, x);
    if (!weights) continue;
    pushes.push_back({{cloth[0], cloth[1], cloth[2], face[0]},
                      {(*weights)[0], (*weights)[1], (*weights)[2], -1},
                      side * face_normal(face, x),
                      0});
  }
}

}  // namespace

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

void PinchedPairs::note_origins(const BroadPhase& surfaces, std::span<const Vec3> x_t0) {
  for (auto& [key, origin] : origins_) {
    if (origin.side != 0) continue;
    for (Index particle : key.cloth) {
      const SurfacePoint near = nearest_point(x_t0[particle], surfaces, key.body, x_t0);
      origin.side = near.height < 0 ? -1 : 1;
      origin.outward += near.normal;
    }
    origin.outward.normalize();
  }
  list_particles();
}

void PinchedPairs::release(const BroadPhase& surfaces, std::span<const Vec3> x) {
  const std::size_t before = origins_.size();
  std::erase_if(origins_, [&](const auto& pinched) {
    const auto& [key, origin] = pinched;
    return is_apart(key.cloth, surfaces, key.body, x) &&
           origin.side * nearest_point(x[key.cloth[0]], surfaces, key.body, x).height > 0;
  });
  if (origins_.size() != before) list_particles();
}

std::vector<FeaturePair> PinchedPairs::find_pushes(const BroadPhase& surfaces, std::span<const Vec3> x,
                                                   double reach) const {
  std::vector<FeaturePair> pushes;
  std::map<std::pair<Index, std::size_t>, bool> is_back;
  for (const auto& [place, origin] : particles_) {
    const auto& [particle, body] = place;
    SurfacePoint near = nearest_point(x[particle], surfaces, body, x);
    is_back[place] = origin.side * near.height > 0;
    // The way out through another face may be shorter, and lead to the wrong side of what pinches.
    if (!is_back[place]) near = nearest_point(x[particle], surfaces, body, x, origin.outward);
    if (origin.side * near.height >= reach) continue;
    pushes.push_back({{particle, near.face[0], near.face[1], near.face[2]},
                      {1, -near.weights[0], -near.weights[1], -near.weights[2]},
                      origin.side * near.normal,
                      origin.side * near.height});
  }
  for (const auto& [key, origin] : origins_) {
    const auto back = [&, body = key.body](Index v) { return is_back.at({v, body}); };
    if (std::all_of(key.cloth.begin(), key.cloth.end(), back))
      append_crossings(key.cloth, origin.side, surfaces, key.body, x, pushes);
  }
  return pushes;
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
