#include "physics/simulation/attachments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/archive.hpp"
#include "physics/collision/proximity/surface_point.hpp"
#include "physics/simulation/pins.hpp"

namespace weft::simulation {
namespace {

/// An optional number as an index; −1 if it is absent.
int index_of(std::optional<std::size_t> number) {
  return number ? static_cast<int>(*number) : -1;
}

}  // namespace

Attachments::Attachments(const model::Model& model, std::span<const Index> first_particle,
                         std::span<const Index> first_of_frames)
    : model_(&model), step_(model.time.step), first_particle_(first_particle.begin(), first_particle.end()) {
  for (const model::Attachment& given : model.attachments) {
    Attachment attachment;
    attachment.name = given.name;
    attachment.cloth = index_of(given.to_cloth);
    attachment.body = index_of(given.to_body);
    if (attachment.body >= 0) attachment.frame = first_of_frames[attachment.body];
    attachment.begin = given.begin;
    attachment.release = given.release >= 0 ? given.release : std::numeric_limits<double>::infinity();
    attachment.length = given.length;
    attachment.breaking_load = given.breaking_load;
    for (const model::WeightedParticle& one : given.particles)
      attachment.springs.push_back(
          {.particle = first_particle_[given.cloth] + one.particle, .stiffness = given.stiffness * one.fraction});
    attachments_.push_back(std::move(attachment));
  }
}

bool Attachments::holds_at(const Attachment& attachment, double t) const {
  return attachment.state != State::broken && !model::is_later(attachment.begin, t) &&
         !model::is_later(t, attachment.release);
}

// Position of a body's vertex at time t [m].
Vec3 Attachments::corner_position(std::size_t body, Index vertex, double t) const {
  const model::Body& object = model_->bodies[body];
  if (object.deforms()) return model_->vertex(body, static_cast<std::size_t>(vertex), t).position;
  const motion::PoseSample pose = model_->pose(body, t);
  return pose.position + pose.rotation * object.mesh.positions[static_cast<std::size_t>(vertex)];
}

const mesh::RigidFrame& Attachments::frame_of(const Attachment& attachment) const {
  return model_->bodies[attachment.body].dynamics->frame;
}

// Converts a point from weights of three vertices to weights of the four frame particles of their body.
void Attachments::move_to_frame(const Attachment& attachment, Spring& spring) const {
  const std::vector<mesh::RigidFrame::Weights>& weights = frame_of(attachment).weights();
  const Spring on_vertices = spring;
  for (std::size_t k = 0; k < 4; ++k) {
    spring.corners[k] = attachment.frame + static_cast<Index>(k);
    spring.weights[k] = 0;
    for (std::size_t v = 0; v < 3; ++v)
      spring.weights[k] += on_vertices.weights[v] * weights[static_cast<std::size_t>(on_vertices.corners[v])][k];
  }
}

// Ties each spring to the nearest point on the target at time t; `x`: particles [m].
void Attachments::tie_to_target(Attachment& attachment, double t, std::span<const Vec3> x,
                                std::span<const double> masses) const {
  std::vector<Vec3> of_target;
  const bool is_cloth = attachment.cloth >= 0;
  const Index first = is_cloth ? first_particle_[attachment.cloth] : 0;
  if (is_cloth) {
    const auto own = x.subspan(first, model_->cloths[attachment.cloth].start.size());
    of_target.assign(own.begin(), own.end());
  } else {
    of_target.resize(model_->bodies[attachment.body].mesh.positions.size());
    if (attachment.frame >= 0)
      frame_of(attachment).place(x.subspan(attachment.frame, mesh::RigidFrame::kParticles), of_target);
    else
      model_->place(static_cast<std::size_t>(attachment.body), t, of_target);
  }
  const auto& triangles = is_cloth ? model_->cloths[attachment.cloth].mesh.topology.triangles
                                   : model_->bodies[attachment.body].mesh.topology.triangles;
  attachment.speed = 0;
  for (Spring& spring : attachment.springs) {
    const Vec3& own = x[spring.particle];
    const collision::SurfacePoint nearest = collision::nearest_point(own, triangles, of_target);
    Vec3 place = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      spring.corners[k] = first + nearest.face[k];
      spring.weights[k] = nearest.weights[k];
      place += nearest.weights[k] * of_target[nearest.face[k]];
    }
    const double distance = (place - own).norm();
    spring.length = attachment.length.value_or(distance);
    // Let e be the spring's extension beyond its rest length. Without other forces, the particle reaches the speed
    // e √(k/m), for its mass m and the stiffness k. An implicit step moves the particle by at most e,
    // so its speed is also at most e / step.
    const double rate = std::min(std::sqrt(spring.stiffness / masses[spring.particle]), 1 / step_);
    attachment.speed = std::max(attachment.speed, rate * (distance - spring.length));
    if (attachment.frame >= 0) move_to_frame(attachment, spring);
  }
  attachment.state = State::tied;
}

