#include "physics/collision/response/velocity_constraints.hpp"

#include <algorithm>
#include <cmath>

#include "core/archive.hpp"
#include "core/numerics.hpp"

namespace weft::collision {
namespace {

// A wall that pushes a particle continues to hold it if the particle, moved by this distance [m]
// against the push, passes the wall.
double probe_distance() {
  return 0.5 * numerics.separation.restored_gap;
}
// Penetration of a wall below which no further solve is needed [m].
double tolerated_penetration() {
  return 0.1 * numerics.separation.restored_gap;
}
// Two walls of a particle count as one if the cosine between their normals is at least this.
constexpr double kMinSameWallCosine = 1 - 1e-6;

struct HalfSpace {
  Vec3 normal;
  double bound;  // minimum of n·u [m]
  int wall;
};

bool is_feasible(std::span<const HalfSpace> all, const Vec3& u, double slack) {
  return std::all_of(all.begin(), all.end(), [&](const HalfSpace& h) { return h.normal.dot(u) >= h.bound - slack; });
}

// Friction / (maximum friction · slip), for a slip in units of the stick slip (stick velocity · h).
double friction_over_slip(double slip) {
  return slip < 1 ? 2 - slip : 1 / slip;
}

}  // namespace

VelocityConstraints::VelocityConstraints(std::vector<double> masses)
    : masses_(std::move(masses)), touching_index_(masses_.size(), -1), memory_(masses_.size()) {}

void VelocityConstraints::begin_step(double h) {
  step_ = h;
  for (const TouchingParticle& particle : touching_particles_) touching_index_[particle.particle] = -1;
  touching_particles_.clear();
  walls_.clear();
  prescribed_.clear();
}

void VelocityConstraints::add(Index particle, const Vec3& normal, double distance, double d_min, const Vec3& motion,
                              double friction, double static_friction) {
  int& place = touching_index_[particle];
  if (place < 0) {
    place = static_cast<int>(touching_particles_.size());
    touching_particles_.push_back({particle, -1, {}, {}});
  }
  TouchingParticle& touching = touching_particles_[place];
  const double gamma_d_min = distance >= d_min ? d_min : distance + numerics.walls.correction * (d_min - distance);
  const double bound = gamma_d_min - distance + normal.dot(motion);
  for (int w = touching.first_wall; w >= 0; w = walls_[w].next) {
    Wall& wall = walls_[w];
    if (wall.normal.dot(normal) < kMinSameWallCosine) continue;
    if (bound > wall.bound + kRoundoff)
      wall = {wall.normal, bound, motion, friction, std::max(friction, static_friction), wall.next};
    else
      wall.bound = std::max(wall.bound, bound);
    return;
  }
  walls_.push_back({normal, bound, motion, friction, std::max(friction, static_friction), touching.first_wall});
  touching.first_wall = static_cast<int>(walls_.size()) - 1;
}

// The displacement closest to u that passes no wall of the particle. `held`: the walls that limit
// it, with multipliers. Tries the Karush-Kuhn-Tucker conditions for every set of up to three of the
// Numerics::Walls::max_walls walls that u passes farthest. If `of_force` is true, uses only the
// walls that hold now, with bound 0. −u is then the direction of a force, and the multipliers are
// its components along the normals.
Vec3 VelocityConstraints::project(const TouchingParticle& particle, const Vec3& u, bool of_force,
                                  ActiveWalls& held) const {
  held = {};
  std::vector<HalfSpace> all;
  for (int w = particle.first_wall; w >= 0; w = walls_[w].next) {
    const Wall& wall = walls_[w];
    const auto& holding = particle.held.walls;
    if (of_force && std::find(holding.begin(), holding.end(), w) == holding.end()) continue;
    all.push_back({wall.normal, of_force ? 0 : wall.bound, w});
  }
  if (is_feasible(all, u, kRoundoff)) return u;
  const auto missing = [&](const HalfSpace& h) { return h.bound - h.normal.dot(u); };
  if (std::ssize(all) > numerics.walls.max_walls) {
    std::stable_sort(all.begin(), all.end(), [&](const auto& a, const auto& b) { return missing(a) > missing(b); });
    all.resize(numerics.walls.max_walls);
  }

  const std::size_t n = all.size();
  for (std::size_t i = 0; i < n; ++i) {
    const double multiplier = missing(all[i]);
    Vec3 moved = u + multiplier * all[i].normal;
    if (multiplier <= 0 || !is_feasible(all, moved, kRoundoff)) continue;
    held = {{all[i].wall, -1, -1}, {multiplier, 0, 0}, 1};
    return moved;
  }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j) {
      const double c = all[i].normal.dot(all[j].normal), determinant = 1 - c * c;
      if (determinant < 1e-12) continue;
      const double a = missing(all[i]), b = missing(all[j]);
      const double multiplier_i = (a - c * b) / determinant, multiplier_j = (b - c * a) / determinant;
      Vec3 moved = u + multiplier_i * all[i].normal + multiplier_j * all[j].normal;
      if (multiplier_i < 0 || multiplier_j < 0 || !is_feasible(all, moved, kRoundoff)) continue;
      held = {{all[i].wall, all[j].wall, -1}, {multiplier_i, multiplier_j, 0}, 2};
      return moved;
    }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j)
      for (std::size_t k = j + 1; k < n; ++k) {
        Mat3 normals;
        normals << all[i].normal, all[j].normal, all[k].normal;
        if (std::abs(normals.determinant()) < 1e-6) continue;
        const Mat3 gram = normals.transpose() * normals;
        const Vec3 multipliers = gram.inverse() * Vec3(missing(all[i]), missing(all[j]), missing(all[k]));
        Vec3 moved = u + normals * multipliers;
        if (multipliers.minCoeff() < 0 || !is_feasible(all, moved, kRoundoff)) continue;
        held = {{all[i].wall, all[j].wall, all[k].wall}, {multipliers[0], multipliers[1], multipliers[2]}, 3};
        return moved;
      }
  // The walls leave no space: use only the one that u passes farthest. Separation still ensures
  // that nothing intersects.
  const auto worst =
      std::max_element(all.begin(), all.end(), [&](const auto& a, const auto& b) { return missing(a) < missing(b); });
  held = {{worst->wall, -1, -1}, {missing(*worst), 0, 0}, 1};
  return u + missing(*worst) * worst->normal;
}

