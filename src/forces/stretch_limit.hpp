// Where woven threads lock: a limit to stretch and to shear.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "forces/force.hpp"
#include "forces/triangle_membrane.hpp"

namespace weft::forces {

/// Stress against a strain e that comes near its limit, and its integral and derivative:
///
///     σ = 0                                e ≤ onset = kOnset limit
///     σ = kTension u³,                     u = (e − onset) / (limit − onset)
///     σ = kTension U² (U + 3 (u − U))      u ≥ U = kStraight
///
/// Twice differentiable as an energy, convex, and straight far beyond the limit, so that Newton's method comes back
/// from any strain in a few steps.
class Lock {
 public:
  /// Share of the limit from which threads begin to lock. Below it nothing is added, to the bit.
  static constexpr double kOnset = 0.7;
  /// Stress at the limit [N/m]; a tenth beyond it is 9,500. A ball at 100 m/s pulls by ρ v² / (2 √e), 3,500 to 9,000
  /// N/m in the fabrics of [scene] (a transverse wave along a thread of strain e; Smith, McCrackin & Schiefer,
  /// "Stress-Strain Relationships in Yarns Subjected to Rapid Impact Loading", 1958). With 2e4 and straight from the
  /// limit on Newton's method crossed the corner again and again: multi_sheet with a limit of 0.1 took 2,033 iterations
  /// for 1,710 (1,503 without limit), a ball at 100 m/s 1,500 for 1,269 and the same strain.
  static constexpr double kTension = 4e3;
  static constexpr double kStraight = 1.5;

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
    const double u = (e - onset_) / span_, c = std::clamp(u, 0.0, kStraight), more = std::max(0.0, u - kStraight);
    return kTension * span_ * c * c * (0.25 * c * c + more * (c + 1.5 * more));
  }

 private:
  double onset_, span_;
};

/// Where Newton's method linearises the locks of a cloth's threads: not at the extension that an iterate has, but at
/// the one at which a piece has the tension that the last linearisation foresaw (a dual unknown, as contacts have one).
/// Linearised where they are, pieces come back by a third of what they are beyond their onset at a time.
struct LockLag {
  std::vector<double> extensions;   ///< per piece
  std::vector<std::uint32_t> near;  ///< pieces that are beyond their onset, there or where they are
};

/// The energy A ∫ Lock of each piece of weft and warp, by its extension ‖s‖ − 1, and of each cell or triangle by its
/// shear |⟨s_u, s_v⟩|, the sine of the angle by which weft and warp are off square. Pieces, cells and their derivatives
/// s are those of Stretch, Shear and TriangleMembrane. Compression has no limit: threads buckle.
class StretchLimit final : public Force {
 public:
  /// `stretch`: largest extension; `shear`: largest sine, infinite: none.
  StretchLimit(const mesh::Grid& grid, Index first, const StretchParameters& below, double stretch, double shear);
  StretchLimit(const TriangleMembrane& membrane, const StretchParameters& below, double stretch, double shear);

  void couple(std::vector<std::pair<Index, Index>>& pairs) const override;
  /// Few pieces lock at a time: these look their blocks up then.
  void attach(const solver::Assembly& /*assembly*/) override {}
  void cut(std::span<const Index> bounds) override;
  void add(const Evaluation& at) const override;
  void add_jacobian(std::span<const Vec3> x, std::span<const Vec3> v, double rate,
                    solver::BlockMatrix& jacobian) const override;
  double energy(std::span<const Vec3> x) const override;

  /// Before the first iteration of a step, which starts at x.
  void begin(std::span<const Vec3> x, LockLag& lag) const;
  /// Before the linearisation at x; `first`: of a step, where nothing was foreseen.
  void update(std::span<const Vec3> x, bool first, LockLag& lag) const;
  /// Adds what the linearised force is more than the force, at any x.
  void add_lag(std::span<const Vec3> x, const LockLag& lag, std::span<Vec3> force) const;

  /// Takes over the rest shape of the membrane that it was made for.
  void follow(const TriangleMembrane& membrane);

  /// What is stretched most.
  struct Worst {
    double extension = 0;       ///< ‖s‖ − 1
    Vec3 place = Vec3::Zero();  ///< [m]
  };
  Worst worst(std::span<const Vec3> x) const;
  double limit() const { return stretch_; }

 private:
  static constexpr std::size_t kMost = 4;
  using Corners = std::array<Index, kMost>;
  using Weights = std::array<double, kMost>;  // of the corners, in a derivative [1/m]
  /// A piece of a thread, s = Σ along[k] x_k over the corners that it has.
  struct Thread {
    std::size_t corners;
    Corners particles;
    Weights along;
    double area;       // that it stands for [m²]
    double stiffness;  // below the onset [N/m]
  };
  /// Where threads cross, s_u = Σ weft[k] x_k and s_v = Σ warp[k] x_k.
  struct Crossing {
    std::size_t corners;
    Corners particles;
    Weights weft, warp;
    double area;  // [m²]
  };
  /// How one piece pulls at its corners, and block (a, b) of its Jacobian.
  using Pulls = std::array<Vec3, kMost>;

  /// Stress and stiffness of the tangent at one extension, at another [N/m].
  struct Tangent {
    double stress, stiffness;
  };

  template <class Piece>
  static Vec3 derivative(const Piece& piece, const Weights& weights, std::span<const Vec3> x);
  template <class Piece>
  static Vec3 derivative(const Piece& piece, const Weights& weights, std::span<const solver::Quad<double>> x);
  template <class Points, class Body>
  void for_each_lock(Points x, std::size_t range, bool exact, const LockLag* lag, const Body& body) const;
  template <class Body>
  void lock(const Thread& piece, const Vec3& s, const double* lag, const Body& body) const;
  Tangent tangent(double lag, double e) const;
  template <class Body>
  void lock(const Crossing& piece, const Vec3& s_u, const Vec3& s_v, bool exact, const Body& body) const;

  StretchParameters below_;
  double stretch_, shear_;
  std::vector<Thread> threads_;
  std::vector<Crossing> crossings_;  // none without a limit to shear
  Ranges ranges_of_threads_, ranges_of_crossings_;
};

}  // namespace weft::forces
