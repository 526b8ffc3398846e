// SIMD tests of one k-DOP or triangle against eight others. Each of these eight has one lane of a vector.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#if defined(__AVX__)
#include <immintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace weft::collision {

/// Number of sets tested at once: one per float of an AVX register.
inline constexpr int kLanes = 8;

/// Bit mask of lanes 0 to `count` − 1.
inline std::uint32_t first_lanes(int count) {
  return (1U << count) - 1;
}

/// Calls visit(l) for each set bit l, lowest first.
template <class Visit>
void for_each_bit(std::uint32_t mask, const Visit& visit) {
  for (; mask != 0; mask &= mask - 1) visit(std::countr_zero(mask));
}

/// Moving k-DOPs of eight sets as a structure of arrays: row r of set l is row[r][l].
template <int K>
struct alignas(32) LaneBounds {
  float row[2 * K][kLanes];
};

/// Bit l is set if set l of `bounds` overlaps or touches the moving k-DOP whose row r is query[r * stride]. They do not
/// overlap if the gap along one direction is positive both at the start and at the end. The sign of a sum of two floats
/// is exact.
template <int K>
inline std::uint32_t overlap_mask(const LaneBounds<K>& bounds, const float* query, std::size_t stride) {
#if defined(__AVX__)
  const auto gap_along = [&](std::size_t r) {
    return _mm256_add_ps(_mm256_load_ps(bounds.row[r]), _mm256_broadcast_ss(query + (r ^ 1) * stride));
  };
  __m256 gap = _mm256_min_ps(gap_along(0), gap_along(K));
  for (std::size_t r = 1; r < K; ++r) gap = _mm256_max_ps(gap, _mm256_min_ps(gap_along(r), gap_along(K + r)));
  return static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(gap, _mm256_setzero_ps(), _CMP_LE_OQ)));
#elif defined(__SSE2__)
  std::uint32_t mask = 0;
  for (int half = 0; half < kLanes; half += 4) {
    const auto gap_along = [&](std::size_t r) {
      return _mm_add_ps(_mm_load_ps(bounds.row[r] + half), _mm_set1_ps(query[(r ^ 1) * stride]));
    };
    __m128 gap = _mm_min_ps(gap_along(0), gap_along(K));
    for (std::size_t r = 1; r < K; ++r) gap = _mm_max_ps(gap, _mm_min_ps(gap_along(r), gap_along(K + r)));
    mask |= static_cast<std::uint32_t>(_mm_movemask_ps(_mm_cmple_ps(gap, _mm_setzero_ps()))) << half;
  }
  return mask;
#else
  std::uint32_t mask = 0;
  for (int l = 0; l < kLanes; ++l) {
    bool overlap = true;
    for (std::size_t r = 0; r < K; ++r)
      overlap &=
          bounds.row[r][l] + query[(r ^ 1) * stride] <= 0 || bounds.row[K + r][l] + query[((K + r) ^ 1) * stride] <= 0;
    mask |= static_cast<std::uint32_t>(overlap) << l;
  }
  return mask;
#endif
}

/// SIMD vectors of four or eight numbers.
typedef float Lanes4 __attribute__((vector_size(16)));
typedef float Lanes8 __attribute__((vector_size(32)));
typedef std::int32_t IntLanes8 __attribute__((vector_size(32)));

/// Sets a to the lane-wise minimum (maximum) of a and b. Does not return the result, because the ABI of a returned
/// vector depends on AVX.
inline void lower_to(Lanes8& a, const Lanes8& b) {
  a = a < b ? a : b;
}
inline void raise_to(Lanes8& a, const Lanes8& b) {
  a = a > b ? a : b;
}

/// Bit l is set if the sign bit of lane l is set: the lane is negative or −0.
inline std::uint32_t sign_mask(const Lanes8& lanes) {
#if defined(__AVX__)
  return static_cast<std::uint32_t>(_mm256_movemask_ps(reinterpret_cast<const __m256&>(lanes)));
#else
  std::uint32_t mask = 0;
  for (int l = 0; l < 8; ++l) mask |= (std::bit_cast<std::uint32_t>(lanes[l]) >> 31) << l;
  return mask;
#endif
}

