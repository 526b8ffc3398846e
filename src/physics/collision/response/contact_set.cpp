#include "physics/collision/response/contact_set.hpp"

#include <algorithm>
#include <cmath>

#include "core/numerics.hpp"
#include "core/parallel_append.hpp"

namespace weft::collision {
namespace {

Vec3 weighted_sum(const Contact& contact, std::span<const Vec3> x) {
  Vec3 sum = contact.weights[0] * x[contact.particles[0]];
  for (int k = 1; k < 4; ++k) sum += contact.weights[k] * x[contact.particles[k]];
  return sum;
}

// Limits of depth_for_force(): number of iterations, and relative error of the force. A relative error e of the depth
// changes the force that update() finds along the tangent only by the order of e²: here, less than rounding. With an
// error of 1e-3, the solver cannot reach a newton_tolerance of 1e-6.
constexpr int kDepthIterations = 30;
constexpr double kDepthTolerance = 1e-8;

struct NormalForce {
  double force, slope;  // [N], [N/m]
};

// Normal force at this depth [m], and its slope. If the depth is not positive, the force is zero,
// and the slope is k.
NormalForce normal_force_at(const Contact& contact, double depth) {
  if (depth <= 0) return {0, contact.stiffness};
  const double full = std::max(contact.full_range, contact.range);
  const double inner = std::min(depth, full), ratio_sq = (inner / full) * (inner / full);
  const double stiffening = numerics.contact.stiffening * ratio_sq * ratio_sq;
  const double slope = contact.stiffness * (1 + 5 * stiffening);
  return {contact.stiffness * inner * (1 + stiffening) + slope * (depth - inner), slope};
}

// Value at `depth` of the tangent to the normal force at `depth_at` [N]; never negative. `at`: force and slope there.
double tangent_force(const NormalForce& at, double depth_at, double depth) {
  return std::max(0.0, at.force + at.slope * (depth - depth_at));
}

// Inverse of normal_force_at(): the depth with this force; 0 if the force is not positive. `depth`:
// a first guess, not smaller than the result. The force is a convex function of depth, so Newton's
// method converges monotonically from above.
double depth_for_force(const Contact& contact, double force, double depth) {
  if (force <= 0) return 0;
  depth = std::min(depth, force / contact.stiffness);
  for (int k = 0; k < kDepthIterations; ++k) {
    const NormalForce normal_force = normal_force_at(contact, depth);
    if (normal_force.force - force <= kDepthTolerance * force) break;
    depth -= (normal_force.force - force) / normal_force.slope;
  }
  return depth;
}

// Point a minus point b at the end of the step [m].
Vec3 relative_end(const Contact& contact, std::span<const Vec3> x_end) {
  return weighted_sum(contact, x_end) + contact.obstacle_end;
}

// Friction / (normal force · slip), for a slip in units of the stick slip: μ (2 − slip) if slip < 1, else μ / slip. The
// coefficient μ is that of static friction up to a slip of 1; from there it falls to that of sliding friction, which it
// reaches at a slip of Numerics::Contact::slide_velocity. If both coefficients are equal, friction is continuously
// differentiable.
double friction_over_slip(const Contact& contact, double slip) {
  if (slip < 1) return contact.static_friction * (2 - slip);
  const double sliding = std::min(1.0, (slip - 1) / (numerics.contact.slide_velocity - 1));
  return (contact.static_friction + sliding * (contact.friction - contact.static_friction)) / slip;
}

// ψ' of friction_tangent(): derivative of 1 / friction_over_slip() with respect to the slip. Neglects the drop from
// static to sliding friction.
double slope_of_slip_over_friction(const Contact& contact, double slip) {
  if (slip < 1) return 1 / (contact.static_friction * (2 - slip) * (2 - slip));
  return 1 / (slip * friction_over_slip(contact, slip));
}

// w = −friction / normal force for a slip in units of the stick slip.
Vec3 friction_over_normal_force(const Contact& contact, const Vec3& slip) {
  if (contact.static_friction == 0) return Vec3::Zero();
  return friction_over_slip(contact, slip.norm()) * slip;
}

// Inverse of friction_over_normal_force(): the slip that w corresponds to. ‖w‖ must not exceed the static friction
// coefficient.
Vec3 sticking_slip(const Contact& contact, const Vec3& w) {
  const double slip = 1 - std::sqrt(std::max(0.0, 1 - w.norm() / contact.static_friction));
  return w / friction_over_slip(contact, slip);
}

// Derivative of w with respect to a slip in units of the stick slip. Exact if w corresponds to the slip, else a
// positive semidefinite approximation.
Mat3 friction_slope(const Contact& contact, const Vec3& slip, const Vec3& w) {
  const double size = slip.norm(), ratio = friction_over_slip(contact, size);
  if (ratio == 0) return Mat3::Zero();  // sliding has no friction
  return ratio * friction_tangent(Mat3::Identity() - contact.normal * contact.normal.transpose(), slip,
                                  slope_of_slip_over_friction(contact, size) * w);
}

// Slip of point a relative to point b during the step, in the tangent plane [m].
Vec3 slip_of(const Contact& contact, const Vec3& relative) {
  const Vec3 slip = relative - contact.relative_start;
  return slip - contact.normal.dot(slip) * contact.normal;
}

// Fraction to which a contact is an impact, 0 to 1; see add_impacts(). Estimated from the motion of its particles up to
// the start of the step, and from the motion of the obstacle in the step.
double impact_fraction(const Contact& contact, const StepStart& start) {
  const auto along_normal = [&](std::span<const Vec3> of) { return contact.normal.dot(weighted_sum(contact, of)); };
  const double velocity = along_normal(start.v);
  double opening = start.h * velocity;
  if (start.h_before > 0) {
    const double ratio = start.h / start.h_before;
    opening = std::max({opening, start.h * (velocity + ratio * (velocity - along_normal(start.v_before))),
                        ratio * (along_normal(start.x) - along_normal(start.x_before))});
  }
  opening += contact.normal.dot(contact.obstacle_end - contact.obstacle_start);
  return opening < 0 ? std::min(1.0, -opening / (start.h * numerics.contact.impact_velocity)) : 0;
}

// Tangential velocity jump of point a relative to point b [m/s], without the motion of an obstacle:
// mean velocity in a step that ends at x_end, minus velocity at its start. Limited to the jump that
// friction can cause.
Vec3 tangential_jump(const Contact& contact, std::span<const Vec3> x_end, const StepStart& start) {
  const Vec3 jump =
      (weighted_sum(contact, x_end) - weighted_sum(contact, start.x)) / start.h - weighted_sum(contact, start.v);
  const double along = contact.normal.dot(jump), max_friction = contact.static_friction * std::max(0.0, along);
  const Vec3 across = jump - along * contact.normal;
  const double size = across.norm();
  return size > max_friction ? Vec3(max_friction / size * across) : across;
}

// Adds a force on the points of a contact to `force`, and its stiffness to `system`.
void add_term(const Contact& contact, const Vec3& push, const Mat3& stiffness, std::span<Vec3> force,
              solver::LinearSystem& system) {
  int involved = 0, last = 0;
  for (int k = 0; k < 4; ++k) {
    force[contact.particles[k]] += contact.weights[k] * push;
    if (contact.weights[k] != 0) ++involved, last = k;
  }
  if (involved == 1) {
    // A single particle against an obstacle couples to no other particle.
    const double w = contact.weights[last];
    system.diagonal_terms.push_back({contact.particles[last], w * w * stiffness});
  } else {
    system.terms.push_back({contact.particles, contact.weights, stiffness});
  }
}

// Updates the friction of a contact, as update() describes. `slip`: in units of the stick slip.
void update_friction(const Contact& contact, const Vec3& slip, FrictionState& state) {
  const bool turned = slip.dot(state.slip) < 0;
  state.slip = slip;
  if (state.sticks) {
    const Vec3 held_at = sticking_slip(contact, state.relative_friction);
    state.relative_friction += friction_slope(contact, held_at, state.relative_friction) * (slip - held_at);
    const double ratio = state.relative_friction.norm() / contact.static_friction;
    if (ratio < 1) return;
    state.relative_friction /= ratio;
    state.sticks = false;
    ++state.slide_starts;
  } else if (slip.squaredNorm() < 1) {
    state.relative_friction = friction_over_normal_force(contact, slip);
    state.sticks = true;
  } else if (turned && state.slide_starts < numerics.contact.max_resticks) {
    state.relative_friction = Vec3::Zero();
    state.sticks = true;
  }
}

}  // namespace

Mat3 friction_tangent(const Mat3& across, const Vec3& slip, Vec3 w) {
  const double size = slip.norm();
  if (size == 0) return across;
  const Vec3 u = slip / size;
  if (w.squaredNorm() > 1) w.normalize();
  return across - 0.5 * (w * u.transpose() + u * w.transpose());
}

void ContactSet::add(const Contact& contact) {
  contacts_.push_back(contact);
  contacts_.back().static_friction = std::max(contact.friction, contact.static_friction);
}

void ContactSet::update(std::span<const Vec3> x_end, ContactStates& states) const {
  const auto update_contact = [&](std::size_t c) {
    const Contact& contact = contacts_[c];
    const Vec3 relative = relative_end(contact, x_end);
    const double depth = contact.range - contact.normal.dot(relative);
    const double force = tangent_force(normal_force_at(contact, states.depths[c]), states.depths[c], depth);
    states.depths[c] = depth_for_force(contact, force, std::max(depth, states.depths[c]));
    if (states.updates < numerics.newton.slow_after) states.normal_forces[c] = force;
    if (!contact.against_obstacle || contact.static_friction == 0) return;
    if (states.updates < numerics.newton.slow_after)
      update_friction(contact, slip_of(contact, relative) / stick_slip_, states.frictions[c]);
    else
      states.frictions[c].sticks = false;
  };
  parallel_for(states.updates > 0 ? states.depths.size() : 0, kFineGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) update_contact(c);
  });
  for (std::size_t c = states.depths.size(); c < contacts_.size(); ++c) {
    states.depths.push_back(std::max(0.0, contacts_[c].depth));
    states.normal_forces.push_back(normal_force_at(contacts_[c], states.depths.back()).force);
    states.frictions.emplace_back();
    if (states.updates > 0) continue;  // for contacts found later, the first iterate means nothing
    FrictionState& friction = states.frictions.back();
    friction.slip = slip_of(contacts_[c], relative_end(contacts_[c], x_end)) / stick_slip_;
    friction.relative_friction = friction_over_normal_force(contacts_[c], friction.slip);
  }
  ++states.updates;
}