int VelocityConstraints::main_wall(const TouchingParticle& particle) const {
  const auto& multipliers = particle.held.multipliers;
  return particle.held.walls[std::max_element(multipliers.begin(), multipliers.end()) - multipliers.begin()];
}

// Makes these walls hold the particle. `u`: displacement that passes none of them. A sticking particle moves with its
// main wall (the one with the largest multiplier), at the distance that this wall prescribes.
void VelocityConstraints::activate_walls(TouchingParticle& particle, const Vec3& u, ActiveWalls held) {
  particle.held = held;
  particle.u_held = u;
  const Wall& wall = walls_[main_wall(particle)];
  if (particle.memory.state == State::sticking && wall.static_friction > 0) {
    const Vec3 along = wall.motion + (wall.bound - wall.normal.dot(wall.motion)) * wall.normal;
    ActiveWalls more;
    particle.u_held = project(particle, along, false, more);
  } else {
    particle.memory.state = State::sliding;
  }
}

bool VelocityConstraints::predict_wall_contacts(std::span<const Vec3> x_t1, double by,
                                                std::vector<Vec3>& predicted) const {
  bool any = false;
  for (Index particle : previously_held_) {
    if (touching_index_[particle] >= 0) continue;
    if (!any) predicted.assign(x_t1.begin(), x_t1.end());
    any = true;
    predicted[particle] -= by * memory_[particle].push.normalized();
  }
  return any;
}

void VelocityConstraints::prepare(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) {
  for (TouchingParticle& particle : touching_particles_) {
    const Index i = particle.particle;
    particle.x_t0 = x_t0[i];
    particle.memory = memory_[i];
    const double push = particle.memory.push.norm();
    const Vec3 guess = x_t1[i] - x_t0[i];
    ActiveWalls held;
    const Vec3 u =
        project(particle, push > 0 ? Vec3(guess - probe_distance() / push * particle.memory.push) : guess, false, held);
    if (held.count == 0) {
      particle.memory = {};
      continue;
    }
    activate_walls(particle, u, held);
    particle.friction_normal_force = particle.memory.normal_force;
    const Vec3 slips = slip(particle, x_t1[i]) / (numerics.contact.stick_velocity * step_);
    particle.relative_friction = friction_over_slip(slips.norm()) * slips;
  }
  prescribe();
}

int VelocityConstraints::revise(std::span<const Vec3> x_t0, std::span<const Vec3> x_end, const ForceOn& force_on) {
  int changed = 0;
  for (TouchingParticle& particle : touching_particles_) {
    const Index i = particle.particle;
    particle.x_t0 = x_t0[i];
    Vec3 force = Vec3::Zero();
    if (particle.memory.state != State::away) {
      // The walls also exert the force that changes the velocity of an arriving particle from its mean in the step to
      // v_end.
      const PrescribedParticle prescribed = prescription(particle);
      const Vec3 arrested = prescribed.v_end - (x_end[i] - x_t0[i]) / step_;
      force = force_on(particle.particle) + masses_[i] / step_ * (arrested - prescribed.constraint.free * arrested);
    }
    changed += revise(particle, x_end[i], force) ? 1 : 0;
  }
  if (changed > 0) prescribe();
  return changed;
}

