// Buttons and zips: pairs of particles that are drawn together while a closure is closed.
#pragma once

#include "forces/force.hpp"
#include "mesh/sheet.hpp"

namespace weft::forces {

/// The ties of a sheet. Particles a distance l apart pull each other with F min(l / r − 1, 1) where l > r = kRest, and
/// not at all where they are nearer: contact keeps them apart there. F is the strength [N], in the time of sewing, and
/// after a tie has closed, rising from nothing.
class Ties final : public Force {
 public:
  /// Distance at rest [m]: somewhat above the contact thickness of most fabrics, so that ties do not press.
  static constexpr double kRest = 0.003;
  /// Time in which a tie gets to its strength after it has closed [s].
  static constexpr double kClosing = 0.4;

  Ties(const mesh::Sheet& sheet, Index first);

  /// At time t [s] of the scene, after a share of the sewing.
  void use(double t, double share);

  void couple(std::vector<std::pair<Index, Index>>& pairs) const override;
  void attach(const solver::Assembly& assembly) override;
  void cut(std::span<const Index> /*bounds*/) override {}  // few
  void add(const Evaluation& at) const override;
  void add_jacobian(std::span<const Vec3> x, std::span<const Vec3> v, double rate,
                    solver::BlockMatrix& jacobian) const override;
  double energy(std::span<const Vec3> x) const override;

 private:
  struct Piece {
    mesh::Tie tie;        // of particles in the global numbering
    double strength = 0;  // now [N]
    Index block = 0;
  };
  /// Pull and its derivative by the distance; of the pull across it the pull over the distance.
  struct Pull {
    double force = 0, axial = 0;  // [N], [N/m]
  };
  static Pull pull(const Piece& piece, double length);
  static Mat3 stiffness(const Piece& piece, const Vec3& along);

  std::vector<Piece> pieces_;
};

}  // namespace weft::forces
