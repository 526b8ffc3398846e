// Removes the noise of few rays: averages a picture over neighbours that show the same surface (joint bilateral filter:
// Petschnig et al., "Digital Photography with Flash and No-Flash Image Pairs", 2004).
#pragma once

#include <span>

#include "film/render/pixel_points.hpp"

namespace weft::render {

/// Averages each of the planes over 5 x 5 points, first along rows, then along columns. `step`: distance between these
/// points, in points of the plane. A neighbour on the same surface has more weight if it is near the tangent plane, if
/// its normal is similar and, if `step` exceeds 1, if its value is similar. Its distance along the plane does not
/// count: floors seen at an angle would be averaged along rows alone, which shows as streaks. `scratch`: as many planes
/// as `planes`; their content is overwritten.
void smooth(std::span<Plane> planes, std::span<Plane> scratch, const PixelPoints& points, int step);

/// Averages one plane over 5 x 5 points in a single pass, only at points whose `wanted` is above 0, and only over
/// neighbours whose `known` is above 0. The weights are as in smooth(), but also decrease with the distance. `scratch`
/// is overwritten.
void smooth_where(Plane& plane, Plane& scratch, const Plane& wanted, const Plane& known, const PixelPoints& points,
                  int step);

/// Interpolates the values at the points `few` (row by row) to rows [`begin`, `end`) of `many`, the denser points of
/// the same picture.
void interpolate(std::span<const Eigen::Vector4f> values, const PixelPoints& few, const PixelPoints& many, int begin,
                 int end, std::span<Eigen::Vector4f> results);

}  // namespace weft::render
