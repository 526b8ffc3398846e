// Separating planes of triangle pairs, remembered from step to step.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "collision/hierarchy/lanes.hpp"
#include "collision/hierarchy/surface.hpp"
#include "collision/response/carried_starts.hpp"
#include "collision/response/certificate.hpp"
#include "core/numerics.hpp"
#include "core/types.hpp"

namespace weft::collision {

/// For each watched pair a direction and the gap along it at the reference positions. A gap shrinks by no more than the
/// two triangles move, so a pair whose triangles have moved less than that since has its certificate without being
/// looked at: cloth that lies on cloth costs one comparison a pair and step. Nor is a pair whose corners are all where
/// they were when it was last found to have one: pushing cloth apart looks again and again, after moving a few.
class Planes {
 public:
  Planes() = default;
  explicit Planes(std::span<const Triangle> triangles) : triangles_(triangles) {}

  /// Takes over the pairs, with directions found at x [m].
  void watch(std::span<const TrianglePair> pairs, std::span<const Vec3> x);
  /// The same with those that exchange() has brought.
  void watch(std::span<const Vec3> x);
  /// Exchanges the list of watched pairs for another one, so that it is kept in one place only; watch() must follow.
  void exchange(PairList& pairs) { std::swap(pairs_, pairs); }

  /// Appends the watched pairs that may be closer than `radius` [m] where vertices have `moved` so far from the
  /// reference: the gap along any direction is no more than the distance.
  void append_closer(double radius, std::span<const float> moved, PairList& out) const;

  /// Appends the pairs without certificate for the way from x_t0 to x_t1. `moved`: per vertex, a bound of its distance
  /// at either time from where it was when the pairs were taken over [m]; `reference`: those positions; `changed`: per
  /// vertex, whether x_t0 or x_t1 is another than in the last call.
  /// `carried`: starts of pairs with obstacles that turn, which are looked at without regard to that.
  void find_failing(std::span<const Vec3> reference, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1,
                    std::span<const float> moved, std::span<const std::uint8_t> changed,
                    std::vector<CornerPair>& failing, const CarriedStarts* carried = nullptr,
                    Certificates which = Certificates::all);

  /// The planes that are others than watch() has found for these pairs at the reference: all else that a new object
  /// needs, once it watches the same pairs.
  template <class Archive>
  void serialize(Archive& archive, std::span<const Vec3> reference);

 private:
  struct Plane {
    std::array<float, 3> n;
    float gap;  // at the reference, above the least gap and rounding [m]; negative: see is_known
    bool is_known() const { return n[0] != 0 || n[1] != 0 || n[2] != 0; }
    bool operator==(const Plane&) const = default;
  };
  void look_at_eight(std::size_t first, std::size_t count);
  /// As find_failing() is given it.
  struct Way {
    std::span<const Vec3> reference, x_t0, x_t1;
    const CarriedStarts* carried;
    Certificates which;
  };
  void find_failing(std::size_t begin, std::size_t end, const Way& way, std::vector<CornerPair>& failing);

  std::span<const Triangle> triangles_;
  PairList pairs_;
  std::vector<Plane> planes_;
  std::vector<Lanes4> rounded_;                // positions in float, for the first look
  std::vector<float> moved_;                   // per triangle
  std::vector<std::uint8_t> changed_;          // per triangle
  std::vector<std::uint8_t> has_certificate_;  // per pair: when it was last looked at, from x_t0 itself
};

}  // namespace weft::collision
