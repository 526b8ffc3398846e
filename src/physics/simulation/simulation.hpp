// Simulates a model frame by frame: positions, reports, and saved states.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "physics/model/model.hpp"
#include "physics/simulation/frame_report.hpp"

namespace weft::simulation {

/// A run warns if FrameReport::stretch_ratio rises above this value (see
/// StepLoop::measure_stretch()).
inline constexpr double kMaxStretchRatio = 1.1;

/// All particles of the cloths that are put on (see Simulation), cloth by cloth in the order of the model.
struct ParticleState {
  std::span<const Vec3> positions, velocities;  ///< [m], [m/s]
  std::span<const double> masses;               ///< [kg]
};

/// Velocities and strains of a cloth in a frame; empty until the cloth is put on.
struct ClothMotion {
  std::span<const Vec3> velocities;  ///< per particle [m/s]
  std::vector<float> strains;        ///< per particle: largest relative change of length of the threads next to it
};

/// A place where two objects touch or cross at the start, or one object touches or crosses itself.
/// `centre` and `size` are those of a box around the smaller triangle of each pair.
struct IntersectionPlace {
  std::string a, b;                            ///< names of the objects; equal: one object with itself
  std::size_t pairs = 0;                       ///< number of pairs of triangles
  Vec3 centre = Vec3::Zero();                  ///< [m]
  double size = 0;                             ///< longest side of this box [m]
  std::vector<std::array<Vec3, 3>> triangles;  ///< corners of the triangles of these pairs [m]
};

/// "12 pairs of triangles that touch or cross in 2 places: 'sheet' and 'ball' (8 pairs) around (0, 0, 1) m, ...".
std::string describe(std::span<const IntersectionPlace> places);

/// Finds the places where surfaces touch or cross at the start of the preroll, before bodies are lifted and cloth is
/// untangled. Checks each layer (model::Layer) against itself and the bodies, not against other layers. Lists the
/// places layer by layer, in each layer those with most pairs first.
std::vector<IntersectionPlace> find_start_intersections(const model::Model& model);

/// Size of the matrix of one Newton iteration, without contacts.
struct MatrixSize {
  std::size_t full_blocks = 0;       ///< 3×3 blocks, diagonal included
  std::size_t isotropic_blocks = 0;  ///< multiples of the identity, one number each
};

/// The cloths of a model form layers (model::Layer). The cloths of a layer are put on at the layer's first frame; until
/// then, they are not simulated.
class Simulation {
 public:
  /// Builds only what the model needs. At the start, lifts dynamic bodies off what they touch, and untangles cloth if
  /// the model allows it. Throws Error(scene_invalid) if surfaces still touch or cross. Checks each
  /// later layer with the bodies, but without other layers, in the same way. Also throws
  /// Error(scene_invalid) if cloth that is closed encloses no volume although the model gives it an
  /// amount of air.
  explicit Simulation(model::Model model);
  Simulation(Simulation&&) noexcept;
  virtual ~Simulation();

  /// The model, with the motions that drive() has given to bodies.
  const model::Model& model() const;
  /// Number of the current frame, negative in the preroll, and its time [s].
  int frame() const;
  double time() const;
  /// Number of changes of the state so far: simulated frames, preroll included, and successful calls of restore().
  std::uint64_t changes() const;

  /// Simulates the next frame. If a step fails, positions and velocities return to those of the
  /// current frame. Throws Error(simulation_failed) with the reason, or Error(scene_invalid) if
  /// cloth that is put on now touches other surfaces, or if cloth that is closed now encloses no
  /// volume although the model gives it an amount of air.
  FrameReport advance();

  /// The report of frame 0. If the model has a preroll: until run_preroll() simulates a frame, this is the report of
  /// the start of the preroll; if run_preroll() stops early, it is that of the last frame that run_preroll() has
  /// simulated. The report of a start has energies, enclosed air and strains, but no distances and no attachments that
  /// hold: contacts are searched and attachments tied in the first step.
  FrameReport initial_report() const;

  /// Simulates the preroll up to frame 0; without this call, advance() begins with the preroll. Calls `proceed` before
  /// each frame; if `proceed` returns false, stops before that frame and returns false. Throws as advance() does.
  bool run_preroll(const std::function<bool()>& proceed = [] { return true; });
  /// Number of particles of all cloths, including cloths that are not put on.
  std::size_t particles() const;
  MatrixSize matrix() const;
  /// Positions of the particles of all cloths [m], in the order of the model; a cloth that is not put on is at its
  /// start.
  std::vector<Vec3> particles_of_all() const;
  /// Whether all cloths are put on.
  bool all_put_on() const;
  /// Vertices of a body that forces move [m]; empty for other bodies.
  std::vector<Vec3> vertices_of(std::size_t body) const;
  /// State of the current frame, for the cloths that are put on; valid until the next advance().
  ParticleState state() const;
  /// `cloth`: number in the model. The result is valid until the next advance().
  ClothMotion motion_of(std::size_t cloth) const;
  /// Total contact force on each particle [N] at the end of the last step, per cloth; empty until the cloth is put on.
  std::vector<std::vector<Vec3>> contact_forces() const;

  /// Announces that drive() may move this rigid body (number in the model), which must have Body::may_move. Only
  /// allowed before the first advance().
  void allow_drive(std::size_t body);
  /// Moves a body that allow_drive() has announced to `end` at constant velocity during the next frame, in place of its
  /// motion in the model. The body then stays there.
  void drive(std::size_t body, const motion::Pose& end);

  /// Sets gravity [m/s²] and wind [m/s] from the next frame on, in place of those of the model and their keys. Fans
  /// stay; so do gusts, which this wind then carries. A saved state does not include these values: set them before
  /// restore(), too.
  void set_weather(const Vec3& gravity, const Vec3& wind);

  /// Appends the state that later frames depend on. Only the same version of the program on the same CPU architecture
  /// can read it. Not allowed after a failed advance().
  void save(std::string& bytes) const;
  /// Restores what a simulation of the same model has saved; the following frames have the same bits as in that
  /// simulation. Only allowed before the first advance() and drive(), and after the same calls of allow_drive(). If the
  /// bytes do not fit this model, throws std::runtime_error; the simulation is then unusable.
  void restore(std::string_view bytes);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace weft::simulation
