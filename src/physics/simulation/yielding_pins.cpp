#include "physics/simulation/yielding_pins.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/archive.hpp"
#include "core/numerics.hpp"

namespace weft::simulation {
namespace {

// Distance from its target within which a lagging particle is held again [m]. If the target moves fast, begin_step()
// uses a larger distance.
double arrived_distance() {
  return 0.5 * numerics.separation.restored_gap;
}

// The pin as the scene names it, such as cloth.flag.pin.0.
std::string name_of(const model::Model& model, const Pins::Info& pin) {
  const model::Cloth& cloth = model.cloths[pin.cloth];
  return fmt::format("{}.{}.pin.{}", cloth.rope ? "rope" : "cloth", cloth.name, pin.number);
}

}  // namespace

YieldingPins::YieldingPins(const model::Model& model, const std::vector<Index>& first_particle,
                           std::span<const double> masses)
    : pins_(model, first_particle),
      model_(model),
      first_particle_(first_particle),
      masses_(masses),
      lagged_(masses.size(), 0),
      lags_(masses.size(), 0),
      released_(masses.size(), 0),
      lagging_particles_(pins_.size(), 0) {
  for (std::size_t pin = 0; pin < pins_.size(); ++pin)
    needs_middle_ |= pins_.info(pin).strength && model.time.integrator == integrator::Method::implicit_midpoint;
  update_gravity();
}

void YieldingPins::update_gravity() {
  const double gravity = model_.physics.largest_gravity();
  pull_force_.clear();
  for (std::size_t pin = 0; pin < pins_.size(); ++pin) {
    const std::size_t cloth = pins_.info(pin).cloth;
    const auto begin = static_cast<std::size_t>(first_particle_[cloth]);
    const std::size_t count = model_.cloths[cloth].start.size();
    double weight = 0;
    for (std::size_t i = begin; i < begin + count; ++i) weight += masses_[i] * gravity;
    pull_force_.push_back(numerics.pins.cloth_weight_factor * weight);
  }
}

void YieldingPins::begin_step(double t, double h, std::span<const Vec3> x) {
  if (t != step_start_ || h != step_length_) {
    std::ranges::fill(released_, std::uint8_t{0});
    obstructions_.clear();
  }
  step_start_ = t;
  step_length_ = h;
  pins_.held_at(t + h, model_, targets_);
  if (needs_middle_) pins_.held_at(t + h, t + 0.5 * h, model_, middles_);
  const bool any_lagged = std::ranges::any_of(lagged_, [](std::uint8_t lags) { return lags != 0; });
  if (any_lagged) pins_.held_at(t, model_, at_start_);
  std::ranges::fill(lags_, std::uint8_t{0});
  // Particles at their targets are held again. The targets are those at t: `targets_` lacks particles whose pin is
  // released before t + h.
  if (any_lagged)
    for (const integrator::HeldParticle& start : at_start_) {
      const auto i = static_cast<std::size_t>(start.constraint.particle);
      const double near = std::max(arrived_distance(), h * std::min(start.v_end.norm(), numerics.pins.return_velocity));
      lags_[i] = lagged_[i] != 0 && (x[i] - start.x_end).norm() > near;
    }
  held_.clear();
  pulls_.clear();
  std::ranges::fill(lagging_particles_, std::size_t{0});
  for (const integrator::HeldParticle& target : targets_) {
    const auto i = static_cast<std::size_t>(target.constraint.particle);
    const std::size_t pin = pin_of(target.constraint.particle);
    // A particle that lags until its pin is released may then belong to a pin with a strength, whose spring pulls it.
    lags_[i] = !pins_.info(pin).strength && (lags_[i] != 0 || released_[i] != 0);
    lagging_particles_[pin] += lags_[i];
  }
  for (std::size_t k = 0; k < targets_.size(); ++k) {
    const integrator::HeldParticle& target = targets_[k];
    const auto i = static_cast<std::size_t>(target.constraint.particle);
    if (lags_[i] != 0 || pins_.info(pin_of(target.constraint.particle)).strength)
      pull(target, needs_middle_ ? middles_[k] : target, h, x);
    else
      held_.push_back(target);
  }
}

bool YieldingPins::are_constant_between(double t0, double t1) {
  if (std::ranges::any_of(lagged_, [](std::uint8_t lags) { return lags != 0; })) return false;
  pins_.held_at(t0, model_, at_start_);
  pins_.held_at(t1, model_, targets_);
  return std::ranges::equal(at_start_, targets_, [](const auto& start, const auto& target) {
    return start.constraint.particle == target.constraint.particle && start.x_end == target.x_end;
  });
}

// Appends the pull on a particle. `target`, `middle`: at the end and in the middle of the step. A pin with a strength
// is a critically damped spring. A lagging particle gets a damper: the force falls linearly from its maximum on a
// particle at rest to zero at the velocity `speed`. An opposing force below the maximum slows the particle but does not
// stop it.
void YieldingPins::pull(const integrator::HeldParticle& target, const integrator::HeldParticle& middle, double h,
                        std::span<const Vec3> x) {
  const Index particle = target.constraint.particle;
  const auto i = static_cast<std::size_t>(particle);
  const std::size_t pin = pin_of(particle);
  if (const auto& pin_strength = pins_.info(pin).strength) {
    const double strength = *pin_strength * strength_fraction(particle);
    pulls_.push_back({particle, target.x_end, target.v_end, strength, 2 * std::sqrt(strength * masses_[i]),
                      middle.x_end, middle.v_end});
    return;
  }
  Vec3 speed = (target.x_end - h * target.v_end - x[i]) / h;
  if (const double size = speed.norm(); size > numerics.pins.return_velocity)
    speed *= numerics.pins.return_velocity / size;
  speed += target.v_end;
  const double max_force =
      std::max({pull_force_[pin] / static_cast<double>(std::max<std::size_t>(pins_.info(pin).particles, 1)),
                std::min(pull_force_[pin] / static_cast<double>(lagging_particles_[pin]),
                         numerics.pins.most_acceleration * masses_[i]),
                numerics.pins.acceleration * masses_[i]});
  const double damping = max_force / std::max(numerics.newton.min_visible_velocity(), speed.norm());
  pulls_.push_back({particle, x[i], speed, 0, damping, x[i], speed});
}

void YieldingPins::release_particle(Index particle, const std::string& obstruction) {
  released_[static_cast<std::size_t>(particle)] = 1;
  obstructions_.emplace(pin_of(particle), obstruction);
}

void YieldingPins::accept() {
  int count = 0;
  for (const integrator::HeldParticle& target : targets_) {
    const Index particle = target.constraint.particle;
    if (lags_[static_cast<std::size_t>(particle)] == 0) continue;
    ++count;
    const std::size_t pin = pin_of(particle);
    if (!lagging_.insert(pin).second || lagging_before_.contains(pin)) continue;
    const auto obstruction = obstructions_.find(pin);
    lag_report_.messages.push_back(
        name_of(model_, pins_.info(pin)) +
        (obstruction == obstructions_.end()
             ? ": takes over particles that lag behind another pin, and pulls them to their places"
             : fmt::format(": yields to {}, and lags behind until the way is free", obstruction->second)));
  }
  lag_report_.particles = std::max(lag_report_.particles, count);
  std::swap(lagged_, lags_);
  std::ranges::fill(released_, std::uint8_t{0});
  obstructions_.clear();
}

YieldingPins::LagReport YieldingPins::take_lag_report() {
  for (std::size_t pin : lagging_before_) {
    const auto is_of_pin = [&](const auto& target) { return pin_of(target.constraint.particle) == pin; };
    const bool holds = std::ranges::any_of(targets_, is_of_pin);  // else it was released meanwhile
    if (lagging_.contains(pin) || !holds) continue;
    lag_report_.messages.push_back(fmt::format("{}: is at its target again", name_of(model_, pins_.info(pin))));
  }
  lagging_before_ = std::move(lagging_);
  lagging_.clear();
  return std::exchange(lag_report_, {});
}

void YieldingPins::copy_state_from(const YieldingPins& there, Index first_there, Index first, Index count) {
  std::copy_n(there.lagged_.begin() + first_there, count, lagged_.begin() + first);
  if (there.lagging_before_.empty()) return;
  for (Index i = 0; i < count; ++i)
    if (strength_fraction(first + i) > 0 && there.lagging_before_.contains(there.pin_of(first_there + i)))
      lagging_before_.insert(pin_of(first + i));
}

template <class Archive>
void YieldingPins::serialize(Archive& archive) {
  if (pins_.empty()) return;
  for (std::uint8_t& lags : lagged_) archive.value(lags);
  std::vector<std::uint64_t> before(lagging_before_.begin(), lagging_before_.end());
  serialize_plain(archive, before);
  if constexpr (Archive::kReads)
    require(std::ranges::all_of(before, [&](std::uint64_t pin) { return pin < pins_.size(); }), "pins of the model");
  if constexpr (!Archive::kReads) return;
  lagging_before_ = {before.begin(), before.end()};
  // Discards what belongs to a frame that has not ended.
  lagging_.clear();
  lag_report_ = {};
  std::ranges::fill(released_, std::uint8_t{0});
  obstructions_.clear();
}

template void YieldingPins::serialize(ByteWriter&);
template void YieldingPins::serialize(ByteReader&);

}  // namespace weft::simulation
