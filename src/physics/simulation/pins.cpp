#include "physics/simulation/pins.hpp"

#include <algorithm>
#include <limits>

#include "physics/collision/proximity/surface_point.hpp"
#include "physics/simulation/step_end_motion.hpp"

namespace weft::simulation {
namespace {

/// Position and velocity of a point.
struct MovingPoint {
  Vec3 x, v;
};

/// Unit vector along u and its rate of change, if u changes at u_rate. Zero if u is not longer than `negligible`.
MovingPoint unit(const Vec3& u, const Vec3& u_rate, double negligible) {
  const double length = u.norm();
  if (!(length > negligible)) return {Vec3::Zero(), Vec3::Zero()};
  const Vec3 along = u / length;
  return {along, (u_rate - along.dot(u_rate) * along) / length};
}

/// Orthonormal axes of a triangle and their rates of change: its first side, its normal, and their vector product. An
/// axis that a collapsed triangle does not define is zero.
struct TriangleAxes {
  Mat3 axes, rates;

  TriangleAxes(const MovingPoint& a, const MovingPoint& b, const MovingPoint& c) {
    const Vec3 p = b.x - a.x, q = c.x - a.x, p_rate = b.v - a.v, q_rate = c.v - a.v;
    const MovingPoint side = unit(p, p_rate, 0),
                      normal = unit(p.cross(q), p_rate.cross(q) + p.cross(q_rate), kRoundoff * p.norm() * q.norm());
    axes << side.x, normal.x, side.x.cross(normal.x);
    rates << side.v, normal.v, side.v.cross(normal.x) + side.x.cross(normal.v);
  }
  bool has_collapsed() const { return axes.col(1).isZero(0); }
};

}  // namespace

// Takes time linear in the number of particles of all pins. A later pin becomes an owner of a particle only if it is
// released after all earlier owners.
std::vector<std::vector<Pins::Owner>> Pins::list_owners(const model::Model& model,
                                                        const std::vector<Index>& first_particle) {
  std::size_t count = 0;
  for (std::size_t c = 0; c < model.cloths.size(); ++c)
    count = static_cast<std::size_t>(first_particle[c]) + model.cloths[c].start.size();
  std::vector<std::vector<Owner>> owners_of(count);
  for (const bool faded : {false, true}) {
    std::size_t pin = 0;
    for (std::size_t c = 0; c < model.cloths.size(); ++c)
      for (const model::Pin& each : model.cloths[c].pins) {
        const double release = each.release >= 0 ? each.release : std::numeric_limits<double>::infinity();
        for (const model::WeightedParticle& chosen : each.particles) {
          std::vector<Owner>& owners = owners_of[static_cast<std::size_t>(first_particle[c] + chosen.particle)];
          if (chosen.faded == faded && (owners.empty() || owners.back().release < release))
            owners.push_back({pin, chosen.fraction, release});
        }
        ++pin;
      }
  }
  return owners_of;
}

Pins::Owner Pins::owner_at(Index particle, double t) const {
  for (const Owner& owner : owners_of_[static_cast<std::size_t>(particle)])
    if (!model::is_later(t, owner.release)) return owner;
  return {};
}

Pins::Pins(const model::Model& model, const std::vector<Index>& first_particle)
    : owners_of_(list_owners(model, first_particle)) {
  const double start_time = model.start_time();
  for (std::size_t c = 0; c < model.cloths.size(); ++c) {
    const model::Cloth& cloth = model.cloths[c];
    for (std::size_t number = 0; number < cloth.pins.size(); ++number) {
      const model::Pin& pin = cloth.pins[number];
      Group& group = groups_.emplace_back();
      const std::vector<model::WeightedParticle>& all = pin.particles;
      std::vector<std::size_t> places;  // index of each particle of the group in `all`
      for (std::size_t k = 0; k < all.size(); ++k) {
        const Index particle = first_particle[c] + all[k].particle;
        const std::vector<Owner>& owners = owners_of_[static_cast<std::size_t>(particle)];
        if (std::ranges::find(owners, groups_.size() - 1, &Owner::pin) == owners.end()) continue;
        group.particles.push_back(particle);
        places.push_back(k);
      }
      group.info = {c, number, group.particles.size(), pin.strength};
      if (group.particles.empty()) continue;

      const auto start = [&](Index particle) -> const Vec3& { return cloth.start[particle - first_particle[c]]; };
      group.release = pin.release;
      if (pin.body) group.follow = static_cast<int>(*pin.body);
      if (pin.first_vertex) {
        for (const std::size_t place : places) group.followed_vertices.push_back(*pin.first_vertex + place);
      } else if (pin.body && model.bodies[*pin.body].deforms()) {
        std::vector<Vec3> starts;
        for (Index particle : group.particles) starts.push_back(start(particle));
        group.anchors = make_anchors(model, static_cast<std::size_t>(group.follow), start_time, starts);
      } else if (group.follow >= 0) {
        const motion::PoseSample pose = model.pose(static_cast<std::size_t>(group.follow), start_time);
        for (Index particle : group.particles)
          group.arms.push_back(pose.rotation.conjugate() * (start(particle) - pose.position));
      } else {
        group.track.emplace(pin.motion, motion::Pose{.position = pin.middle});
        for (Index particle : group.particles) group.arms.push_back(start(particle) - pin.middle);
      }
    }
  }
}

std::vector<Pins::Anchor> Pins::make_anchors(const model::Model& model, std::size_t body, double t,
                                             std::span<const Vec3> places) {
  const mesh::Mesh& surface = model.bodies[body].mesh;
  std::vector<MovingPoint> vertices;
  std::vector<Vec3> x;
  for (std::size_t v = 0; v < surface.positions.size(); ++v) {
    vertices.push_back({model.vertex(body, v, t).position, Vec3::Zero()});
    x.push_back(vertices.back().x);
  }
  // A collapsed triangle cannot carry a point beside it. Its neighbours have the same points, up to rounding.
  std::vector<mesh::Triangle> triangles = surface.topology.triangles;
  std::erase_if(triangles, [&](const mesh::Triangle& corners) {
    const auto& [a, b, c] = corners;
    return TriangleAxes(vertices[at(a)], vertices[at(b)], vertices[at(c)]).has_collapsed();
  });
  if (triangles.empty()) triangles = surface.topology.triangles;
  std::vector<Anchor> anchors;
  for (const Vec3& place : places) {
    const collision::SurfacePoint nearest = collision::nearest_point(place, triangles, x);
    Anchor& anchor = anchors.emplace_back();
    Vec3 nearest_point = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      anchor.corners[k] = static_cast<std::size_t>(nearest.face[k]);
      anchor.weights[k] = nearest.weights[k];
      nearest_point += nearest.weights[k] * x[anchor.corners[k]];
    }
    const auto& [a, b, c] = anchor.corners;
    anchor.arm = TriangleAxes(vertices[a], vertices[b], vertices[c]).axes.transpose() * (place - nearest_point);
  }
  return anchors;
}

