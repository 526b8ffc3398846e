#include "film/assets/camera_file.hpp"

#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <numbers>
#include <set>
#include <span>
#include <stdexcept>

#include "core/archive.hpp"
#include "film/assets/import.hpp"
#include "film/assets/source.hpp"

namespace weft::assets {
namespace {

/// Maximum time between samples of the motion [s]. If a camera circles its target by 90 degrees in a second, linear
/// interpolation between these samples has an error of 0.0001 times the distance from the target.
constexpr double kMaxSampleInterval = 0.02;

/// Maximum length of a shot [s]. Files with longer shots count as damaged.
constexpr double kMaxShotLength = 3600;

constexpr double kDegrees = 180 / std::numbers::pi;

/// Value of a channel at the time `ticks` [ticks]. Constant before the first and after the last key.
template <class Key, class Interpolate>
auto value_at(std::span<const Key> keys, double ticks, const Interpolate& interpolate) {
  const auto next = std::ranges::find_if(keys, [&](const Key& key) { return key.mTime > ticks; });
  if (next == keys.begin()) return keys.front().mValue;
  if (next == keys.end()) return keys.back().mValue;
  const Key &a = *(next - 1), &b = *next;
  return interpolate(a.mValue, b.mValue, static_cast<ai_real>((ticks - a.mTime) / (b.mTime - a.mTime)));
}

aiVector3D vector_at(const aiVectorKey* keys, unsigned count, double ticks) {
  return value_at(std::span(keys, count), ticks,
                  [](const aiVector3D& a, const aiVector3D& b, ai_real s) { return a + (b - a) * s; });
}
aiQuaternion rotation_at(const aiQuatKey* keys, unsigned count, double ticks) {
  return value_at(std::span(keys, count), ticks, [](const aiQuaternion& a, const aiQuaternion& b, ai_real s) {
    aiQuaternion between;
    aiQuaternion::Interpolate(between, a, b, s);
    return between.Normalize();
  });
}

const aiNodeAnim* channel_of(const aiAnimation& animation, const aiNode& node) {
  for (const aiNodeAnim* channel : std::span(animation.mChannels, animation.mNumChannels))
    if (channel->mNodeName == node.mName) return channel;
  return nullptr;
}

bool moves(const aiAnimation& animation, const aiNode& node) {
  for (const aiNode* each = &node; each != nullptr; each = each->mParent)
    if (channel_of(animation, *each) != nullptr) return true;
  return false;
}

aiMatrix4x4 local_at(const aiNode& node, const aiAnimation* animation, double ticks) {
  const aiNodeAnim* channel = animation != nullptr ? channel_of(*animation, node) : nullptr;
  if (channel == nullptr) return node.mTransformation;
  aiVector3D scale, position;
  aiQuaternion turn;
  node.mTransformation.Decompose(scale, turn, position);
  if (channel->mNumPositionKeys > 0) position = vector_at(channel->mPositionKeys, channel->mNumPositionKeys, ticks);
  if (channel->mNumScalingKeys > 0) scale = vector_at(channel->mScalingKeys, channel->mNumScalingKeys, ticks);
  if (channel->mNumRotationKeys > 0) turn = rotation_at(channel->mRotationKeys, channel->mNumRotationKeys, ticks);
  return {scale, turn, position};
}

aiMatrix4x4 world_at(const aiNode& node, const aiAnimation* animation, double ticks) {
  aiMatrix4x4 world;
  for (const aiNode* each = &node; each != nullptr; each = each->mParent)
    world = local_at(*each, animation, ticks) * world;
  return world;
}

/// Sample times [s]: all key times of the nodes from the camera to the root, and times between them, so that
/// neighbouring times differ by at most kMaxSampleInterval.
std::vector<double> times_of(const aiNode& node, const aiAnimation& animation) {
  const double rate = animation.mTicksPerSecond > 0 ? animation.mTicksPerSecond : 1;
  std::set<double> keys;
  const auto add = [&](const auto* list, unsigned count) {
    for (const auto& key : std::span(list, count)) keys.insert(key.mTime / rate);
  };
  for (const aiNode* each = &node; each != nullptr; each = each->mParent)
    if (const aiNodeAnim* channel = channel_of(animation, *each)) {
      add(channel->mPositionKeys, channel->mNumPositionKeys);
      add(channel->mRotationKeys, channel->mNumRotationKeys);
      add(channel->mScalingKeys, channel->mNumScalingKeys);
    }
  if (keys.empty()) return {0};
  if (!(*keys.begin() >= 0 && *keys.rbegin() < kMaxShotLength))
    throw std::runtime_error(fmt::format("expected keys between 0 and {} s, got {:g} to {:g} s", kMaxShotLength,
                                         *keys.begin(), *keys.rbegin()));
  std::vector<double> times;
  for (const double key : keys) {
    const double before = times.empty() ? key : times.back();
    const int pieces = static_cast<int>(std::ceil((key - before) / kMaxSampleInterval));
    for (int i = 1; i < pieces; ++i) times.push_back(before + (key - before) * i / pieces);
    times.push_back(key);
  }
  return times;
}

Vec3 to_vec(const aiVector3D& v) {
  return {v.x, v.y, v.z};
}

void add_view(LoadedCamera& camera, const aiCamera& from, const aiMatrix4x4& world, double time) {
  const aiMatrix3x3 turn(world);
  const Vec3 position(world.a4, world.b4, world.c4);
  const Vec3 forward = to_vec(turn * from.mLookAt).normalized(), up = to_vec(turn * from.mUp).normalized();
  if (!position.allFinite() || !forward.allFinite() || !up.allFinite())
    throw std::runtime_error(fmt::format("its motion at {:g} s {}", time, kNotFinite));
  camera.times.push_back(time);
  camera.positions.push_back(position);
  camera.forward.push_back(forward);
  // The side vector of a camera without roll is horizontal. That of a camera that is upside down is horizontal, too;
  // its `up` points down.
  const double tilt = kDegrees * std::asin(std::min(1.0, std::abs(forward.cross(up).y())));
  constexpr double kSinglePrecision = 1e-6;
  camera.roll = std::max(camera.roll, up.y() < -kSinglePrecision ? 180 - tilt : tilt);
}

const aiCamera& find_camera(const aiScene& scene, const std::string& object) {
  std::string names;
  for (const aiCamera* camera : std::span(scene.mCameras, scene.mNumCameras)) {
    if (object == camera->mName.C_Str() || (object.empty() && scene.mNumCameras == 1)) return *camera;
    names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", camera->mName.C_Str());
  }
  if (names.empty()) throw std::runtime_error("expected a camera, got none");
  if (object.empty())
    throw std::runtime_error(fmt::format("it has several cameras: choose one of {} by object", names));
  throw std::runtime_error(fmt::format("expected a camera \"{}\", got {}", object, names));
}

LoadedCamera read_camera(const std::filesystem::path& file, const std::string& object) {
  Assimp::Importer importer;
  const aiScene& scene = import(importer, file, 0);
  const aiCamera& from = find_camera(scene, object);
  const aiNode* node = scene.mRootNode->FindNode(from.mName);
  if (node == nullptr) throw std::runtime_error("expected a node with the camera, got none");
  const aiAnimation* animation = nullptr;
  for (const aiAnimation* each : std::span(scene.mAnimations, scene.mNumAnimations))
    if (animation == nullptr && moves(*each, *node)) animation = each;
  LoadedCamera camera;
  // glTF files state the vertical angle. assimp 5.2 multiplies it by the aspect ratio if the file states one.
  camera.field_of_view = kDegrees * from.mHorizontalFOV / (from.mAspect > 0 ? from.mAspect : 1);
  const double rate = animation != nullptr && animation->mTicksPerSecond > 0 ? animation->mTicksPerSecond : 1;
  for (const double time : animation != nullptr ? times_of(*node, *animation) : std::vector<double>{0})
    add_view(camera, from, world_at(*node, animation, time * rate), time);
  return camera;
}

template <class Archive>
void serialize(Archive& archive, LoadedCamera& camera) {
  serialize_plain(archive, camera.times);
  serialize_points(archive, camera.positions, camera.times.size());
  serialize_points(archive, camera.forward, camera.times.size());
  serialize_values(archive, camera.field_of_view, camera.roll);
}

}  // namespace

LoadedCamera load_camera(const std::filesystem::path& file, const std::string& object, const std::string& where) {
  const Source source{file, where, "camera"};
  const std::string ending = ending_of(file);
  if (ending != ".glb" && ending != ".gltf") source.fail("expected a glTF file (.glb, .gltf)");
  const std::string bytes = source.read([&] {
    LoadedCamera camera = read_camera(file, object);
    ByteWriter writer;
    serialize(writer, camera);
    return writer.bytes;
  });
  LoadedCamera camera;
  source.checked([&] {
    ByteReader reader{bytes};
    serialize(reader, camera);
  });
  if (!(camera.field_of_view >= 1 && camera.field_of_view <= 170))
    source.fail(fmt::format("expected a vertical field of view of 1 to 170 degrees, got {:g}", camera.field_of_view));
  return camera;
}

}  // namespace weft::assets
