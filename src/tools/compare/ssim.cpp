#include "tools/compare/ssim.hpp"

#include <cmath>
#include <numeric>

namespace weft::compare {
namespace {

constexpr int kRadius = 5;
constexpr double kSigma = 1.5;                       // [pixels]
constexpr double kC1 = (0.01 * 255) * (0.01 * 255);  // levels²
constexpr double kC2 = (0.03 * 255) * (0.03 * 255);  // levels²

std::vector<double> window() {
  std::vector<double> weights;
  for (int i = -kRadius; i <= kRadius; ++i) weights.push_back(std::exp(-i * i / (2 * kSigma * kSigma)));
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights) weight /= sum;
  return weights;
}

// BT.709 luma (the primaries of sRGB), in levels of 255.
Plane<double> luma(const image::Image& image) {
  Plane<double> plane(image.width, image.height);
  for_each_row(image.height, [&](int y) {
    const std::uint8_t* from = image.pixel(0, y);
    for (int x = 0; x < image.width; ++x, from += 3) {
      plane.row(y)[x] = 0.2126 * from[0] + 0.7152 * from[1] + 0.0722 * from[2];
    }
  });
  return plane;
}

Plane<double> product(const Plane<double>& a, const Plane<double>& b) {
  Plane<double> plane(a.width, a.height);
  for (std::size_t i = 0; i < plane.values.size(); ++i) plane.values[i] = a.values[i] * b.values[i];
  return plane;
}

}  // namespace

double structural_similarity(const image::Image& reference, const image::Image& test, const Plane<std::uint8_t>* mask) {
  const std::vector<double> weights = window();
  const auto mean = [&](const Plane<double>& plane) { return convolve<double>(plane, weights, weights); };
  const Plane<double> a = luma(reference), b = luma(test);
  const Plane<double> mean_a = mean(a), mean_b = mean(b);
  const Plane<double> mean_aa = mean(product(a, a)), mean_bb = mean(product(b, b)), mean_ab = mean(product(a, b));

  // If a side is shorter than the window, no window fits inside, so all pixels along this side are
  // used.
  int margin_x = a.width > 2 * kRadius ? kRadius : 0, margin_y = a.height > 2 * kRadius ? kRadius : 0;
  const auto is_used = [&](int x, int y) { return mask == nullptr || mask->row(y)[x] != 0; };
  const auto count_windows = [&] {
    std::int64_t count = 0;
    for (int y = margin_y; y < a.height - margin_y; ++y)
      for (int x = margin_x; x < a.width - margin_x; ++x) count += is_used(x, y) ? 1 : 0;
    return count;
  };
  std::int64_t windows = count_windows();
  if (windows == 0) {  // the mask selects only pixels at the border
    margin_x = margin_y = 0;
    windows = count_windows();
  }

  const auto row_sum = [&](int y) {
    double sum = 0;
    for (int x = margin_x; x < a.width - margin_x; ++x) {
      if (!is_used(x, y)) continue;
      const double ma = mean_a.row(y)[x], mb = mean_b.row(y)[x];
      const double var_a = mean_aa.row(y)[x] - ma * ma, var_b = mean_bb.row(y)[x] - mb * mb;
      const double cov = mean_ab.row(y)[x] - ma * mb;
      sum += (2 * ma * mb + kC1) * (2 * cov + kC2) / ((ma * ma + mb * mb + kC1) * (var_a + var_b + kC2));
    }
    return sum;
  };
  const auto rows = static_cast<std::size_t>(a.height - 2 * margin_y);
  const double sum = parallel_sum(rows, kRowsPerChunk, [&](std::size_t begin, std::size_t end) {
    double part = 0;
    for (std::size_t y = begin; y < end; ++y) part += row_sum(static_cast<int>(y) + margin_y);
    return part;
  });
  return sum / static_cast<double>(windows);
}

}  // namespace weft::compare