// Decides which walls hold the particle. `force`: that of its walls in the last solve [N]. Returns
// whether the solve must be repeated: false if the change is negligible, or if the constraint has
// already changed Numerics::Walls::max_constraint_changes times in this step.
bool VelocityConstraints::revise(TouchingParticle& particle, const Vec3& x_end, const Vec3& force) {
  Memory& memory = particle.memory;
  const Vec3 u = x_end - particle.x_t0;
  const double negligible = numerics.walls.negligible_acceleration * masses_[particle.particle];
  ActiveWalls next;
  if (memory.state == State::away) {
    const Vec3 held_at = project(particle, u, false, next);
    if (next.multiplier_sum() < tolerated_penetration()) return false;
    activate_walls(particle, held_at, next);
    return particle.constraint_changes++ < numerics.walls.max_constraint_changes;
  }

  // Split the force into components along the normals of the walls and the rest (`rest`), a tangential force or a pull.
  ActiveWalls pushing;
  const double size = force.norm();
  const Vec3 rest = size > 0 ? Vec3(-size * project(particle, -force / size, true, pushing)) : Vec3::Zero();
  memory.push = force - rest;
  particle.force_across = rest;
  memory.normal_force = size * pushing.multiplier_sum();
  const double push = memory.push.norm();
  const Vec3 held_at = project(particle, push > 0 ? Vec3(u - probe_distance() / push * memory.push) : u, false, next);
  if (next.count == 0) {
    if (rest.norm() > negligible && particle.constraint_changes++ >= numerics.walls.max_constraint_changes)
      return false;
    memory = {};
    particle.held = {};
    particle.friction_normal_force = 0;
    return rest.norm() > negligible;
  }

  ActiveWalls passed;
  project(particle, u, false, passed);
  const Wall& wall = walls_[main_wall(particle)];
  const double limit = (memory.state == State::sticking ? wall.static_friction : wall.friction) * memory.normal_force;
  if (memory.state == State::sticking) {
    const bool slips = rest.norm() > limit, passes = passed.multiplier_sum() >= tolerated_penetration();
    if (!(slips || passes) || particle.constraint_changes++ >= numerics.walls.max_constraint_changes) return false;
    if (slips) {
      memory.state = State::sliding;
      particle.friction_normal_force = memory.normal_force;
      particle.is_overloaded = rest.norm() - limit > negligible;
    }
    activate_walls(particle, held_at, next);
    return passes;  // if it only slips, no further solve: too much friction in one step is harmless
  }

  const bool other_walls = !next.same_walls(particle.held);
  const double change = wall.friction * std::abs(memory.normal_force - particle.friction_normal_force);
  const bool other_load = change > negligible && change > numerics.walls.negligible_change * limit;
  const bool fast = slip(particle, x_end).norm() >= numerics.contact.stick_velocity * step_;
  particle.may_stick = limit > 0 && !other_load && !other_walls && !fast;
  activate_walls(particle, held_at, next);
  particle.friction_normal_force = memory.normal_force;
  const bool matters =
      other_load || (other_walls && (passed.multiplier_sum() >= tolerated_penetration() || rest.norm() > negligible));
  return matters && particle.constraint_changes++ < numerics.walls.max_constraint_changes;
}

void VelocityConstraints::accept() {
  // If an overloaded particle has begun to slide, no particle begins to stick: the sliding one may have held its slow
  // neighbours. Without this rule, two halves of touching cloth could stick in turn and so hold all of it on any
  // incline.
  const bool any_overloaded =
      std::ranges::any_of(touching_particles_, [](const TouchingParticle& particle) { return particle.is_overloaded; });
  for (Index particle : previously_held_) memory_[particle] = {};
  previously_held_.clear();
  for (const TouchingParticle& particle : touching_particles_) {
    if (particle.memory.state == State::away) continue;
    Memory& memory = memory_[particle.particle] = particle.memory;
    if (particle.may_stick && !any_overloaded) memory.state = State::sticking;
    previously_held_.push_back(particle.particle);
  }
}

// Projector onto the unconstrained directions: I − Σ q qᵀ over an orthonormal basis q of the normals of the holding
// walls.
Mat3 VelocityConstraints::free_directions(const TouchingParticle& particle) const {
  Mat3 free = Mat3::Identity();
  for (int k = 0; k < particle.held.count; ++k) {
    const Vec3 q = free * walls_[particle.held.walls[k]].normal;
    const double size = q.norm();
    if (size < numerics.walls.min_independent_sine) continue;
    free -= q * q.transpose() / (size * size);
  }
  return free;
}

