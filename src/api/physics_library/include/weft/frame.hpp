// One frame of a simulation: the state of all objects, measured values, and cost.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>
#include <weft/api.hpp>

namespace weft {

using Vector = std::array<double, 3>;          ///< x, y, z in world space
using RestPoint = std::array<double, 2>;       ///< along weft and warp
using Triangle = std::array<std::int32_t, 3>;  ///< numbers of vertices, counter-clockwise seen from the front

enum class Kind { cloth, obstacle, character, rope };

/// One object in one frame. The spans are valid as long as the frame or a copy of it exists.
struct Object {
  std::string_view name;
  Kind kind = Kind::cloth;
  std::span<const Vector> positions;   ///< per vertex [m]; the vertices of a cloth are its particles
  std::span<const Vector> velocities;  ///< per particle [m/s]; empty for bodies and for cloth that is not put on yet
  /// Total contact force per particle, with friction, at the end of the last time step [N]; empty if velocities are
  /// empty. Zero at the start of a simulation and after it was restored. Contacts are stiff springs: sums over a patch
  /// are more reliable than values of single particles.
  std::span<const Vector> contact_forces;
  std::span<const float> strains;       ///< per particle: largest |length / rest length - 1|; empty if velocities are
  std::span<const RestPoint> rest;      ///< per particle: rest coordinates [m]; empty if there are none
  std::span<const Triangle> triangles;  ///< the same in all frames
};

/// Air that a cloth encloses.
struct EnclosedAir {
  std::string cloth;
  double volume = 0;    ///< [m³]
  double pressure = 0;  ///< gauge pressure, relative to the outside air [Pa]
};

/// Cost and measured values of a frame. In frame 0, the energies are those of the start.
struct Report {
  double wall_s = 0, cpu_s = 0;  ///< of simulating this frame [s]
  int steps = 0;                 ///< accepted time steps
  int rejected_steps = 0;        ///< time steps that were repeated with shorter ones
  int newton_iterations = 0;
  int linear_iterations = 0;    ///< of conjugate gradients
  int near_pairs = 0;           ///< vertex-face and edge-edge pairs within the detection distance, in the last step
  int constraints = 0;          ///< contacts that push, and held particles, in the last step
  double min_distance = 0;      ///< smallest distance of the near pairs [m]; infinite if there are none
  double max_strain = 0;        ///< largest |length / rest length - 1|, in all steps
  double stretch_ratio = 0;     ///< largest ratio of extension to the fabric's `max_stretch`, in all steps
  double kinetic_energy = 0;    ///< [J]
  double potential_energy = 0;  ///< of gravity, 0 at the origin [J]
  double elastic_energy = 0;    ///< stretch, shear, bending, attachments [J]
  double air_energy = 0;        ///< of enclosed air [J]
  double pin_work = 0;          ///< work of pins on the cloth in this frame [J]
  double error_estimate = 0;    ///< estimated sum, over the steps, of the local errors of positions [m]
  double solver_error = 0;      ///< the same sum of the errors due to the solver [m]
  int pinched_pairs = 0;        ///< largest number of pinched cloth triangles at once, each counted once per limb
  int lagging_particles = 0;    ///< largest simultaneous number of pinned particles that lag behind their targets
  std::vector<EnclosedAir> enclosed_air;  ///< of each cloth with pressure
  std::vector<std::string> warnings;
};

/// One frame. It never changes. Copies share the data of one frame, and any thread may read them.
class WEFT_API Frame {
 public:
  int number() const;            ///< counted from 0
  double time() const;           ///< [s]
  const Report& report() const;  ///< zeros in the frame at which a simulation was restored
  /// Cloths (with ropes), obstacles, characters, each in the order of the model or scene.
  std::span<const Object> objects() const;
  /// Throws std::out_of_range with the names of all objects if there is none of this name.
  const Object& object(std::string_view name) const;

  struct Data;
  /// For the library itself.
  explicit Frame(std::shared_ptr<const Data> data);
  const Data& data() const { return *data_; }

 private:
  std::shared_ptr<const Data> data_;
};

}  // namespace weft
