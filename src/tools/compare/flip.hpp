// FLIP, the visible difference between two alternating images: Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström
// and Fairchild, "FLIP: a difference evaluator for alternating images", 2020. Its stages are separate functions for the
// tests.
#pragma once

#include <array>

#include "core/types.hpp"
#include "film/image/image.hpp"
#include "tools/compare/plane.hpp"

namespace weft::compare {

/// Pixels per degree of the field of view, as in the paper: 0.7 m from a display 0.7 m wide with 3840 pixels.
inline constexpr double kPixelsPerDegree = 67.02064327658226;

/// Returns the FLIP map: per pixel, 0 (looks the same) to 1. Both images must have the same size.
Plane<float> flip_map(const image::Image& reference, const image::Image& test);

namespace flip {

using Color = Eigen::Vector3f;
/// Three planes: achromatic, red-green and blue-yellow (Y C_x C_z), or L*, a* and b*.
using Channels = std::array<Plane<float>, 3>;

/// Linear sRGB to Y C_x C_z, an opponent colour space that is linear in the light (Section 4.1.1).
Color opponent_from_linear(const Color& linear);
/// Inverse of opponent_from_linear().
Color linear_from_opponent(const Color& opponent);

/// Linear sRGB to L*a*b* with the white of sRGB. After Hunt, a* and b* are multiplied by L* / 100, which reduces them
/// for dark colours (Section 4.1.2).
Color hunt_lab(const Color& linear);

/// HyAB distance of two results of hunt_lab(): |ΔL*| + √(Δa*² + Δb*²) (Section 4.1.2; Abasi et al. 2020).
float hyab(const Color& a, const Color& b);

/// Maps a HyAB distance to [0, 1] (Section 4.1.3): raises it to the power 0.7, divides it by the same power of the
/// distance between pure green and pure blue, then maps [0, 0.4] linearly to [0, 0.95] and the rest to [0.95, 1].
float remap_distance(float distance);

/// Filters one channel of Y C_x C_z with the contrast sensitivity function of the eye (Section
/// 4.1.1, Table 1). `channel`: 0 for Y, 1 for C_x, 2 for C_z.
Plane<float> filter_by_contrast_sensitivity(const Plane<float>& plane, int channel);

/// Difference of edges and points, 0 to 1 (Section 4.2). Arguments: Y channels, scaled to [0, 1].
Plane<float> feature_difference(const Plane<float>& reference, const Plane<float>& test);

}  // namespace flip
}  // namespace weft::compare