PrescribedParticle VelocityConstraints::prescription(const TouchingParticle& particle) const {
  PrescribedParticle result{{particle.particle, Mat3::Zero()}, particle.x_t0 + particle.u_held, Vec3::Zero()};
  if (particle.memory.state == State::sticking) {
    result.v_end = walls_[main_wall(particle)].motion / step_;
    return result;
  }
  // Make v_end equal the velocity of the obstacle along each normal, without changing v_end along
  // the earlier normals.
  Mat3 free = Mat3::Identity();
  for (int k = 0; k < particle.held.count; ++k) {
    const Wall& wall = walls_[particle.held.walls[k]];
    const Vec3 q = free * wall.normal;
    const double size_sq = q.squaredNorm();
    if (size_sq < numerics.walls.min_independent_sine * numerics.walls.min_independent_sine) continue;
    result.v_end += (wall.normal.dot(wall.motion) / step_ - wall.normal.dot(result.v_end)) / size_sq * q;
    free -= q * q.transpose() / size_sq;
  }
  result.constraint.free = free;
  return result;
}

void VelocityConstraints::prescribe() {
  prescribed_.clear();
  for (const TouchingParticle& particle : touching_particles_)
    if (particle.memory.state != State::away) prescribed_.push_back(prescription(particle));
}

// Displacement of a particle along its walls, relative to the obstacle of its main wall [m].
Vec3 VelocityConstraints::slip(const TouchingParticle& particle, const Vec3& x_end) const {
  const Wall& wall = walls_[main_wall(particle)];
  return free_directions(particle) * (x_end - particle.x_t0 - wall.motion);
}

VelocityConstraints::Friction VelocityConstraints::friction(const TouchingParticle& particle, const Vec3& x_end) const {
  const double stick_slip = numerics.contact.stick_velocity * step_;
  const Vec3 slips = slip(particle, x_end) / stick_slip;
  const double size = slips.norm();
  const double limit = walls_[main_wall(particle)].friction * particle.friction_normal_force;
  const double sliding = limit * friction_over_slip(size);
  const Mat3 free = free_directions(particle);
  // Derivative of slip / friction with respect to the slip.
  const double growth = size < 1 ? 1 / ((2 - size) * (2 - size)) : 1;
  return {-sliding * slips,
          sliding / stick_slip * friction_tangent(free, slips, growth * (free * particle.relative_friction))};
}

void VelocityConstraints::add_forces(std::span<const Vec3> x_end, std::span<Vec3> force) const {
  for (const TouchingParticle& particle : touching_particles_) {
    const Index i = particle.particle;
    if (particle.memory.state == State::sliding && particle.friction_normal_force > 0)
      force[i] += friction(particle, x_end[i]).force;
  }
}

void VelocityConstraints::add_normal_and_friction_forces(std::span<const Vec3> x_end, std::span<Vec3> push,
                                                         std::span<Vec3> friction, std::span<double> normal_force,
                                                         std::span<double> limit) const {
  for (const TouchingParticle& particle : touching_particles_) {
    const Index i = particle.particle;
    if (particle.memory.state == State::sticking) {
      push[i] += particle.memory.push;
      friction[i] += particle.force_across;
      normal_force[i] += particle.memory.normal_force;
      limit[i] += walls_[main_wall(particle)].static_friction * particle.memory.normal_force;
      continue;
    }
    if (particle.memory.state != State::sliding || particle.friction_normal_force == 0) continue;
    const Wall& wall = walls_[main_wall(particle)];
    push[i] += particle.friction_normal_force * wall.normal;
    friction[i] += this->friction(particle, x_end[i]).force;
    normal_force[i] += particle.friction_normal_force;
    limit[i] += wall.static_friction * particle.friction_normal_force;
  }
}

void VelocityConstraints::linearise(std::span<const Vec3> x_end, double end_rate, std::span<Vec3> force,
                                    solver::LinearSystem& system) const {
  for (const TouchingParticle& particle : touching_particles_) {
    const Index i = particle.particle;
    if (particle.memory.state != State::sliding || particle.friction_normal_force == 0) continue;
    const Friction sliding = friction(particle, x_end[i]);
    force[i] += sliding.force;
    system.diagonal_terms.push_back({particle.particle, end_rate * sliding.stiffness});
  }
}

template <class Archive>
void VelocityConstraints::serialize(Archive& archive) {
  if constexpr (Archive::kReads)
    for (Index particle : previously_held_) memory_[particle] = {};
  serialize_each(archive, previously_held_, [&](Index& particle) {
    archive.value(particle);
    if constexpr (Archive::kReads)
      require(particle >= 0 && static_cast<std::size_t>(particle) < masses_.size(), "particles of the scene");
    Memory& memory = memory_[particle];
    serialize_values(archive, memory.state, memory.push, memory.normal_force);
    if constexpr (Archive::kReads) require(memory.state <= State::sliding, "a particle that sticks or slides");
  });
}

template void VelocityConstraints::serialize(ByteWriter&);
template void VelocityConstraints::serialize(ByteReader&);

}  // namespace weft::collision
