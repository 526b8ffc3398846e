// Ties: pairs of particles that pull each other while a button, a zip, or a seam that can tear is closed.
#pragma once

#include <cstdint>

#include "physics/forces/force.hpp"
#include "physics/mesh/sheet.hpp"

namespace weft::forces {

/// The ties of a sheet. If the distance l between both particles of a tie exceeds r = kRest, they pull each other with
/// the force F min(l/r − 1, 1). At smaller distances only contact acts. F is the strength of the
/// tie [N]. F grows from zero during sewing, and for the time kClosing after the tie closes. If, at
/// the end of an accepted step, F has its full value and the pull is less than F, a tie of a
/// tearable seam holds (State::can_tear). If the pull of a tie that holds reaches F, the tie tears and
/// stays torn. If F becomes zero, the tie no longer holds.
class Ties final : public Force {
 public:
  static constexpr double kRest = mesh::Tie::kRest;  ///< rest distance [m]
  /// Time from closing to full strength [s].
  static constexpr double kClosing = 0.4;

  /// A tie opens up to `time_tolerance` [s] before its time: the end of a step has rounding errors.
  Ties(const mesh::Sheet& sheet, Index first, double time_tolerance);

  /// Sets the strengths for the scene time t [s]. `progress`: of sewing, 0 to 1.
  void set_strengths(double t, double progress);

  /// Whether opening and closing give each tie the same strength at the scene time t1 [s] as at t0
  /// [s]. Ignores sewing and tearing.
  bool are_constant_between(double t0, double t1) const;

  /// At the end of an accepted step, with particles at x [m]: updates which ties of tearable seams hold and which are
  /// torn.
  void accept(std::span<const Vec3> x);
  /// Total pull of the ties of a tearable seam [N], and whether any of these ties has a positive
  /// strength now (is closed and not torn).
  struct SeamLoad {
    double load = 0;
    bool is_closed = false;
  };
  /// Loads with the particles at x [m], in the order of Sheet::tearing_seams.
  std::vector<SeamLoad> measure_seams(std::span<const Vec3> x) const;
  /// Copies the State of all ties from `there`.
  void copy_state_from(const Ties& there);
  template <class Archive>
  void serialize(Archive& archive);

  void append_couplings(std::vector<std::pair<Index, Index>>& pairs) const override;
  void attach(const solver::Assembly& assembly) override;
  void add(const Evaluation& at) const override;
  void add_jacobian(std::span<const Vec3> x, std::span<const Vec3> v, double rate,
                    solver::BlockMatrix& jacobian) const override;
  double energy(std::span<const Vec3> x) const override;

 private:
  enum class State : std::uint8_t { open, can_tear, torn };  // of a tearable tie; `open`: cannot tear now
  struct Piece {
    mesh::Tie tie;        // particles in the global numbering
    double strength = 0;  // current [N]
    Index block = 0;
    State state = State::open;
  };
  /// Pull, and its derivative along the tie. Across the tie, the derivative is the pull divided by the distance.
  struct Pull {
    double force = 0, axial = 0;  // [N], [N/m]
  };
  static Pull pull(const Piece& piece, double length);
  static Mat3 stiffness(const Piece& piece, const Vec3& along);

  std::vector<Piece> pieces_;
  std::size_t tearing_seams_;  // number
};

}  // namespace weft::forces
