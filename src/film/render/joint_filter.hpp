// Removes the noise that few rays cause: averages the values of a pixel and of its neighbours on the same surface
// (joint bilateral filter: Petschnig et al., "Digital Photography with Flash and No-Flash Image Pairs", 2004). A
// `Plane` is one channel of a picture (pixel_points.hpp).
#pragma once

#include <span>

#include "film/render/pixel_points.hpp"

namespace weft::render {

/// Averages each of `planes` (at most four) over 5 x 5 points, first along rows, then along columns. `step`: distance
/// between these points [points], at most 4. A neighbour on another surface, or on the other side of the surface, has
/// weight 0. The weight of any other neighbour is larger if it is near the tangent plane of the point, and if its
/// normal is similar. If `step` exceeds 1, the weight is also larger if the values in all planes are similar. The
/// weight does not depend on the distance within the tangent plane: otherwise, floors at oblique view would be averaged
/// along rows only, which would be visible as streaks. `scratch`: as many planes as `planes`; overwritten.
void smooth(std::span<Plane> planes, std::span<Plane> scratch, const PixelPoints& points, int step);

/// Averages `plane` over 5 x 5 points in a single pass, but only at points whose `wanted` is above 0. The weights are
/// those of smooth(), but they also fall with the distance in space, and are multiplied by `known` (0 or 1) of the
/// neighbour. `scratch`: overwritten.
void smooth_where(Plane& plane, Plane& scratch, const Plane& wanted, const Plane& known, const PixelPoints& points,
                  int step);

/// Interpolates `values` at the points `few` to rows [`begin`, `end`) of `many`, denser points of the same picture.
/// `values` and `results` are stored row by row.
void interpolate(std::span<const Eigen::Vector4f> values, const PixelPoints& few, const PixelPoints& many, int begin,
                 int end, std::span<Eigen::Vector4f> results);

}  // namespace weft::render
