#include "physics/collision/response/pinch.hpp"

#include <algorithm>
#include <cstdlib>
#include <functional>

#include "core/archive.hpp"
#include "core/numerics.hpp"

namespace weft::collision {
namespace {

// Normal, at positions x, of the face nearest to p. `faces`: those in an Origin.
Vec3 outward(const Vec3& p, std::span<const Triangle> faces, std::span<const Vec3> x) {
  return face_normal(nearest_point(p, faces, x).face, x);
}

}  // namespace

// Faces of the limb whose bounding boxes are closer than Numerics::Separation::least_gap to that of
// the cloth triangle, along every axis.
std::vector<Triangle> PinchedPairs::faces_near(const Key& key, const BroadPhase& surfaces,
                                               std::span<const Vec3> x) const {
  std::vector<Triangle> faces = triangles_near(key.cloth, surfaces, key.body, x, numerics.separation.least_gap);
  std::erase_if(faces, std::not_fn(belongs_to_limb(key.limb)));
  return faces;
}

// Point of the limb of a corner that is nearest to its particle. `towards`: as in nearest_point().
SurfacePoint PinchedPairs::nearest_on_limb(const Corner& corner, const BroadPhase& surfaces, std::span<const Vec3> x,
                                           const Vec3& towards) const {
  return nearest_point(x[corner.particle], surfaces, corner.body, x, towards, belongs_to_limb(corner.limb));
}

// Whether the particle of a corner is on this side of the limb (see Origin). `nearest`: from nearest_on_limb(). A limb
// may be an open surface, such as a forearm that ends at the elbow. Beyond its border, `nearest` may have a negative
// height although the particle is in front of the body, so the whole body decides there.
bool PinchedPairs::is_on_side(int side, const Corner& corner, const SurfacePoint& nearest, const BroadPhase& surfaces,
                              std::span<const Vec3> x) const {
  if (side * nearest.height > 0) return true;
  return side > 0 && nearest.height < 0 && !is_inside(x[corner.particle], nearest.normal, surfaces, corner.body, x);
}

// Whether the particle of a corner is on the side of the limb on which the limb reached the cloth.
bool PinchedPairs::is_on_its_side(const Corner& corner, const Origin& origin, const BroadPhase& surfaces,
                                  std::span<const Vec3> x) const {
  return is_on_side(origin.side, corner, nearest_on_limb(corner, surfaces, x), surfaces, x);
}

bool PinchedPairs::is_apart(const Key& key, const BroadPhase& surfaces, std::span<const Vec3> x) const {
  return std::ranges::all_of(faces_near(key, surfaces, x), [&](const Triangle& face) {
    return find_separating_plane({key.cloth, face}, x, x).has_value();
  });
}

// Whether no obstacle contains `place`, to which a push leads. Example: if a hand is inside the
// hip, the hip blocks the exit from the hand. The body that the cloth is exempt from does not count
// if it is one limb, in which the cloth was: cloth of a closed container returns into it.
bool PinchedPairs::is_exit_clear(const Vec3& place, const Vec3& outward, const Corner& corner, int side,
                                 const BroadPhase& surfaces, std::span<const Vec3> x) const {
  const auto returns_into = [&](std::size_t body) {
    return side < 0 && body == corner.body &&
           std::ranges::all_of(surfaces.surface(body).triangles, belongs_to_limb(corner.limb));
  };
  for (std::size_t body = 0; body < surfaces.size(); ++body)
    if (is_obstacle(surfaces.surface(body)) && is_inside(place, outward, surfaces, body, x) && !returns_into(body))
      return false;
  return true;
}

bool PinchedPairs::are_pinched(const std::array<Index, 4>& vertices) const {
  if (origins_.empty()) return false;
  for (Index particle : vertices)
    for (Index other : vertices)
      if (particles_.contains({particle, body_of_[other], limb_of_[other]})) return true;
  return false;
}

void PinchedPairs::add(const CornerPair& pair) {
  const Key of_pair = key(pair);
  origins_[of_pair].faces.push_back(pair.b);
  for (Index particle : pair.a) {
    const Corner corner{particle, of_pair.body, of_pair.limb};
    particles_.try_emplace(corner);
    returned_.erase(corner);
  }
}

void PinchedPairs::list_particles() {
  particles_.clear();
  for (const auto& [key, origin] : origins_) {
    for (Index particle : key.cloth) {
      Origin& of_particle = particles_[{particle, key.body, key.limb}];
      of_particle.side = origin.side;
      for (const Triangle& face : origin.faces)
        if (std::ranges::find(of_particle.faces, face) == of_particle.faces.end()) of_particle.faces.push_back(face);
    }
  }
}

void PinchedPairs::note_origins(const BroadPhase& surfaces, std::span<const Vec3> x_t0) {
  for (auto& [key, origin] : origins_) {
    if (origin.side != 0) continue;
    const Corner corner{key.cloth[0], key.body, key.limb};
    origin.side = is_on_side(1, corner, nearest_on_limb(corner, surfaces, x_t0), surfaces, x_t0) ? 1 : -1;
  }
  list_particles();
}

void PinchedPairs::update_exempted(std::span<const Triangle> triangles, const BroadPhase& surfaces,
                                   std::span<const Vec3> x, bool is_repeated) {
  std::map<Key, Origin> around = origins_;
  for (const Triangle& cloth : triangles) {
    if (cloth[0] >= first_obstacle_) break;
    for (Index particle : cloth)
      for (auto it = particles_.lower_bound({particle, 0, 0}); it != particles_.end(); ++it) {
        if (it->first.particle != particle) break;
        around.try_emplace({cloth, it->first.body, it->first.limb}, it->second);
      }
  }
  std::erase_if(around, [&](const auto& pinched) {
    const auto& [key, origin] = pinched;
    return is_apart(key, surfaces, x) && is_on_its_side({key.cloth[0], key.body, key.limb}, origin, surfaces, x);
  });
  for (auto& [key, origin] : around)
    if (!origins_.contains(key)) origin.faces = find_origin_faces(key, origin, surfaces, x);
  origins_ = std::move(around);
  list_particles();
  returned_.clear();
  if (is_repeated) return;
  for (const auto& [corner, origin] : particles_)
    if (is_on_its_side(corner, origin, surfaces, x)) returned_.insert(corner);
}

// Finds the faces for the Origin of a neighbour that is added to the set: those that the neighbour crosses and whose
// normals are within 60° of the exit direction of `beside`, the Origin of the exempted triangle beside it. Without such
// faces, returns those of `beside`. Thus each neighbour on a round limb has its own exit direction. Example: faces in
// an armpit, which met the first triangle, are far from the chest and point in another direction.
std::vector<Triangle> PinchedPairs::find_origin_faces(const Key& key, const Origin& beside, const BroadPhase& surfaces,
                                                      std::span<const Vec3> x) const {
  const auto& [a, b, c] = key.cloth;
  const Vec3 out = outward((x[a] + x[b] + x[c]) / 3, beside.faces, x);
  std::vector<Triangle> faces = faces_near(key, surfaces, x);
  std::erase_if(faces, [&](const Triangle& face) {
    return face_normal(face, x).dot(out) <= kMinFacingCosine || find_separating_plane({key.cloth, face}, x, x);
  });
  return faces.empty() ? beside.faces : faces;
}

std::vector<PinchedPairs::Push> PinchedPairs::find_pushes(const BroadPhase& surfaces, std::span<const Vec3> x,
                                                          double max_height) const {
  std::vector<Push> pushes;
  std::map<Corner, bool> is_back;
  for (const auto& [corner, origin] : particles_) {
    const Vec3& p = x[corner.particle];
    SurfacePoint nearest = nearest_on_limb(corner, surfaces, x);
    const bool back = is_back[corner] = is_on_side(origin.side, corner, nearest, surfaces, x);
    // The nearest point may be on a side of the limb from which the cloth did not come.
    if (!back) nearest = nearest_on_limb(corner, surfaces, x, outward(p, origin.faces, x));
    const int side = !back ? origin.side : nearest.height < 0 ? -1 : 1;  // differs from origin.side beyond a border
    const double height = side * nearest.height;
    if (height >= max_height) continue;
    const Vec3 exit_direction = side * nearest.normal;
    pushes.push_back(
        {{{corner.particle, nearest.face[0], nearest.face[1], nearest.face[2]},
          {1, -nearest.weights[0], -nearest.weights[1], -nearest.weights[2]},
          exit_direction,
          height},
         is_exit_clear(p + (max_height - height) * exit_direction, exit_direction, corner, origin.side, surfaces, x)});
  }
  for (const auto& [key, origin] : origins_) {
    const auto back = [&, &key = key](Index v) { return is_back.at({v, key.body, key.limb}); };
    if (!std::all_of(key.cloth.begin(), key.cloth.end(), back)) continue;
    for (const Triangle& face : faces_near(key, surfaces, x)) {
      const auto weights = find_crossing(key.cloth, face, x);
      if (!weights) continue;
      Vec3 place = Vec3::Zero();
      for (std::size_t k = 0; k < 3; ++k) place += (*weights)[k] * x[key.cloth[k]];
      const Vec3 exit_direction = origin.side * face_normal(face, x);
      pushes.push_back({{{key.cloth[0], key.cloth[1], key.cloth[2], face[0]},
                         {(*weights)[0], (*weights)[1], (*weights)[2], -1},
                         exit_direction,
                         0},
                        is_exit_clear(place + max_height * exit_direction, exit_direction,
                                      {key.cloth[0], key.body, key.limb}, origin.side, surfaces, x)});
    }
  }
  return pushes;
}

template <class Archive>
void PinchedPairs::serialize(Archive& archive) {
  std::vector<std::pair<Key, Origin>> pinched(origins_.begin(), origins_.end());
  serialize_each(archive, pinched, [&](auto& pair) {
    auto& [key, origin] = pair;
    serialize_values(archive, key.cloth, key.body, key.limb, origin.side);
    serialize_plain(archive, origin.faces);
    if constexpr (Archive::kReads) {
      const auto is_of_limb = [&, body = key.body, limb = key.limb](const Triangle& face) {
        const auto is_of_body = [&](Index v) {
          return v >= first_obstacle_ && v < static_cast<Index>(body_of_.size()) && body_of_[v] == body;
        };
        return std::ranges::all_of(face, is_of_body) && belongs_to_limb(limb)(face);
      };
      const auto is_particle = [&](Index v) { return v >= 0 && v < first_obstacle_; };
      require(std::ranges::all_of(key.cloth, is_particle) && key.body > body_of_[first_obstacle_ - 1] &&
                  key.body <= body_of_.back() && std::abs(origin.side) == 1 && !origin.faces.empty() &&
                  std::ranges::all_of(origin.faces, is_of_limb),
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
