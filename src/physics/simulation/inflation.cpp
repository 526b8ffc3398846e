#include "physics/simulation/inflation.hpp"

#include <algorithm>
#include <cmath>

#include "core/archive.hpp"
#include "core/error.hpp"

namespace weft::simulation {
namespace {

// Smallest V / A (see the header) at which the gas law applies; below it, pressure is a linear function of V. Without
// this limit, pressure would grow without bound when a line search reaches a volume of zero. At the end of a step,
// contacts keep the volume larger.
constexpr double kMinVolumeRatio = 1e-3;

motion::Spline<1> air_track_of(const model::Pressure& pressure) {
  using Track = motion::Spline<1>;
  std::vector<double> times;
  std::vector<Track::Value> values;
  for (const model::PressureKey& key : pressure.keys) {
    times.push_back(key.time);
    values.emplace_back(key.value);
  }
  if (times.empty()) return {pressure.interpolation, {0}, {Track::Value(pressure.value)}};
  return {pressure.interpolation, std::move(times), std::move(values)};
}

}  // namespace

Inflation::Inflation(const model::Model& model, std::span<const Index> first_particle) {
  for (std::size_t c = 0; c < model.cloths.size(); ++c) {
    const model::Pressure& pressure = model.cloths[c].pressure;
    if (!pressure.has_effect()) continue;
    const model::Cloth& object = model.cloths[c];
    Cloth& cloth = cloths_.emplace_back(Cloth{object.name,
                                              object.source + ".pressure",
                                              c,
                                              first_particle[c],
                                              first_particle[c] + static_cast<Index>(object.start.size()),
                                              {object.mesh.topology.triangles, object.start},
                                              pressure.control,
                                              air_track_of(pressure)});
    cloth.gradient.resize(object.start.size());
  }
}

// Makes the volume at x [m], of all particles, the reference for amounts of air.
void Inflation::Cloth::close(std::span<const Vec3> x) {
  const double enclosed = evaluate(x);
  if (control != model::PressureControl::gauge && volume.is_flat(enclosed))
    throw Error(ExitCode::scene_invalid,
                "{}: expected cloth that encloses a volume when it is closed, for an amount of air, got {:.3g} m³; "
                "close it, or give its pressure (control = \"gauge\")",
                where, enclosed);
  closed_volume = std::max(0.0, enclosed);
}

// Amount of air, as its volume at the outside pressure [m³].
double Inflation::Cloth::air() const {
  return std::max(0.0, control == model::PressureControl::fill ? value * closed_volume : closed_volume + value);
}

// Gauge pressure [Pa].
double Inflation::Cloth::pressure(double at_volume) const {
  if (closed_volume == kOpen) return 0;
  if (control == model::PressureControl::gauge) return value;
  const double amount = air(), min_volume = kMinVolumeRatio * amount;
  if (amount == 0) return -kAmbientPressure;
  const double ratio = at_volume > min_volume ? amount / at_volume : (2 - at_volume / min_volume) / kMinVolumeRatio;
  return kAmbientPressure * (ratio - 1);
}

// −dp/dV [Pa/m³].
double Inflation::Cloth::stiffness(double at_volume) const {
  if (closed_volume == kOpen || control == model::PressureControl::gauge || air() == 0) return 0;
  const double amount = air(), v = std::max(at_volume, kMinVolumeRatio * amount);
  return kAmbientPressure * amount / (v * v);
}

// Energy [J].
double Inflation::Cloth::energy(double at_volume) const {
  if (closed_volume == kOpen) return 0;
  if (control == model::PressureControl::gauge) return -value * at_volume;
  const double amount = air(), min_volume = kMinVolumeRatio * amount;
  if (amount == 0) return kAmbientPressure * at_volume;
  const double v = std::max(at_volume, min_volume),
               beyond = at_volume - v;  // negative where pressure is linear, else 0
  return kAmbientPressure * (v - amount - amount * std::log(v / amount)) - pressure(v) * beyond +
         0.5 * stiffness(v) * beyond * beyond;
}

void Inflation::begin_step(double t, std::span<const Vec3> x, const std::function<bool(std::size_t)>& is_closed) {
  set_time(t);
  for (Cloth& cloth : cloths_) {
    if (!is_closed(cloth.number)) {
      cloth.closed_volume = kOpen;
    } else if (cloth.closed_volume == kOpen) {
      cloth.close(x);
    }
  }
}

void Inflation::set_time(double t) {
  for (Cloth& cloth : cloths_) cloth.value = cloth.track.at(t).value[0];
}

void Inflation::measure_closed_volumes(std::span<const Vec3> x, std::span<const std::size_t> kept) {
  for (Cloth& cloth : cloths_)
    if (cloth.closed_volume != kOpen && std::ranges::find(kept, cloth.number) == kept.end()) cloth.close(x);
}

bool Inflation::is_constant_between(double t0, double t1) const {
  return std::ranges::all_of(cloths_,
                             [&](const Cloth& cloth) { return cloth.track.at(t0).value == cloth.track.at(t1).value; });
}

void Inflation::add_forces(std::span<const Vec3> x, std::span<Vec3> force) const {
  for (const Cloth& cloth : cloths_) {
    const double pressure = cloth.pressure(cloth.evaluate(x));
    if (pressure == 0) continue;
    for (Index i = cloth.first; i < cloth.end; ++i) force[i] += pressure * cloth.gradient[i - cloth.first];
  }
}

void Inflation::linearise(std::span<const Vec3> x, std::span<Vec3> force, solver::LinearSystem& system) const {
  add_forces(x, force);
  system.rank_one_terms.clear();
  for (const Cloth& cloth : cloths_)
    if (const double stiffness = cloth.stiffness(cloth.evaluate(x)); stiffness > 0)
      system.rank_one_terms.push_back({cloth.first, cloth.gradient, stiffness});
}

double Inflation::energy(std::span<const Vec3> x) const {
  double sum = 0;
  for (const Cloth& cloth : cloths_) sum += cloth.energy(cloth.evaluate(x));
  return sum;
}

std::vector<EnclosedAir> Inflation::measure(std::span<const Vec3> x) const {
  std::vector<EnclosedAir> measured;
  for (const Cloth& cloth : cloths_) {
    const double volume = cloth.evaluate(x);
    measured.push_back({cloth.name, volume, cloth.pressure(volume)});
  }
  return measured;
}

void Inflation::copy_state_from(const Inflation& there, std::span<const std::size_t> numbers) {
  for (const Cloth& before : there.cloths_)
    for (Cloth& cloth : cloths_)
      if (cloth.number == numbers[before.number])
        cloth.closed_volume = before.closed_volume, cloth.value = before.value;
}

template <class Archive>
void Inflation::serialize(Archive& archive) {
  for (Cloth& cloth : cloths_) {
    serialize_values(archive, cloth.value, cloth.closed_volume);
    if constexpr (Archive::kReads)
      require(std::isfinite(cloth.value) && (cloth.closed_volume == kOpen || cloth.closed_volume >= 0), "enclosed air");
  }
}

template void Inflation::serialize(ByteWriter&);
template void Inflation::serialize(ByteReader&);

}  // namespace weft::simulation
