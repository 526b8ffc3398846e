// Buttons, pegs and tacks: springs from particles of a cloth to another cloth or to a body.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "environment/environment.hpp"
#include "frame/frame_report.hpp"
#include "scene/scene.hpp"
#include "solver/linear_system.hpp"

namespace weft::simulation {

/// An attachment ties each of its particles, when it begins, to the nearest place on its target: a point of a triangle
/// that moves with the corners. A spring pulls with k (l − L) while the distance l of the two exceeds L, the distance
/// at that time or the `length` of the scene. Nearer than that nothing acts: contact keeps surfaces apart. A place on a
/// body that forces move is a weighted sum of the four particles of its frame.
///
/// The springs act at the end of the step, as contacts do.
class Attachments {
 public:
  /// `first_particle`: of each cloth; `first_of_frames`: of each body, −1 for those that forces do not move.
  Attachments(const scene::Scene& scene, const environment::Environment& environment,
              std::span<const Index> first_particle, std::span<const Index> first_of_frames);

  bool empty() const { return attachments_.empty(); }

  /// For a step from t0 to t1 [s of the scene] that starts at x [m]: which attachments hold in it, and where bodies are
  /// at its end.
  void begin_step(double t0, double t1, std::span<const Vec3> x);
  /// Whether all that holds at t0 holds at t1 [s], and nothing else.
  bool stay(double t0, double t1) const;

  /// Of all particles at the end of the step [m], [N].
  void add_forces(std::span<const Vec3> x_end, std::span<Vec3> force) const;
  /// Their stiffness times `end_rate`, to the terms of the system.
  void add_terms(std::span<const Vec3> x_end, double end_rate, solver::LinearSystem& system) const;
  /// Of the springs [J].
  double energy(std::span<const Vec3> x_end) const;

  /// The step is done and ends at x [m]: what bears more than its breaking load holds no longer.
  void accept(std::span<const Vec3> x);
  std::vector<frame::AttachmentLoad> measure() const;

  /// Attachments of a scene whose cloths are those of these numbers here, in its order, are as they are there.
  void take_over(const Attachments& there, std::span<const std::size_t> cloths);

  template <class Archive>
  void serialize(Archive& archive);

 private:
  struct Spring {
    Index particle = 0;
    double stiffness = 0;  // [N/m]
    // Since it is tied:
    // Of the target: three particles of a cloth, three vertices of a body, or the four particles of its frame.
    std::array<Index, 4> corners{0, 0, 0, 0};
    std::array<double, 4> weights{0, 0, 0, 0};
    double length = 0;          // L [m]
    Vec3 place = Vec3::Zero();  // on a body, at the end of the step [m]
  };
  enum class State : std::uint8_t { open, tied, broken };
  struct Attachment {
    std::string name;
    int cloth = -1, body = -1;  // its target: number of a cloth or of a body
    Index frame = -1;           // first particle of the frame of that body, if it has one
    bool is_of_particles() const { return cloth >= 0 || frame >= 0; }  // its target
    double begin, release;                                             // [s]; release: infinite if never
    std::optional<double> length, breaking_load;
    std::vector<Spring> springs;
    State state = State::open;
    bool holds = false;  // in the step at hand
    double load = 0;     // sum of the springs' forces at the end of the last step [N]
  };
  struct Pull {
    Vec3 along;        // unit vector from the particle to its place
    double force = 0;  // [N]; 0: it is slack
    double length = 0;
  };
  Vec3 place_of(const Attachment& attachment, const Spring& spring, std::span<const Vec3> x) const;
  Pull pull(const Attachment& attachment, const Spring& spring, std::span<const Vec3> x) const;
  bool holds_at(const Attachment& attachment, double t) const;
  void tie(Attachment& attachment, double t, std::span<const Vec3> x) const;
  Vec3 corner(std::size_t body, Index vertex, double t) const;
  const mesh::RigidFrame& frame_of(const Attachment& attachment) const;
  void use_frame(const Attachment& attachment, Spring& spring) const;
  template <class Body>
  void for_each_pull(std::span<const Vec3> x, const Body& body) const;

  const environment::Environment* environment_;
  std::vector<Index> first_;  // particle of each cloth
  std::vector<Attachment> attachments_;
};

}  // namespace weft::simulation