void Attachments::begin_step(double t0, double t1, std::span<const Vec3> x, std::span<const double> masses) {
  for (Attachment& attachment : attachments_) {
    // A longer attempt, which was rejected, tied the attachment. This shorter step ends before the attachment begins.
    if (attachment.state == State::tied && model::is_later(attachment.begin, t1)) attachment.state = State::open;
    attachment.holds = holds_at(attachment, t1);
    if (!attachment.holds) continue;
    if (attachment.state == State::open) tie_to_target(attachment, t0, x, masses);
    if (attachment.target_has_particles()) continue;
    for (Spring& spring : attachment.springs) {
      spring.place.setZero();
      for (std::size_t k = 0; k < 3; ++k)
        spring.place += spring.weights[k] * corner_position(attachment.body, spring.corners[k], t1);
    }
  }
}

bool Attachments::are_constant_between(double t0, double t1) const {
  return std::ranges::all_of(attachments_, [&](const Attachment& attachment) {
    if (holds_at(attachment, t0) != holds_at(attachment, t1)) return false;
    if (attachment.target_has_particles() || !holds_at(attachment, t1)) return true;
    return std::ranges::all_of(attachment.springs, [&](const Spring& spring) {
      return std::ranges::all_of(std::span(spring.corners).first(3), [&](Index vertex) {
        return corner_position(attachment.body, vertex, t0) == corner_position(attachment.body, vertex, t1);
      });
    });
  });
}

Vec3 Attachments::place_of(const Attachment& attachment, const Spring& spring, std::span<const Vec3> x) const {
  if (!attachment.target_has_particles()) return spring.place;
  const Vec3 of_three = spring.weights[0] * x[spring.corners[0]] + spring.weights[1] * x[spring.corners[1]] +
                        spring.weights[2] * x[spring.corners[2]];
  return attachment.frame < 0 ? of_three : Vec3(of_three + spring.weights[3] * x[spring.corners[3]]);
}

Attachments::Tension Attachments::compute_tension(const Attachment& attachment, const Spring& spring,
                                                  std::span<const Vec3> x) const {
  const Vec3 direction = place_of(attachment, spring, x) - x[spring.particle];
  const double length = direction.norm();
  if (length <= spring.length) return {};
  return {direction / length, spring.stiffness * (length - spring.length), length};
}

// Calls visit(attachment, spring, tension) for each spring in tension.
template <class Visit>
void Attachments::for_each_tension(std::span<const Vec3> x, const Visit& visit) const {
  for (const Attachment& attachment : attachments_) {
    if (!attachment.holds) continue;
    for (const Spring& spring : attachment.springs)
      if (const Tension tension = compute_tension(attachment, spring, x); tension.force > 0)
        visit(attachment, spring, tension);
  }
}

void Attachments::add_forces(std::span<const Vec3> x_end, std::span<Vec3> force) const {
  for_each_tension(x_end, [&](const Attachment& attachment, const Spring& spring, const Tension& tension) {
    force[spring.particle] += tension.force * tension.direction;
    if (!attachment.target_has_particles()) return;
    for (std::size_t k = 0; k < (attachment.frame < 0 ? 3 : 4); ++k)
      force[spring.corners[k]] -= spring.weights[k] * tension.force * tension.direction;
  });
}

