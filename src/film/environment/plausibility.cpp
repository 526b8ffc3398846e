#include "film/environment/plausibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace weft::environment {
namespace {

// Limits of the height of people and toy figures, and the height of a usual person [m]. If a file is in centimetres,
// the height is 100 times too large.
constexpr double kMinHeight = 0.3, kMaxHeight = 3, kUsualHeight = 1.7;
// Maximum number of nodes that the clip turns without moving skin, before there is a warning. A few are usual, such as
// a separate head or a camera.
constexpr int kMaxIdleNodes = 3;
// Maximum speed of a body without a warning [m/s]. People run at 3 to 6; only sprinters over 100 m reach 10.
constexpr double kMaxSpeed = 9;
// Maximum distance of the lowest point of a body from the floor without a warning [m].
constexpr double kMaxFloorDistance = 0.05;

}  // namespace

std::optional<std::string> warn_of_height(std::span<const Vec3> x, const Vec3& up, double scale, bool scale_given) {
  const auto [low, high] = std::ranges::minmax(x, {}, [&](const Vec3& v) { return up.dot(v); });
  const double height = up.dot(high - low);
  const double more = scale_given ? 10 : 1;
  if (height >= kMinHeight / more && height <= kMaxHeight * more) return std::nullopt;
  return fmt::format(
      "is {:.3g} m tall, where {:g} to {:g} m are expected; scale says how many metres a unit of the file has: with "
      "scale = {:.2g} it is {:g} m",
      height, kMinHeight, kMaxHeight, scale * kUsualHeight / height, kUsualHeight);
}

std::optional<std::string> warn_of_missing_skin(const character::Character& body, const character::Clip& clip) {
  if (body.influences.empty()) return std::nullopt;
  const Index holder = body.bones[body.influences.front().bone].node;
  for (const character::Influence& influence : body.influences)
    if (influence.weight > 0 && body.bones[influence.bone].node != holder) return std::nullopt;
  std::vector<Index> carrying;  // the node that holds the skin, and its ancestors
  for (Index node = holder; node >= 0; node = body.nodes[node].parent) carrying.push_back(node);
  int idle = 0;
  for (const character::Channel& channel : clip.channels) {
    const std::vector<Quat>& turns = channel.rotation.values;
    const bool moves = std::ranges::any_of(turns, [&](const Quat& q) { return q.coeffs() != turns.front().coeffs(); });
    idle += moves && std::ranges::find(carrying, channel.node) == carrying.end() ? 1 : 0;
  }
  if (idle <= kMaxIdleNodes) return std::nullopt;
  return fmt::format(
      "has no skin on its bones: node \"{}\" holds all of it, and {} nodes that the motion turns move nothing of it; "
      "bind the mesh to the skeleton in the program that it is from",
      body.nodes[holder].name, idle);
}

std::optional<std::string> warn_of_speed(const motion::KeyFrames& keys, double begin, double rate, std::size_t count,
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
  if (fastest <= kMaxSpeed) return std::nullopt;
  return fmt::format("it moves at up to {:.3g} m/s; people who run reach {:g} m/s", fastest, kMaxSpeed);
}

// Compares the least height over the floor with the upper limit, because a body that jumps is above the floor only at
// times. Compares the median height with the lower limit, because a body that rolls may reach into the floor at times.
std::optional<std::string> warn_of_floor_distance(std::vector<double> lowest, bool alone) {
  if (lowest.empty()) return std::nullopt;
  std::ranges::sort(lowest);
  const double least = lowest.front(), median = lowest[lowest.size() / 2];
  if (median < -kMaxFloorDistance)
    return fmt::format(
        "its lowest point is {:.3g} m below the floor in half of its motion or more; position puts it higher", -median);
  if (alone && least > kMaxFloorDistance)
    return fmt::format("it comes no nearer to the floor than {:.3g} m; position puts it lower", least);
  return std::nullopt;
}

}  // namespace weft::environment