/// Bit l is set if lane l is negative. A vector comparison sets all bits of the lanes for which it
/// is true, so these count as negative.
inline std::uint32_t sign_mask(const IntLanes8& lanes) {
  return sign_mask(reinterpret_cast<const Lanes8&>(lanes));
}

/// Coordinates of eight points: axis[k] holds coordinate k of all. transpose() reads rows (x, y, z, unused).
struct Points8 {
  Lanes8 axis[3];
};

inline Points8 transpose(const Lanes4* const (&row)[8]) {
  Lanes8 pair[4];  // row l next to row l + 4
  for (int l = 0; l < 4; ++l) pair[l] = __builtin_shufflevector(*row[l], *row[l + 4], 0, 1, 2, 3, 4, 5, 6, 7);
  const Lanes8 &a = pair[0], &b = pair[1], &c = pair[2], &d = pair[3];
  const Lanes8 xy_ab = __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
  const Lanes8 xy_cd = __builtin_shufflevector(c, d, 0, 8, 1, 9, 4, 12, 5, 13);
  const Lanes8 z_ab = __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
  const Lanes8 z_cd = __builtin_shufflevector(c, d, 2, 10, 3, 11, 6, 14, 7, 15);
  return {{__builtin_shufflevector(xy_ab, xy_cd, 0, 1, 8, 9, 4, 5, 12, 13),
           __builtin_shufflevector(xy_ab, xy_cd, 2, 3, 10, 11, 6, 7, 14, 15),
           __builtin_shufflevector(z_ab, z_cd, 0, 1, 8, 9, 4, 5, 12, 13)}};
}

/// Corner numbers of eight triangles: corner c of triangle l is corner[c][l].
struct alignas(32) LaneCorners {
  std::int32_t corner[3][8];
};

/// Bit masks of eight triangles: those that share exactly one vertex with a given triangle, and those that share more.
struct SharedMasks {
  std::uint32_t one, more;
};

/// Compares triangle `own` of `query` with all triangles of `lanes`. A repeated corner (piece of rope) counts once.
inline SharedMasks shared_vertices(const LaneCorners& lanes, const LaneCorners& query, int own) {
  const std::int32_t c0 = query.corner[0][own];
  std::int32_t c1 = query.corner[1][own], c2 = query.corner[2][own];
  if (c2 == c0 || c2 == c1) c2 = -2;  // equals no vertex and no empty lane (−1)
  if (c1 == c0) c1 = -2;
#if defined(__AVX2__)
  const auto row = [&](int c) { return _mm256_load_si256(reinterpret_cast<const __m256i*>(lanes.corner[c])); };
  const __m256i r0 = row(0), r1 = row(1), r2 = row(2);
  const auto found = [&](std::int32_t vertex) {
    const __m256i v = _mm256_set1_epi32(vertex);
    return _mm256_or_si256(_mm256_or_si256(_mm256_cmpeq_epi32(r0, v), _mm256_cmpeq_epi32(r1, v)),
                           _mm256_cmpeq_epi32(r2, v));
  };
  const auto mask = [](__m256i v) { return static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_castsi256_ps(v))); };
  const __m256i f0 = found(c0), f1 = found(c1), f2 = found(c2);
  const __m256i any = _mm256_or_si256(_mm256_or_si256(f0, f1), f2);
  const __m256i two =
      _mm256_or_si256(_mm256_or_si256(_mm256_and_si256(f0, f1), _mm256_and_si256(f1, f2)), _mm256_and_si256(f0, f2));
  return {mask(_mm256_andnot_si256(two, any)), mask(two)};
#else
  SharedMasks result{0, 0};
  for (int l = 0; l < 8; ++l) {
    const auto found = [&](std::int32_t v) {
      return static_cast<int>(lanes.corner[0][l] == v || lanes.corner[1][l] == v || lanes.corner[2][l] == v);
    };
    const int shared = found(c0) + found(c1) + found(c2);
    result.one |= static_cast<std::uint32_t>(shared == 1) << l;
    result.more |= static_cast<std::uint32_t>(shared > 1) << l;
  }
  return result;
#endif
}

}  // namespace weft::collision