bool Pins::release_between(double t0, double t1) const {
  return std::ranges::any_of(groups_, [&](const Group& group) {
    return !group.particles.empty() && group.release >= 0 && !model::is_later(t0, group.release) &&
           model::is_later(t1, group.release);
  });
}

void Pins::held_at(double t, double t_targets, const model::Model& model,
                   std::vector<integrator::HeldParticle>& held) const {
  held.clear();
  for (std::size_t number = 0; number < groups_.size(); ++number) {
    const Group& group = groups_[number];
    if (group.particles.empty() || (group.release >= 0 && model::is_later(t, group.release))) continue;
    const auto has = [&](std::size_t p) { return pin_of(group.particles[p], t) == number; };
    const auto vertex_motion = [&](std::size_t vertex) {
      return sample_at_step_end(
          t_targets, [&](double time) { return model.vertex(static_cast<std::size_t>(group.follow), vertex, time); });
    };
    for (std::size_t p = 0; p < group.anchors.size(); ++p) {
      if (!has(p)) continue;
      const Anchor& anchor = group.anchors[p];
      std::array<MovingPoint, 3> corners;
      MovingPoint place{Vec3::Zero(), Vec3::Zero()};
      for (std::size_t k = 0; k < 3; ++k) {
        const motion::VertexMotion vertex = vertex_motion(anchor.corners[k]);
        corners[k] = {vertex.position, vertex.velocity};
        place.x += anchor.weights[k] * vertex.position;
        place.v += anchor.weights[k] * vertex.velocity;
      }
      const TriangleAxes triangle(corners[0], corners[1], corners[2]);
      held.push_back({{group.particles[p], Mat3::Zero()},
                      place.x + triangle.axes * anchor.arm,
                      place.v + triangle.rates * anchor.arm});
    }
    for (std::size_t p = 0; p < group.followed_vertices.size(); ++p) {
      if (!has(p)) continue;
      const motion::VertexMotion place = vertex_motion(group.followed_vertices[p]);
      held.push_back({{group.particles[p], Mat3::Zero()}, place.position, place.velocity});
    }
    if (!group.anchors.empty() || !group.followed_vertices.empty()) continue;
    const motion::PoseSample pose = sample_at_step_end(t_targets, [&](double time) {
      return group.follow >= 0 ? model.pose(static_cast<std::size_t>(group.follow), time) : group.track->at(time);
    });
    for (std::size_t p = 0; p < group.particles.size(); ++p) {
      if (!has(p)) continue;
      const Vec3 arm = pose.rotation * group.arms[p];
      held.push_back({{group.particles[p], Mat3::Zero()}, pose.position + arm, pose.velocity_at(arm)});
    }
  }
}

}  // namespace weft::simulation