ContactSet::Response ContactSet::respond(std::size_t index, ForceLaw law, std::span<const Vec3> x_end,
                                         const ContactStates& states) const {
  const Contact& contact = contacts_[index];
  const Vec3 relative = relative_end(contact, x_end);
  const double depth = contact.range - contact.normal.dot(relative);
  Response response;
  if (depth <= 0) return response;

  response.active = true;
  NormalForce normal_force = normal_force_at(contact, law == ForceLaw::exact ? depth : states.depths[index]);
  if (law == ForceLaw::tangent) {
    normal_force.force = tangent_force(normal_force, states.depths[index], depth);
    if (normal_force.force == 0) normal_force.slope = 0;
  }
  response.slope = normal_force.slope;
  response.force = normal_force.force * contact.normal;
  const bool follows = law == ForceLaw::exact && states.updates < numerics.newton.slow_after;
  const double friction_normal_force = follows ? normal_force.force : states.normal_forces[index];
  if (contact.static_friction == 0 || friction_normal_force == 0) return response;

  const FrictionState& friction = states.frictions[index];
  const Vec3 slip = slip_of(contact, relative) / stick_slip_;
  const bool sticks = law == ForceLaw::tangent && friction.sticks;
  response.slip = sticks ? sticking_slip(contact, friction.relative_friction) : slip;
  response.friction_per_slip = friction_normal_force / stick_slip_;
  Vec3 w = friction_over_normal_force(contact, response.slip);
  if (sticks) w += friction_slope(contact, response.slip, friction.relative_friction) * (slip - response.slip);
  response.force -= friction_normal_force * w;
  return response;
}

