#include "film/cache/manifest.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "core/error.hpp"
#include "core/json.hpp"
#include "core/names.hpp"
#include "film/cache/container.hpp"

namespace weft::cache {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "weft frame cache";
constexpr std::array kKinds{"cloth", "obstacle", "character", "rope"};
constexpr int kMaxSceneFrames = 100'001;
constexpr int kMaxPrerollFrames = 10'000'000;

void require(bool good, const char* what) {
  if (!good) throw std::runtime_error(what);
}

std::uint64_t parse_hash(const std::string& text) {
  std::uint64_t hash = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), hash, 16);
  require(error == std::errc() && end == text.data() + text.size(), "hash: expected 16 hexadecimal digits");
  return hash;
}

std::string hash_text(std::uint64_t hash) {
  return fmt::format("{:016x}", hash);
}

int parse_count(const Json& json, const char* key, int low, int high) {
  const Json& value = json.at(key);
  require(value.is_number_integer(), key);
  const auto count = value.get<std::int64_t>();
  if (count < low || count > high)
    throw std::runtime_error(fmt::format("{}: expected {} to {}, got {}", key, low, high, count));
  return static_cast<int>(count);
}

frame::ObjectInfo parse_object(const Json& json) {
  const std::string kind = json.at("kind").get<std::string>();
  for (std::size_t k = 0; k < kKinds.size(); ++k) {
    if (kind != kKinds[k]) continue;
    return {json.at("name").get<std::string>(), static_cast<frame::ObjectKind>(k),
            json.at("vertices").get<std::size_t>(), json.at("faces").get<std::size_t>()};
  }
  throw std::runtime_error(fmt::format("kind: expected {}, got {}", fmt::join(kKinds, " or "), kind));
}

Manifest parse(const Json& json, const std::string& file) {
  require(value_or(json, "format", std::string()) == kFormat, "it is no manifest of a frame cache");
  const int version = parse_count(json, "format_version", 1, 1'000'000);
  if (version != static_cast<int>(kFormatVersion))
    throw Error(ExitCode::asset_unreadable,
                "{}: made by another version of Weft (format {}; this one reads {}); simulate the scene again", file,
                version, kFormatVersion);
  Manifest manifest;
  manifest.scene = json.at("scene").get<std::string>();
  require(is_plain_name(manifest.scene), "scene: expected a name");
  manifest.title = json.at("title").get<std::string>();
  manifest.scene_hash = parse_hash(json.at("scene_hash").get<std::string>());
  // Older caches of this format version have neither of these two keys.
  if (json.contains("simulation_hash"))
    manifest.simulation_hash = parse_hash(json.at("simulation_hash").get<std::string>());
  if (json.contains("former_hashes"))
    for (const Json& hash : json.at("former_hashes"))
      manifest.former_hashes.push_back(parse_hash(hash.get<std::string>()));
  manifest.fps = json.at("fps").get<double>();
  require(std::isfinite(manifest.fps) && manifest.fps > 0, "fps: expected > 0 frames a second");
  manifest.frame_count = parse_count(json, "frame_count", 1, kMaxSceneFrames);
  manifest.preroll_frames = parse_count(json, "preroll_frames", 0, kMaxPrerollFrames);
  manifest.width = parse_count(json, "width", 16, 8192);
  manifest.height = parse_count(json, "height", 16, 8192);
  manifest.camera = json.at("camera").get<std::string>();
  manifest.cameras = json.at("cameras").get<std::vector<std::string>>();
  manifest.weft_version = json.at("weft_version").get<std::string>();
  manifest.cpu_target = json.at("cpu_target").get<std::string>();
  manifest.program = json.at("program").get<std::string>();
  for (const Json& object : json.at("objects")) manifest.objects.push_back(parse_object(object));
  return manifest;
}

}  // namespace

std::string manifest_text(const Manifest& manifest) {
  Json objects = Json::array();
  for (const frame::ObjectInfo& object : manifest.objects) {
    objects.push_back({{"name", object.name},
                       {"kind", kKinds.at(static_cast<std::size_t>(object.kind))},
                       {"vertices", object.vertices},
                       {"faces", object.faces}});
  }
  Json former = Json::array();
  for (const std::uint64_t hash : manifest.former_hashes) former.push_back(hash_text(hash));
  const Json json{{"format", kFormat},
                  {"format_version", kFormatVersion},
                  {"scene", manifest.scene},
                  {"title", manifest.title},
                  {"scene_hash", hash_text(manifest.scene_hash)},
                  {"simulation_hash", hash_text(manifest.simulation_hash)},
                  {"former_hashes", std::move(former)},
                  {"fps", manifest.fps},
                  {"frame_count", manifest.frame_count},
                  {"preroll_frames", manifest.preroll_frames},
                  {"width", manifest.width},
                  {"height", manifest.height},
                  {"camera", manifest.camera},
                  {"cameras", manifest.cameras},
                  {"weft_version", manifest.weft_version},
                  {"cpu_target", manifest.cpu_target},
                  {"program", manifest.program},
                  {"objects", std::move(objects)}};
  return json_text(json, 2) + "\n";
}

Manifest parse_manifest(std::string_view text, const std::string& file) {
  try {
    return parse(parse_json(text), file);
  } catch (const Json::exception& error) {
    throw std::runtime_error(error.what());
  }
}

}  // namespace weft::cache
