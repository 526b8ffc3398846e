// Limits of stretch and shear: locking of woven threads.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "physics/forces/force.hpp"
#include "physics/forces/triangle_membrane.hpp"

namespace weft::forces {

/// Stress σ as a function of a strain e near its limit. energy() is the integral of σ, stiffness() the derivative:
///
///     σ = 0                                e ≤ onset = kOnset · limit
///     σ = kTension u³                      0 ≤ u ≤ U, with u = (e − onset) / (limit − onset)
///     σ = kTension U² (U + 3 (u − U))      u ≥ U = kStraight
///
/// The energy is convex and twice differentiable. The stress is linear beyond kStraight, so that Newton's method
/// returns from any strain in a few iterations.
class Lock {
 public:
  /// Strain at which threads begin to lock, relative to the limit. Up to this strain, the stress is
  /// exactly 0.
  static constexpr double kOnset = 0.7;
  /// Stress at the limit [N/m]; at 1.1 times the limit the stress is 9,500 N/m. For comparison: a
  /// ball that hits cloth at v = 100 m/s causes a transverse wave along threads of strain e, with
  /// the tension ρ v² / (2 √e) for the density ρ [kg/m²] (Smith, McCrackin & Schiefer,
  /// "Stress-Strain Relationships in Yarns Subjected to Rapid Impact Loading", 1958). If e is the
  /// limit, this tension is 600 to 8,000 N/m for the fabrics of film/scene/fabrics.hpp. With larger
  /// values, Newton's method oscillates near the limit (measured: 2e4 with kStraight = 1 takes 1.2
  /// times the iterations).
  static constexpr double kTension = 4e3;
  static constexpr double kStraight = 1.5;  ///< U: from this u on, the stress is linear

  explicit Lock(double limit) : onset_(kOnset * limit), span_(limit - onset_) {}

  double onset() const { return onset_; }
  double stress(double e) const {
    const double u = (e - onset_) / span_, c = std::clamp(u, 0.0, kStraight);
    return kTension * c * c * (c + 3 * std::max(0.0, u - kStraight));
  }
  double stiffness(double e) const {
    const double u = std::clamp((e - onset_) / span_, 0.0, kStraight);
    return 3 * kTension / span_ * u * u;
  }
  double energy(double e) const {
    const double u = (e - onset_) / span_, c = std::clamp(u, 0.0, kStraight), beyond = std::max(0.0, u - kStraight);
    return kTension * span_ * c * c * (0.25 * c * c + beyond * (c + 1.5 * beyond));
  }

 private:
  double onset_, span_;
};

/// Extensions at which Newton's method linearises the locks of a cloth's threads. They follow from
/// the tensions that the last linear solve predicted, so that the tension is a dual unknown, like
/// the normal force of contacts. If Newton's method linearised at the iterate, a piece would lose
/// only a third of its excess over the onset per iteration, because the stress is cubic.
struct LockLinearisation {
  std::vector<double> extensions;           ///< ‖s‖ − 1 of each piece of a thread, at the predicted tension
  std::vector<std::uint32_t> beyond_onset;  ///< pieces beyond the onset at the last update()
};

/// Locks threads near a limit of their extension, and the angle between weft and warp near a limit of the shear. A
/// piece of weft or warp that covers the area A has the energy A · Lock::energy() at its extension ‖s‖ − 1. A cell or
/// triangle of area A has the energy A · Lock::energy() at its shear |⟨s_u, s_v⟩|. If both derivatives have unit
/// length, the shear is the sine of the deviation of the angle between weft and warp from 90°.
/// Pieces, cells, triangles and their derivatives s are those of Stretch, Shear and
/// TriangleMembrane (also if the membrane is a CrossedMembrane). Compression has no limit: threads
/// buckle.
class StretchLimit final : public Force {
 public:
  /// `stretch`: limit of the extension ‖s‖ − 1; `shear`: limit of |⟨s_u, s_v⟩|. Infinite: no limit.
  /// `below`: parameters of the cloth's Stretch or TriangleMembrane, which act at every extension.
  StretchLimit(const mesh::Grid& grid, Index first, const StretchParameters& below, double stretch, double shear);
  StretchLimit(const TriangleMembrane& membrane, const StretchParameters& below, double stretch, double shear);

