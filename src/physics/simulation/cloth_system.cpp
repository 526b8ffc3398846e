#include "physics/simulation/cloth_system.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/archive.hpp"
#include "core/numerics.hpp"
#include "core/parallel.hpp"
#include "physics/forces/air.hpp"
#include "physics/forces/bend.hpp"
#include "physics/forces/crossed_membrane.hpp"
#include "physics/forces/rigidity.hpp"
#include "physics/forces/rope_force.hpp"
#include "physics/forces/shear.hpp"
#include "physics/forces/stretch.hpp"
#include "physics/forces/stretch_limit.hpp"
#include "physics/forces/triangle_bend.hpp"

namespace weft::simulation {
namespace {

// Minimum number of particles in a range, if its part is divided.
constexpr Index kMinRangeSize = 512;
// Maximum number of ranges per part and thread; several per thread balance the load.
constexpr Index kMaxRangesPerThread = 2;

bool has_drag(const model::Material& m, const model::Physics& physics) {
  return physics.air_density > 0 && m.drag > 0;
}
forces::StretchParameters stretch_of(const model::Material& m) {
  return {m.stretch_weft, m.stretch_warp, m.stretch_viscosity};
}
forces::ShearParameters shear_of(const model::Material& m) {
  return {m.shear, m.shear_viscosity};
}
forces::BendParameters bend_of(const model::Material& m) {
  return {m.bend, m.bend_viscosity, m.bend_friction};
}
forces::AirParameters air_of(const model::Material& m, const model::Physics& physics) {
  return {physics.air_density, physics.wind, m.drag};
}

// Sine of the shear angle at which the threads lock; infinite if they never do.
double max_shear_sine(const model::Material& m) {
  return m.max_shear > 0 ? std::sin(m.max_shear * std::numbers::pi / 180) : std::numeric_limits<double>::infinity();
}
double max_extension(const model::Material& m) {
  return m.max_stretch > 0 ? m.max_stretch : std::numeric_limits<double>::infinity();
}

// Progress of sewing as a function of the elapsed fraction of its duration; the slope is zero at both ends.
double ease(double s) {
  s = std::clamp(s, 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

}  // namespace

ClothSystem::ClothSystem(const model::Model& model) : gravity_(model.physics.gravity), begin_(model.start_time()) {
  Index first = 0;
  forces_.resize(model.cloths.size());
  for (std::size_t c = 0; c < model.cloths.size(); ++c) {
    const model::Cloth& cloth = model.cloths[c];
    first_.push_back(first);
    const double density = cloth.material.density;
    const auto masses = cloth.rope ? forces::lumped_masses(cloth.rope->lengths, cloth.rope->closed, cloth.rope->mass)
                        : cloth.sheet.triangles.empty() ? forces::lumped_masses(cloth.grid, density)
                                                        : forces::lumped_masses(cloth.sheet, density);
    masses_.insert(masses_.end(), masses.begin(), masses.end());
    for (const model::Weight& weight : cloth.weights) {
      double fraction_sum = 0;
      for (const model::WeightedParticle& carrier : weight.particles) fraction_sum += carrier.fraction;
      for (const model::WeightedParticle& carrier : weight.particles)
        masses_[first + carrier.particle] += weight.mass * (carrier.fraction / fraction_sum);
    }
    held_.resize(masses_.size());
    for (const model::Pin& pin : cloth.pins)
      for (const model::WeightedParticle& chosen : pin.particles)
        if (!pin.strength) held_[first + chosen.particle] = 1;
    if (cloth.rope)
      add_rope_forces(c, *cloth.rope, model.physics);
    else if (cloth.sheet.triangles.empty())
      add_quad_forces(c, cloth, model.physics);
    else
      add_triangle_forces(c, cloth, model.physics);
    spacing_ = std::min(spacing_, cloth.spacing);
    first += static_cast<Index>(masses.size());
  }
  first_.push_back(first);
  inflation_ = Inflation(model, first_);
  add_frames(model);
  build_aggregates(model);

  const solver::Assembly assembly(lay_out_matrix());
  for (const auto& of_part : forces_)
    for (const auto& force : of_part) force->attach(assembly);
  divide_into_ranges();
  for (const auto& of_part : forces_)
    for (const auto& force : of_part) force->set_held(held_);
  update_rest_shapes(0);
}

void ClothSystem::add_frames(const model::Model& model) {
  const double stiffness = numerics.bodies.rigidity / (model.time.step * model.time.step);
  for (const model::Body& body : model.bodies) {
    if (!body.dynamics) continue;
    const auto& [frame, mass, velocity, turn, release] = *body.dynamics;
    forces_.emplace_back().push_back(std::make_unique<forces::Rigidity>(frame, first_.back(), mass, stiffness));
    masses_.insert(masses_.end(), mesh::RigidFrame::kParticles, mass / mesh::RigidFrame::kParticles);
    held_.resize(masses_.size());
    first_.push_back(static_cast<Index>(masses_.size()));
  }
}

std::vector<Index> ClothSystem::first_of_frames(const model::Model& model) const {
  std::vector<Index> first;
  std::size_t part = cloths();
  for (const model::Body& body : model.bodies) first.push_back(body.dynamics ? first_[part++] : -1);
  return first;
}

solver::BlockMatrix ClothSystem::lay_out_matrix() const {
  solver::BlockMatrix::Couplings couplings, isotropic;
  for (const auto& of_part : forces_)
    for (const auto& force : of_part) force->append_couplings(force->isotropic() ? isotropic : couplings);
  return {first_.back(), std::move(couplings), std::move(isotropic)};
}

solver::LinearSystem ClothSystem::make_linear_system() const {
  solver::LinearSystem system;
  system.matrix = lay_out_matrix();
  system.aggregate_levels = aggregate_levels_;
  for (std::size_t p = 0; p < parts(); ++p)
    system.blocks.push_back({.begin = first_[p], .end = first_[p + 1], .is_small = p >= cloths()});
  return system;
}

void ClothSystem::add_quad_forces(std::size_t cloth, const model::Cloth& of, const model::Physics& physics) {
  const mesh::Grid& grid = of.grid;
  const model::Material& material = of.material;
  const Index first = first_[cloth];
  auto stretch = std::make_unique<forces::Stretch>(grid, first, stretch_of(material));
  membranes_.push_back(stretch.get());
  forces_[cloth].push_back(std::move(stretch));
  if (material.shear > 0 || material.shear_viscosity > 0)
    forces_[cloth].push_back(std::make_unique<forces::Shear>(grid, first, shear_of(material)));
  if (material.has_strain_limit())
    add_limit(cloth, std::make_unique<forces::StretchLimit>(grid, first, stretch_of(material), max_extension(material),
                                                            max_shear_sine(material)));
  if (material.resists_bending())
    forces_[cloth].push_back(std::make_unique<forces::Bend>(grid, first, bend_of(material)));
  if (has_drag(material, physics))
    forces_[cloth].push_back(std::make_unique<forces::Air>(grid, first, air_of(material, physics)));
}

void ClothSystem::add_rope_forces(std::size_t cloth, const model::Rope& rope, const model::Physics& physics) {
  auto force =
      std::make_unique<forces::RopeForce>(rope.lengths, rope.closed, first_[cloth],
                                          forces::RopeForceParameters{.stretch = rope.stretch,
                                                                      .stretch_viscosity = rope.damping * rope.stretch,
                                                                      .bend = rope.bend,
                                                                      .bend_viscosity = rope.damping * rope.bend,
                                                                      .air_density = physics.air_density,
                                                                      .wind = physics.wind,
                                                                      .drag = rope.drag,
                                                                      .diameter = rope.diameter});
  if (!rope.keys.empty()) {
    std::vector<double> times;
    std::vector<motion::Spline<1>::Value> values;
    for (const model::RopeKey& key : rope.keys) {
      times.push_back(key.time);
      values.emplace_back(key.length);
    }
    keyed_ropes_.push_back({force.get(),
                            std::accumulate(rope.lengths.begin(), rope.lengths.end(), 0.0),
                            {rope.interpolation, std::move(times), std::move(values)}});
  }
  membranes_.push_back(force.get());
  forces_[cloth].push_back(std::move(force));
}

void ClothSystem::add_limit(std::size_t cloth, std::unique_ptr<forces::StretchLimit> limit) {
  if (!std::isinf(limit->limit())) limits_.emplace_back(cloth, limit.get());
  forces_[cloth].push_back(std::move(limit));
}

void ClothSystem::add_triangle_forces(std::size_t cloth, const model::Cloth& of, const model::Physics& physics) {
  const mesh::Sheet& sheet = of.sheet;
  const model::Material& material = of.material;
  const Index first = first_[cloth];
  std::unique_ptr<forces::TriangleMembrane> membrane;
  if (of.crossed && material.resists_bending())  // membrane locking matters only with bending stiffness
    membrane = std::make_unique<forces::CrossedMembrane>(sheet, first, stretch_of(material), shear_of(material));
  else
    membrane = std::make_unique<forces::TriangleMembrane>(sheet, first, stretch_of(material), shear_of(material));
  membranes_.push_back(membrane.get());
  if (sheet.sewn) sewing_.push_back({cloth, of.put_on, of.sewing, -1, membrane.get(), nullptr, nullptr, nullptr});
  if (material.has_strain_limit()) {
    auto limit = std::make_unique<forces::StretchLimit>(*membrane, stretch_of(material), max_extension(material),
                                                        max_shear_sine(material));
    if (sheet.sewn) sewing_.back().limit = limit.get();
    add_limit(cloth, std::move(limit));
  }
  forces_[cloth].push_back(std::move(membrane));
  if (!sheet.bands.empty()) {
    auto bands = std::make_unique<forces::Bands>(sheet, first, 0.5 * (material.stretch_weft + material.stretch_warp));
    if (sheet.sewn) sewing_.back().bands = bands.get();
    forces_[cloth].push_back(std::move(bands));
  }
  if (!sheet.ties.empty()) {
    auto ties = std::make_unique<forces::Ties>(sheet, first, model::kSameTime);
    sewing_.back().ties = ties.get();
    for (const std::string& seam : sheet.tearing_seams) sewing_.back().tearing_seams.push_back(of.name + ": " + seam);
    forces_[cloth].push_back(std::move(ties));
  }
  if (material.resists_bending())
    forces_[cloth].push_back(std::make_unique<forces::TriangleBend>(sheet, first, bend_of(material), held_));
  if (has_drag(material, physics))
    forces_[cloth].push_back(std::make_unique<forces::Air>(sheet, first, air_of(material, physics)));
}

// Divides each part into ranges that threads evaluate in parallel. If a part has more ranges than there are threads,
// the number of its ranges is a multiple of the number of threads. Each range evaluates all forces on its particles, so
// a force between particles of two ranges is evaluated in both.
void ClothSystem::divide_into_ranges() {
  const Index threads = thread_count();
  for (std::size_t c = 0; c < parts(); ++c) {
    const Index first = first_[c], count = first_[c + 1] - first;
    Index range_count = threads == 1 ? 1 : std::clamp<Index>(count / kMinRangeSize, 1, kMaxRangesPerThread * threads);
    if (range_count > threads) range_count -= range_count % threads;
    if (range_count == 1) {
      ranges_.push_back({c, first, first + count, forces::Evaluation::kAll});
      continue;
    }
    std::vector<Index> bounds;
    for (Index r = 0; r <= range_count; ++r)
      bounds.push_back(first + static_cast<Index>(std::int64_t{count} * r / range_count));
    for (Index r = 0; r < range_count; ++r)
      ranges_.push_back({c, bounds[r], bounds[r + 1], static_cast<std::size_t>(r)});
    for (const auto& force : forces_[c]) force->partition(bounds);
  }
}

std::size_t ClothSystem::largest_range_count() const {
  std::size_t count = 0;
  for (std::size_t c = 0; c < parts(); ++c)
    count += static_cast<std::size_t>(std::max<Index>(1, (first_[c + 1] - first_[c]) / kMinRangeSize));
  return count;
}

double ClothSystem::Sewing::progress_at(double t) const {
  return duration > 0 ? ease((t - begin) / duration) : 1;
}

void ClothSystem::Sewing::set_progress(double new_progress) {
  progress = new_progress;
  membrane->interpolate_rest_shape(progress);
  if (limit != nullptr) limit->copy_rest_shape(*membrane);
  if (bands != nullptr) bands->interpolate_rest_shape(progress);
}

bool ClothSystem::is_constant_between(double t0, double t1) const {
  return inflation_.is_constant_between(t0, t1) &&
         std::ranges::all_of(
             keyed_ropes_,
             [&](const KeyedRope& rope) { return rope.lengths.at(t0).value == rope.lengths.at(t1).value; }) &&
         std::ranges::all_of(sewing_, [&](const Sewing& sewing) {
           return sewing.progress_at(t0 - begin_) == sewing.progress_at(t1 - begin_) &&
                  !sewing.membrane->is_catching_up() &&
                  (sewing.ties == nullptr || sewing.ties->are_constant_between(t0, t1));
         });
}

bool ClothSystem::update_rest_shapes(double t) {
  set_rest_time(t);
  return std::exchange(constant_changed_, false);
}

void ClothSystem::finish_step(double t) {
  set_rest_time(t);
  inflation_.set_time(begin_ + t);
}

// Updates rope lengths, rest shapes and ties to time t [s since the start of the run].
void ClothSystem::set_rest_time(double t) {
  for (const KeyedRope& rope : keyed_ropes_)
    constant_changed_ |= rope.force->set_length_ratio(rope.lengths.at(begin_ + t).value[0] / rope.length);
  for (Sewing& sewing : sewing_) {
    const double progress = sewing.progress_at(t);
    if (sewing.ties != nullptr) {
      sewing.time = t;
      sewing.ties->set_strengths(begin_ + t, progress);
    }
    if (progress != sewing.progress) sewing.set_progress(progress);
  }
}

void ClothSystem::update_enclosed_air(double t, std::span<const Vec3> x) {
  if (inflation_.empty()) return;
  inflation_.begin_step(begin_ + t, x, [&](std::size_t cloth) {
    return std::ranges::none_of(sewing_,
                                [&](const Sewing& sewing) { return sewing.cloth == cloth && sewing.progress < 1; });
  });
}

bool ClothSystem::set_held_particles(std::span<const integrator::HeldParticle> pinned) {
  std::vector<char> held(held_.size());
  for (const integrator::HeldParticle& particle : pinned) held[particle.constraint.particle] = 1;
  if (held == held_) return false;
  held_ = std::move(held);
  for (const auto& of_part : forces_)
    for (const auto& force : of_part) force->set_held(held_);
  return true;
}

std::vector<ClothSystem::Widening> ClothSystem::accept(std::span<const Vec3> x, double h) {
  std::vector<Widening> widened;
  for (Sewing& sewing : sewing_) {
    if (!sewing.tearing_seams.empty()) sewing.ties->accept(x);
    if (sewing.limit == nullptr) continue;
    const bool catches_up = sewing.membrane->is_catching_up();
    const double elapsed = sewing.duration > 0 ? h / sewing.duration : 1;
    const bool ends = sewing.membrane->accept_rest_shape(x, sewing.limit->onset(), elapsed);
    // From now on, rest shapes follow from the saved lags alone, so that a resumed run has the same bits.
    if (ends || catches_up) sewing.set_progress(1);
    if (!ends) continue;
    const auto [fraction, particle] = sewing.membrane->widening();
    if (fraction > 0) widened.push_back({sewing.cloth, fraction, x[particle]});
  }
  return widened;
}

std::vector<AttachmentLoad> ClothSystem::measure_seams(std::span<const Vec3> x) const {
  std::vector<AttachmentLoad> loads;
  for (const Sewing& sewing : sewing_) {
    if (sewing.tearing_seams.empty()) continue;
    const auto seams = sewing.ties->measure_seams(x);
    for (std::size_t s = 0; s < seams.size(); ++s)
      loads.push_back({sewing.tearing_seams[s], seams[s].load, seams[s].is_closed});
  }
  return loads;
}

void ClothSystem::copy_sewing_from(const ClothSystem& there, std::span<const std::size_t> cloths) {
  for (const Sewing& before : there.sewing_) {
    Sewing& sewing = *std::ranges::find(sewing_, cloths[before.cloth], &Sewing::cloth);
    sewing.membrane->copy_rest_state(*before.membrane);
    sewing.set_progress(before.progress);
    if (!before.tearing_seams.empty()) sewing.ties->copy_state_from(*before.ties);
  }
}

template <class Archive>
void ClothSystem::serialize(Archive& archive) {
  for (const KeyedRope& rope : keyed_ropes_) {
    double ratio = rope.force->length_ratio();
    archive.value(ratio);
    if constexpr (!Archive::kReads) continue;
    require(std::isfinite(ratio) && ratio > 0, "a length of a rope");
    constant_changed_ |= rope.force->set_length_ratio(ratio);
  }
  for (Sewing& sewing : sewing_) {
    archive.value(sewing.progress);
    if (sewing.ties != nullptr) archive.value(sewing.time);
    if (sewing.ties != nullptr) sewing.ties->serialize(archive);
    sewing.membrane->serialize_rest_shape(archive, sewing.progress);
    if constexpr (!Archive::kReads) continue;
    require(sewing.progress >= 0 && sewing.progress <= 1, "a progress of sewing");
    sewing.set_progress(sewing.progress);
    if (sewing.ties != nullptr) sewing.ties->set_strengths(begin_ + sewing.time, sewing.progress);
  }
  inflation_.serialize(archive);
}

template void ClothSystem::serialize(ByteWriter&);
template void ClothSystem::serialize(ByteReader&);

void ClothSystem::cancel_weight_of_sewn_cloth(std::span<Vec3> force) const {
  for (const Sewing& sewing : sewing_) {
    if (sewing.progress == 1) continue;
    const auto end = static_cast<std::size_t>(first_[sewing.cloth + 1]);
    for (auto i = static_cast<std::size_t>(first_[sewing.cloth]); i < end; ++i) force[i] -= masses_[i] * gravity_;
  }
}

void ClothSystem::add_forces(std::size_t part, const forces::Evaluation& at) const {
  for (const auto& force : forces_[part]) force->add(at);
}

void ClothSystem::begin_locks(std::span<const Vec3> x, LockLinearisations& linearisations) const {
  linearisations.resize(cloths());
  for (const auto& [cloth, limit] : limits_) limit->begin(x, linearisations[cloth]);
}

void ClothSystem::update_locks(std::span<const Vec3> x, bool first, LockLinearisations& linearisations) const {
  for (const auto& [cloth, limit] : limits_) limit->update(x, first, linearisations[cloth]);
}

void ClothSystem::add_lock_differences(std::span<const Vec3> x, const LockLinearisations& linearisations,
                                       std::span<Vec3> force) const {
  for (const auto& [cloth, limit] : limits_) limit->add_linearisation_difference(x, linearisations[cloth], force);
}

void ClothSystem::fill_constant(double rate, solver::Assembly& assembly) const {
  assembly.clear();
  for (std::size_t i = 0; i < masses_.size(); ++i)
    assembly.add_constant_to_own(static_cast<Index>(i), rate * rate * masses_[i]);
  for (const auto& of_part : forces_)
    for (const auto& force : of_part) force->add_constant_stiffness(assembly);
  assembly.keep_constant();
}

double ClothSystem::elastic_energy(std::span<const Vec3> x) const {
  double sum = 0;
  for (const auto& of_part : forces_)
    sum += parallel_sum(of_part.size(), 1, [&](std::size_t f, std::size_t) { return of_part[f]->energy(x); });
  return sum;
}

double ClothSystem::potential_energy(std::span<const Vec3> x, const Vec3& gravity) const {
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sum -= masses_[i] * gravity.dot(x[i]);
  return sum;
}

double ClothSystem::kinetic_energy(std::span<const Vec3> v) const {
  double sum = 0;
  for (std::size_t i = 0; i < v.size(); ++i) sum += 0.5 * masses_[i] * v[i].squaredNorm();
  return sum;
}

double ClothSystem::max_strain(std::span<const Vec3> x) const {
  double largest = 0;
  for (const forces::Membrane* membrane : membranes_) largest = std::max(largest, membrane->max_strain(x));
  return largest;
}

std::vector<ClothSystem::Overstretch> ClothSystem::overstretch(std::span<const Vec3> x) const {
  std::vector<Overstretch> of_cloths;
  for (const auto& [cloth, limit] : limits_) {
    const forces::StretchLimit::Worst worst = limit->worst(x);
    of_cloths.push_back({cloth, worst.extension / limit->limit(), worst.extension, worst.place});
  }
  return of_cloths;
}

std::vector<float> ClothSystem::strain_per_particle(std::size_t cloth, std::span<const Vec3> x) const {
  std::vector<float> heat(static_cast<std::size_t>(first_[cloth + 1] - first_[cloth]));
  membranes_[cloth]->strain_per_particle(x, heat);
  return heat;
}

}  // namespace weft::simulation
