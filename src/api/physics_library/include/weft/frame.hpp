// One frame of a simulation: the state of all objects, quantities measured in the frame, and the cost of computing it.
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
using RestPoint = std::array<double, 2>;       ///< rest coordinates along weft and warp [m]
using Triangle = std::array<std::int32_t, 3>;  ///< indices of vertices, counter-clockwise seen from the front

enum class Kind { cloth, obstacle, character, rope };

/// One object in one frame. `name` and the spans are valid as long as the frame or a copy of it exists.
struct Object {
  std::string_view name;
  Kind kind = Kind::cloth;
  std::span<const Vector> positions;   ///< per vertex [m]; the vertices of a cloth are its particles
  std::span<const Vector> velocities;  ///< per particle [m/s]; empty for bodies
  /// Total contact force on each particle, friction included, at the end of the last time step [N];
  /// empty for bodies. Zero before the first time step, and in the frame at which a simulation was
  /// restored. Contacts are stiff springs, so sums over several particles are more accurate than
  /// values of single ones.
  std::span<const Vector> contact_forces;
  /// Per particle, the largest |length / rest length - 1| of the threads at it; empty for bodies.
  std::span<const float> strains;
  std::span<const RestPoint> rest;      ///< per particle: rest coordinates [m]; empty for bodies
  std::span<const Triangle> triangles;  ///< the same in all frames; of a rope: (a, b, b) for each
                                        ///< piece, from particle a to particle b
};

/// Air that a cloth encloses.
struct EnclosedAir {
  std::string cloth;
  double volume = 0;    ///< [m³]
  double pressure = 0;  ///< gauge pressure, relative to the outside air [Pa]
};

/// Cost of computing a frame, and quantities measured in it. The report of frame 0 is that of the
/// last frame of the preroll. Without a preroll, it has the energies, enclosed air and strains at the
/// start, but no time steps and no distances.
struct Report {
  double wall_s = 0, cpu_s = 0;  ///< time of simulating this frame: wall time, and CPU time of the
                                 ///< calling thread alone [s]
  int steps = 0;                 ///< number of accepted time steps
  int rejected_steps = 0;        ///< number of time steps that were rejected and repeated as shorter ones
  int newton_iterations = 0;
  int linear_iterations = 0;    ///< iterations of conjugate gradients
  int near_pairs = 0;           ///< vertex-face and edge-edge pairs within the detection distance, in the last step
  int constraints = 0;          ///< number of contacts with a force, plus number of held particles, in the last step
  double min_distance = 0;      ///< smallest distance of the near pairs [m]; infinite if there are none
  double max_strain = 0;        ///< largest |length / rest length - 1| of threads at the end of any step
  double stretch_ratio = 0;     ///< largest ratio of extension to the fabric's `max_stretch` at the end of any step
  double kinetic_energy = 0;    ///< [J]
  double potential_energy = 0;  ///< of gravity, 0 at the origin [J]
  double elastic_energy = 0;    ///< of stretch, shear, bending, seams, attachments and bodies with a mass [J]
  double air_energy = 0;        ///< of enclosed air [J]
  double pin_work = 0;          ///< work of pins on the cloth in this frame [J]
  double error_estimate = 0;    ///< sum, over the steps, of the estimated local errors of positions [m]
  double solver_error = 0;      ///< sum, over the steps, of the estimated position errors due to the solver [m]
  /// Largest number, in any step, of pinched triangles of cloth (triangles to which obstacles leave
  /// no space). A triangle that several limbs of a character pinch counts once per limb.
  int pinched_pairs = 0;
  int lagging_particles = 0;              ///< largest number, in any step, of pinned particles that an obstacle
                                          ///< or cloth keeps from their targets
  std::vector<EnclosedAir> enclosed_air;  ///< one per cloth with pressure
  std::vector<std::string> warnings;
};

/// One frame. A Frame never changes. Copies share the data, and any thread may read a Frame.
class WEFT_API Frame {
 public:
  int number() const;            ///< counted from 0
  double time() const;           ///< [s]
  const Report& report() const;  ///< all zero and empty in the frame at which a simulation was restored
  /// Cloths and ropes, then obstacles, then characters; each kind in the order of the model or scene.
  std::span<const Object> objects() const;
  /// The object with this name. If there is none, throws std::out_of_range with the names of all objects.
  const Object& object(std::string_view name) const;

  struct Data;
  /// For the library itself.
  explicit Frame(std::shared_ptr<const Data> data);
  const Data& data() const { return *data_; }

 private:
  std::shared_ptr<const Data> data_;
};

}  // namespace weft
