#include "collision/response/contact_set.hpp"

#include <algorithm>
#include <cmath>

namespace weft::collision {
namespace {

Vec3 weighted_sum(const Contact& contact, std::span<const Vec3> x) {
  Vec3 sum = contact.weights[0] * x[static_cast<std::size_t>(contact.particles[0])];
  for (int k = 1; k < 4; ++k) sum += contact.weights[k] * x[static_cast<std::size_t>(contact.particles[k])];
  return sum;
}

struct Load {
  double force, slope;  // [N], [N/m]
};

// At this gap [m]; none from the range on.
Load load_at(const Contact& contact, double gap) {
  if (gap >= contact.range) return {0, 0};
  const double depth = contact.range - gap, full = std::max(contact.full_range, contact.range);
  const double inner = std::min(depth, full), ratio_sq = (inner / full) * (inner / full);
  const double stiffening = ContactSet::kStiffening * ratio_sq * ratio_sq;
  const double slope = contact.stiffness * (1 + 5 * stiffening);
  return {contact.stiffness * inner * (1 + stiffening) + slope * (depth - inner), slope};
}

// Point a minus point b at the end of the step.
Vec3 relative_end(const Contact& contact, std::span<const Vec3> x_end) {
  return weighted_sum(contact, x_end) + contact.obstacle_end;
}

// Coefficient of friction over slip, for a slip in stick slips: 2 − s while sticking, 1/s while sliding, continuous
// with its first derivative where both coefficients are the same.
double friction_over_slip(const Contact& contact, double slip) {
  if (slip < 1) return contact.static_friction * (2 - slip);
  const double sliding = std::min(1.0, (slip - 1) / (ContactSet::kSlideSpeed - 1));
  return (contact.static_friction + sliding * (contact.friction - contact.static_friction)) / slip;
}

}  // namespace

void ContactSet::add(const Contact& contact) {
  contacts_.push_back(contact);
  contacts_.back().static_friction = std::max(contact.friction, contact.static_friction);
}

void ContactSet::update(std::span<const Vec3> x_end, FrictionLag& lag) const {
  for (std::size_t c = lag.loads.size(); c < contacts_.size(); ++c)
    lag.loads.push_back(load_at(contacts_[c], contacts_[c].normal.dot(contacts_[c].relative_start)).force);
  if (lag.updates > 0 && lag.updates < kLoadUpdates)
    for (std::size_t c = 0; c < contacts_.size(); ++c)
      lag.loads[c] = load_at(contacts_[c], contacts_[c].normal.dot(relative_end(contacts_[c], x_end))).force;
  ++lag.updates;
}

ContactSet::Response ContactSet::respond(const Contact& contact, std::span<const Vec3> x_end,
                                         double friction_load) const {
  const Vec3 relative = relative_end(contact, x_end);
  const double gap = contact.normal.dot(relative);
  Response response;
  if (gap >= contact.range) return response;

  response.active = true;
  const Load load = load_at(contact, gap);
  response.slope = load.slope;
  response.force = load.force * contact.normal;
  if (contact.static_friction > 0 && friction_load > 0) {
    Vec3 slip = relative - contact.relative_start;
    slip -= contact.normal.dot(slip) * contact.normal;
    const double size = slip.norm();
    response.sliding = friction_load * friction_over_slip(contact, size / stick_slip_) / stick_slip_;
    response.force -= response.sliding * slip;
  }
  return response;
}

void ContactSet::add_forces(std::span<const Vec3> x_end, const FrictionLag& lag, std::span<Vec3> force) const {
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const Contact& contact = contacts_[c];
    const Response response = respond(contact, x_end, lag.loads[c]);
    if (!response.active) continue;
    for (int k = 0; k < 4; ++k)
      force[static_cast<std::size_t>(contact.particles[k])] += contact.weights[k] * response.force;
  }
}

void ContactSet::linearise(std::span<const Vec3> x_end, double end_rate, const FrictionLag& lag, std::span<Vec3> force,
                           solver::LinearSystem& system) const {
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const Contact& contact = contacts_[c];
    const Response response = respond(contact, x_end, lag.loads[c]);
    if (!response.active) continue;
    int involved = 0, last = 0;
    for (int k = 0; k < 4; ++k) {
      force[static_cast<std::size_t>(contact.particles[k])] += contact.weights[k] * response.force;
      if (contact.weights[k] != 0) ++involved, last = k;
    }
    const Mat3 along = contact.normal * contact.normal.transpose();
    const Mat3 stiffness = end_rate * (response.slope * along + response.sliding * (Mat3::Identity() - along));
    if (involved == 1) {
      // A single particle on an obstacle couples with nothing.
      const double w = contact.weights[last];
      system.diagonal_terms.push_back({contact.particles[last], w * w * stiffness});
    } else {
      system.terms.push_back({contact.particles, contact.weights, stiffness});
    }
  }
}

int ContactSet::active(std::span<const Vec3> x_end) const {
  return static_cast<int>(std::ranges::count_if(contacts_, [&](const Contact& contact) {
    return contact.normal.dot(relative_end(contact, x_end)) < contact.range;
  }));
}

}  // namespace weft::collision