void ContactSet::add_forces(ForceLaw law, std::span<const Vec3> x_end, const ContactStates& states,
                            std::span<Vec3> force) const {
  struct Push {
    const Contact* contact;
    Vec3 force;
  };
  std::vector<Push> pushes;
  parallel_append(contacts_.size(), kFineGrainSize, pushes, [&](std::size_t begin, std::size_t end, auto& list) {
    for (std::size_t c = begin; c < end; ++c)
      if (const Response response = respond(c, law, x_end, states); response.active)
        list.push_back({&contacts_[c], response.force});
  });
  for (const auto& [contact, push] : pushes)
    for (int k = 0; k < 4; ++k) force[contact->particles[k]] += contact->weights[k] * push;
}

void ContactSet::add_normal_and_friction_forces(std::span<const Vec3> x_end, const ContactStates& states,
                                                std::span<Vec3> push, std::span<Vec3> friction,
                                                std::span<double> normal_force, std::span<double> limit) const {
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const Contact& contact = contacts_[c];
    const Response response = respond(c, ForceLaw::exact, x_end, states);
    if (!response.active) continue;
    const double along = contact.normal.dot(response.force);
    const Vec3 normal_part = along * contact.normal;
    const double max_friction = contact.static_friction * stick_slip_ * response.friction_per_slip;
    for (int k = 0; k < 4; ++k) {
      const Index i = contact.particles[k];
      push[i] += contact.weights[k] * normal_part;
      friction[i] += contact.weights[k] * (response.force - normal_part);
      normal_force[i] += std::abs(contact.weights[k]) * along;
      limit[i] += std::abs(contact.weights[k]) * max_friction;
    }
  }
}

