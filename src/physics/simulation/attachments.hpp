// Buttons, pegs and tacks: springs that tie particles of a cloth to another cloth or to a body.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "physics/model/model.hpp"
#include "physics/simulation/frame_report.hpp"
#include "physics/solver/linear_system.hpp"

namespace weft::simulation {

/// In the first step that ends at or after its `begin` time, an attachment (model::Attachment) ties
/// each of its particles to the nearest point on its target at the start of this step. The point
/// moves with the target: it is a weighted sum, with constant weights, of the corners of a triangle
/// or, if forces move the target body, of the four particles of its frame (mesh::RigidFrame).
///
/// If the distance l between the particle and its point exceeds the rest length L, a spring pulls with the force
/// k (l − L), k = Spring::stiffness. Otherwise the spring is slack and exerts no force. L is model::Attachment::length
/// or, if that is absent, l at the time of tying. The forces are those at the positions at the end of the step, as for
/// contacts.
class Attachments {
 public:
  /// `first_particle`: of each cloth; `first_of_frames`: first frame particle of each body, −1 for a body without a
  /// frame. The model must outlive this object.
  Attachments(const model::Model& model, std::span<const Index> first_particle, std::span<const Index> first_of_frames);

  bool empty() const { return attachments_.empty(); }

  /// Begins a step from t0 to t1 [s] with particles at x [m]: selects the attachments that hold in the step, ties those
  /// that begin, and computes the positions of their points on key-framed bodies at t1. `masses`: of all particles
  /// [kg].
  void begin_step(double t0, double t1, std::span<const Vec3> x, std::span<const double> masses);
  /// Whether the same attachments hold at t0 and t1 [s], and the triangles of key-framed bodies to
  /// which they tie particles have the same positions at both times.
  bool are_constant_between(double t0, double t1) const;

  /// Adds the spring forces to `force` [N]; `x_end`: all particles at the end of the step [m].
  void add_forces(std::span<const Vec3> x_end, std::span<Vec3> force) const;
  /// Adds the stiffness of the springs that are not slack, times `end_rate` (integrator::StagePoint), to `system`.
  void add_terms(std::span<const Vec3> x_end, double end_rate, solver::LinearSystem& system) const;
  /// Energy of the springs [J].
  double energy(std::span<const Vec3> x_end) const;

  /// Accepts the step that ends at x [m]: computes the load of each attachment, and breaks the
  /// attachments whose load exceeds their breaking load. Returns a warning for each attachment that
  /// was tied in this step and pulls particles faster than kMaxHoldSpeed (pins.hpp).
  std::vector<std::string> accept(std::span<const Vec3> x);
  /// The load of each attachment at the end of the last accepted step.
  std::vector<AttachmentLoad> measure() const;

  /// Copies the state of attachments of the same name. Cloth k of `there` has the number `cloths[k]` in this object.
  void copy_state_from(const Attachments& there, std::span<const std::size_t> cloths);

  template <class Archive>
  void serialize(Archive& archive);

 private:
  struct Spring {
    Index particle = 0;
    double stiffness = 0;  // [N/m]
    // The following members are valid once the spring is tied.
    // Three particles of the target cloth, three vertices of the target body, or the four particles of its frame.
    std::array<Index, 4> corners{0, 0, 0, 0};
    std::array<double, 4> weights{0, 0, 0, 0};
    double length = 0;          // rest length L [m]
    Vec3 place = Vec3::Zero();  // on a key-framed body: the point at the end of the step [m]
  };
  enum class State : std::uint8_t { open, tied, broken };
  struct Attachment {
    std::string name;
    int cloth = -1, body = -1;  // number of the target cloth or body; −1: none
    Index frame = -1;           // first frame particle of the target body; −1 if it has none
    bool target_has_particles() const { return cloth >= 0 || frame >= 0; }
    double begin, release;  // [s]; `release` is infinite if there is no release
    std::optional<double> length, breaking_load;
    std::vector<Spring> springs;
    State state = State::open;
    bool holds = false;  // whether its springs act in the current step; false once accept() has broken it
    double speed = 0;    // largest speed to which it can pull newly tied particles [m/s]; accept() sets it to 0
    double load = 0;     // sum of the spring forces at the end of the last accepted step [N]
  };
  struct Tension {
    Vec3 direction;     // unit vector from the particle to its point
    double force = 0;   // [N]; 0: the spring is slack
    double length = 0;  // distance of the particle from its point [m]; 0 if the spring is slack
  };
  Vec3 place_of(const Attachment& attachment, const Spring& spring, std::span<const Vec3> x) const;
  Tension compute_tension(const Attachment& attachment, const Spring& spring, std::span<const Vec3> x) const;
  bool holds_at(const Attachment& attachment, double t) const;
  void tie_to_target(Attachment& attachment, double t, std::span<const Vec3> x, std::span<const double> masses) const;
  Vec3 corner_position(std::size_t body, Index vertex, double t) const;
  const mesh::RigidFrame& frame_of(const Attachment& attachment) const;
  void move_to_frame(const Attachment& attachment, Spring& spring) const;
  template <class Visit>
  void for_each_tension(std::span<const Vec3> x, const Visit& visit) const;

  const model::Model* model_;
  double step_;                        // largest time step [s]
  std::vector<Index> first_particle_;  // of each cloth
  std::vector<Attachment> attachments_;
};

}  // namespace weft::simulation
