// Ties: pairs of particles that pull each other while a button, a zip, or a seam that can tear is closed.
#pragma once

#include <cstdint>

#include "physics/forces/force.hpp"
#include "physics/mesh/sheet.hpp"

namespace weft::forces {

/// The ties of a sheet. Both particles of a tie, at a distance l, pull each other with F min(l / r − 1, 1) if l > r =
/// kRest. At smaller distances they do not pull; contact keeps them apart. F is the strength [N]. It grows from zero
/// during sewing, and for kClosing after a tie closes. A tie of a tearable seam holds once it has full strength and
/// pulls with less than F. If its pull reaches F after that, the tie breaks for good.
class Ties final : public Force {
 public:
  /// Rest distance [m]: slightly above the contact thickness of most fabrics, so that ties do not press.
  static constexpr double kRest = 0.003;
  /// Time from closing to full strength [s].
  static constexpr double kClosing = 0.4;

  Ties(const mesh::Sheet& sheet, Index first);

  /// Updates strengths at time t [s] of the scene. `progress`: of sewing, 0 to 1.
  void use(double t, double progress);

  /// Whether the same ties are closed, with the same strength, at the times t0 and t1 [s] of the scene, for the same
  /// progress of sewing.
  bool are_constant_between(double t0, double t1) const;

  /// Accepts the end of a step, with particles at x [m]: ties of tearable seams begin to hold, or tear.
  void accept(std::span<const Vec3> x);
  /// Total pull of a tearable seam [N], and whether any of its ties has strength now (is closed and not torn).
  struct SeamLoad {
    double load = 0;
    bool holds = false;
  };
  std::vector<SeamLoad> measure_seams(std::span<const Vec3> x) const;
  /// Copies from `there` which ties hold and which are torn.
  void copy_state_from(const Ties& there);
  template <class Archive>
  void serialize(Archive& archive);

  void append_couplings(std::vector<std::pair<Index, Index>>& pairs) const override;
  void attach(const solver::Assembly& assembly) override;
  void partition(std::span<const Index> /*bounds*/) override {}  // every range visits all elements, which are few
  void add(const Evaluation& at) const override;
  void add_jacobian(std::span<const Vec3> x, std::span<const Vec3> v, double rate,
                    solver::BlockMatrix& jacobian) const override;
  double energy(std::span<const Vec3> x) const override;

 private:
  enum class State : std::uint8_t { open, holds, torn };  // of a tearable tie; `open`: cannot tear yet
  struct Piece {
    mesh::Tie tie;        // particles in the global numbering
    double strength = 0;  // current [N]
    Index block = 0;
    State state = State::open;
  };
  /// Pull and its derivative along the tie. The derivative across the tie is the pull over the distance.
  struct Pull {
    double force = 0, axial = 0;  // [N], [N/m]
  };
  static Pull pull(const Piece& piece, double length);
  static Mat3 stiffness(const Piece& piece, const Vec3& along);

  std::vector<Piece> pieces_;
  std::size_t tearing_seams_;
};

}  // namespace weft::forces