  void append_couplings(std::vector<std::pair<Index, Index>>& pairs) const override;
  void partition(std::span<const Index> bounds) override;
  void add(const Evaluation& at) const override;
  void add_jacobian(std::span<const Vec3> x, std::span<const Vec3> v, double rate,
                    solver::BlockMatrix& jacobian) const override;
  double energy(std::span<const Vec3> x) const override;

  /// Before the first solve of a step: sets the extensions of `linearisation` to those at x.
  void begin(std::span<const Vec3> x, LockLinearisation& linearisation) const;
  /// Before each linearisation at x: updates `linearisation`. Writes the pieces that are beyond the onset, at
  /// x or in the old extensions, into `beyond_onset`, and updates their extensions. `first`:
  /// whether this is the first iteration of a solve; then update() keeps the extensions, because
  /// this solve has not predicted any tension yet.
  void update(std::span<const Vec3> x, bool first, LockLinearisation& linearisation) const;
  /// Replaces exact forces by linearised ones: for the pieces in `linearisation.beyond_onset`, adds the force at x that
  /// follows from `linearisation`, minus the exact force at x.
  void add_linearisation_difference(std::span<const Vec3> x, const LockLinearisation& linearisation,
                                    std::span<Vec3> force) const;

  /// Copies the current rest shape of `membrane`, which must be the membrane that the constructor received.
  void copy_rest_shape(const TriangleMembrane& membrane);

  /// Extension and place of the piece with the largest extension; both are zero if no piece is
  /// extended.
  struct Worst {
    double extension = 0;       ///< ‖s‖ − 1, at least 0
    Vec3 place = Vec3::Zero();  ///< position of the piece [m]
  };
  Worst worst(std::span<const Vec3> x) const;
  double limit() const { return stretch_; }                 ///< of the extension; infinite: none
  double onset() const { return Lock::kOnset * stretch_; }  ///< extension at which threads begin to lock

 private:
  static constexpr std::size_t kMaxCorners = 4, kMaxThreadCorners = 3;
  using Corners = std::array<Index, kMaxCorners>;
  using Weights = std::array<double, kMaxCorners>;  // of the corners, in a derivative [1/m]
  /// A piece of a thread, s = Σ along[k] x_k over its corners.
  struct Thread {
    std::uint32_t corners;  // number: 2 or 3
    std::array<Index, kMaxThreadCorners> particles;
    std::array<double, kMaxThreadCorners> along;
    double area;       // covered area [m²]; of triangles: Element::area
    double stiffness;  // of the cloth, without the lock [N/m]
  };
  /// A crossing of threads, s_u = Σ weft[k] x_k and s_v = Σ warp[k] x_k.
  struct Crossing {
    std::uint32_t corners;  // number: 3 or 4
    Corners particles;
    Weights weft, warp;
    double area;  // [m²]
  };
  /// Derivatives of a piece's energy with respect to its corners: minus the forces on them [N].
  using CornerForces = std::array<Vec3, kMaxCorners>;

  /// The tangent to the Lock's stress at the extension `linearised_at`: its value at e, and its slope [N/m]. Both are 0
  /// if the value is not positive.
  struct Tangent {
    double stress, stiffness;
  };

  template <class Piece, class OfCorners>
  static Vec3 derivative(const Piece& piece, const OfCorners& weights, std::span<const Vec3> x);
  template <class Piece, class OfCorners>
  static Vec3 derivative(const Piece& piece, const OfCorners& weights, std::span<const solver::PaddedVec3<double>> x);
  template <class Points, class Body>
  void for_each_lock(Points x, std::size_t range, bool exact, const LockLinearisation* linearisation,
                     const Body& body) const;
  template <class Body>
  void lock(const Thread& piece, const Vec3& s, const double* linearised_at, const Body& body) const;
  Tangent tangent(double linearised_at, double e) const;
  template <class Body>
  void lock(const Crossing& piece, const Vec3& s_u, const Vec3& s_v, bool exact, const Body& body) const;

  StretchParameters below_;
  double stretch_, shear_;           // limits; infinite: none
  std::vector<Thread> threads_;      // empty if stretch_ is infinite
  std::vector<Crossing> crossings_;  // empty if shear_ is infinite
  Ranges ranges_of_threads_, ranges_of_crossings_;
};

}  // namespace weft::forces
