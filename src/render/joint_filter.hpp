// Removes the noise of few rays: averages a picture over neighbours that show the same surface (joint bilateral filter:
// Petschnig et al., "Digital Photography with Flash and No-Flash Image Pairs", 2004).
#pragma once

#include <span>

#include "render/pixel_points.hpp"

namespace weft::render {

/// Averages each of the planes over 5 x 5 points, first along rows, then along columns. `step`: distance between the
/// points [points]. Neighbours count by how near they are, most of all to the tangent plane, how much their normals
/// agree and, if `step` exceeds 1, how little their values differ.
/// `scratch`: as many planes, of any content.
void smooth(std::span<Plane> planes, std::span<Plane> scratch, const PixelPoints& points, int step);

/// The same of one plane over points whose `known` is above 0, only where `wanted` is above 0.
void smooth_where(Plane& plane, Plane& scratch, const Plane& wanted, const Plane& known, const PixelPoints& points,
                  int step);

/// Interpolates values of `few` points, row by row, at rows `begin` to `end` of the `many` points of the same picture.
void interpolate(std::span<const Eigen::Vector4f> values, const PixelPoints& few, const PixelPoints& many, int begin,
                 int end, std::span<Eigen::Vector4f> results);

}  // namespace weft::render