void Attachments::add_terms(std::span<const Vec3> x_end, double end_rate, solver::LinearSystem& system) const {
  for_each_tension(x_end, [&](const Attachment& attachment, const Spring& spring, const Tension& tension) {
    // This matrix is positive semidefinite, because 0 < lateral <= spring.stiffness for a spring in tension.
    const double lateral = tension.force / tension.length;
    const Mat3 stiffness =
        end_rate *
        ((spring.stiffness - lateral) * tension.direction * tension.direction.transpose() + lateral * Mat3::Identity());
    if (!attachment.target_has_particles()) {
      system.diagonal_terms.push_back({spring.particle, stiffness});
      return;
    }
    if (attachment.frame >= 0) {
      solver::WideTerm& term = system.wide_terms.emplace_back();
      term.stiffness = stiffness;
      term.particles[0] = spring.particle, term.weights[0] = 1;
      for (std::size_t k = 0; k < 4; ++k)
        term.particles[1 + k] = spring.corners[k], term.weights[1 + k] = -spring.weights[k];
      return;
    }
    system.terms.push_back({{spring.particle, spring.corners[0], spring.corners[1], spring.corners[2]},
                            {1, -spring.weights[0], -spring.weights[1], -spring.weights[2]},
                            stiffness});
  });
}

double Attachments::energy(std::span<const Vec3> x_end) const {
  double sum = 0;
  for_each_tension(x_end, [&](const Attachment&, const Spring& spring, const Tension& tension) {
    sum += 0.5 * tension.force * tension.force / spring.stiffness;
  });
  return sum;
}

std::vector<std::string> Attachments::accept(std::span<const Vec3> x) {
  std::vector<std::string> warnings;
  for (Attachment& attachment : attachments_) {
    attachment.load = 0;
    if (!attachment.holds) continue;
    for (const Spring& spring : attachment.springs) attachment.load += compute_tension(attachment, spring, x).force;
    if (const double speed = std::exchange(attachment.speed, 0); speed > kMaxHoldSpeed)
      warnings.push_back(
          fmt::format("attach.{}: pulls cloth to its target at {:.3g} m/s when it is tied, where cloth can follow at "
                      "{:g} m/s; move both nearer to each other before `begin`, or reduce `stiffness`",
                      attachment.name, speed, kMaxHoldSpeed));
    // The springs of a broken attachment store no energy any more.
    if (attachment.breaking_load && attachment.load > *attachment.breaking_load)
      attachment.state = State::broken, attachment.holds = false;
  }
  return warnings;
}

std::vector<AttachmentLoad> Attachments::measure() const {
  std::vector<AttachmentLoad> loads;
  for (const Attachment& attachment : attachments_)
    loads.push_back({attachment.name, attachment.load, attachment.holds});
  return loads;
}

void Attachments::copy_state_from(const Attachments& there, std::span<const std::size_t> cloths) {
  for (const Attachment& before : there.attachments_) {
    const auto found = std::ranges::find(attachments_, before.name, &Attachment::name);
    if (found == attachments_.end()) continue;
    found->state = before.state, found->holds = before.holds, found->load = before.load;
    found->speed = before.speed;
    for (std::size_t s = 0; s < before.springs.size(); ++s) {
      Spring& spring = found->springs[s];
      const Index particle = spring.particle;
      spring = before.springs[s];
      spring.particle = particle;
      if (!before.target_has_particles()) continue;
      const Index shift = before.frame >= 0
                              ? found->frame - before.frame
                              : first_particle_[cloths[before.cloth]] - there.first_particle_[before.cloth];
      for (Index& corner : spring.corners) corner += shift;
    }
  }
}

template <class Archive>
void Attachments::serialize(Archive& archive) {
  for (Attachment& attachment : attachments_) {
    serialize_values(archive, attachment.state, attachment.holds, attachment.load);
    if constexpr (Archive::kReads) require(attachment.state <= State::broken, "an attachment");
    const std::size_t count =
        attachment.frame >= 0   ? static_cast<std::size_t>(attachment.frame) + 4
        : attachment.cloth >= 0 ? static_cast<std::size_t>(first_particle_.back()) + model_->cloths.back().start.size()
                                : model_->bodies[attachment.body].mesh.positions.size();
    for (Spring& spring : attachment.springs) {
      for (std::size_t k = 0; k < spring.corners.size(); ++k) {
        serialize_values(archive, spring.corners[k], spring.weights[k]);
        if constexpr (Archive::kReads)
          require(spring.corners[k] >= 0 && static_cast<std::size_t>(spring.corners[k]) < count &&
                      std::isfinite(spring.weights[k]),
                  "a place of an attachment");
      }
      serialize_values(archive, spring.length, spring.place.x(), spring.place.y(), spring.place.z());
      if constexpr (Archive::kReads)
        require(spring.length >= 0 && spring.place.allFinite(), "a length and a place of an attachment");
    }
  }
}

template void Attachments::serialize(ByteWriter&);
template void Attachments::serialize(ByteReader&);

}  // namespace weft::simulation