void ContactSet::linearise(std::span<const Vec3> x_end, double end_rate, const ContactStates& states,
                           std::span<Vec3> force, solver::LinearSystem& system) const {
  struct Push {
    const Contact* contact;
    Vec3 force;
    Mat3 stiffness;
  };
  std::vector<Push> pushes;
  parallel_append(contacts_.size(), kFineGrainSize, pushes, [&](std::size_t begin, std::size_t end, auto& list) {
    for (std::size_t c = begin; c < end; ++c) {
      const Contact& contact = contacts_[c];
      const Response response = respond(c, ForceLaw::tangent, x_end, states);
      if (!response.active) continue;
      Mat3 stiffness = response.slope * contact.normal * contact.normal.transpose();
      if (response.friction_per_slip > 0)
        stiffness +=
            response.friction_per_slip * friction_slope(contact, response.slip, states.frictions[c].relative_friction);
      list.push_back({&contact, response.force, end_rate * stiffness});
    }
  });
  for (const auto& [contact, push, stiffness] : pushes) add_term(*contact, push, stiffness, force, system);
}

bool ContactSet::add_impacts(std::span<const Vec3> x_end, const ContactStates& states, const StepStart& start,
                             std::span<Vec3> right_side, solver::LinearSystem& system) const {
  struct Active {
    const Contact* contact;
    double fraction, force, slope;  // force along the normal [N]
  };
  std::vector<Active> active;
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const Contact& contact = contacts_[c];
    const Response response = respond(c, ForceLaw::tangent, x_end, states);
    if (response.active && response.slope > 0)
      active.push_back({&contact, impact_fraction(contact, start), contact.normal.dot(response.force), response.slope});
  }
  if (std::ranges::all_of(active, [](const Active& one) { return one.fraction == 0; })) return false;
  for (const auto& [contact, fraction, force, slope] : active) {
    const Mat3 along = contact->normal * contact->normal.transpose();
    Mat3 friction = Mat3::Zero();
    if (contact->static_friction > 0) friction = fraction * slope * (Mat3::Identity() - along);
    add_term(*contact,
             fraction / start.h * force * contact->normal + friction * tangential_jump(*contact, x_end, start),
             friction + (1 - fraction) * slope * along, right_side, system);
  }
  return true;
}

int ContactSet::count_active(std::span<const Vec3> x_end) const {
  return static_cast<int>(std::ranges::count_if(contacts_, [&](const Contact& contact) {
    return contact.normal.dot(relative_end(contact, x_end)) < contact.range;
  }));
}

}  // namespace weft::collision
