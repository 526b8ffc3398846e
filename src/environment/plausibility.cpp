#include "environment/plausibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace weft::environment {
namespace {

// Bodies of people and their toys are this tall [m]; a file in centimetres is a hundred times taller.
constexpr double kLeastHeight = 0.3, kMostHeight = 3;
// Nothing with legs goes faster [m/s]; sprinters reach 12.
constexpr double kMostSpeed = 20;

}  // namespace

std::optional<std::string> doubt_of_height(std::span<const Vec3> x, const Vec3& up) {
  const auto [low, high] = std::ranges::minmax(x, {}, [&](const Vec3& v) { return up.dot(v); });
  const double height = up.dot(high - low);
  if (height >= kLeastHeight && height <= kMostHeight) return std::nullopt;
  return fmt::format(
      "is {:.3g} m tall, where {:g} to {:g} m are expected; scale says how many metres a unit of the file has", height,
      kLeastHeight, kMostHeight);
}

std::optional<std::string> doubt_of_speed(const KeyFrames& keys, double begin, double rate, std::size_t count,
                                          std::size_t vertices) {
  std::vector<Vec3> x(vertices);
  const auto middle = [&](std::size_t k) -> Vec3 {
    keys.at(begin + static_cast<double>(k) / rate, x);
    Vec3 sum = Vec3::Zero();
    for (const Vec3& v : x) sum += v;
    return sum / static_cast<double>(x.size());
  };
  double fastest = 0;
  Vec3 before = middle(0);
  for (std::size_t k = 1; k < count; ++k) {
    const Vec3 now = middle(k);
    fastest = std::max(fastest, (now - before).norm() * rate);
    before = now;
  }
  if (fastest <= kMostSpeed) return std::nullopt;
  return fmt::format("it moves at up to {:.3g} m/s; bodies with legs reach {:g} m/s", fastest, kMostSpeed);
}

}  // namespace weft::environment
