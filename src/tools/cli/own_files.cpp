#include "tools/cli/own_files.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>

#include "core/error.hpp"
#include "core/input_file.hpp"
#include "core/json.hpp"
#include "core/temporary_file.hpp"
#include "film/image/exr.hpp"
#include "film/image/png.hpp"
#include "film/video/decoder.hpp"
#include "film/video/encoder.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

bool starts_with_one_of(const fs::path& file, std::initializer_list<std::string> beginnings) {
  constexpr std::size_t kMaxStartBytes = 4096;
  const std::string start = read_start(file, kMaxStartBytes);
  return std::ranges::any_of(beginnings, [&](const std::string& each) { return start.starts_with(each); });
}

bool has_entry(const std::map<std::string, std::string>& metadata, const std::string& key, const std::string& value) {
  const auto found = metadata.find(key);
  return found != metadata.end() && found->second == value;
}

bool is_of_scene(const std::map<std::string, std::string>& metadata, const std::string& scene) {
  return metadata.contains("weft_version") && has_entry(metadata, "scene", scene);
}

}  // namespace

std::map<std::string, std::string> metadata_of(const fs::path& file) {
  try {
    if (file.extension() == ".png") return image::read_png_metadata(file);
    if (file.extension() == ".exr") return image::read_exr_header(file).metadata;
    return video::Decoder(file).metadata();
  } catch (const Error&) {
    return {};
  }
}

std::string scene_hash_of(const fs::path& file) {
  return metadata_of(file)["scene_hash"];
}

bool is_picture_of(const fs::path& file, const std::string& scene, int frame) {
  const auto metadata = metadata_of(file);
  return is_of_scene(metadata, scene) && has_entry(metadata, "frame", fmt::format("{}", frame));
}

bool is_own_mesh(const fs::path& file) {
  return starts_with_one_of(file, {"ply\nformat binary_little_endian 1.0\ncomment Weft, ", "# Weft, "});
}

bool is_output_of(const fs::path& file, const std::string& scene) {
  std::error_code error;
  if (fs::file_size(file, error) == 0 && !error) return true;
  if (file.extension() == ".ply" && is_own_mesh(file)) return true;
  if (is_of_scene(metadata_of(file), scene)) return true;
  const std::string name = json_text(scene);
  return starts_with_one_of(file, {fmt::format("{{\n  \"scene\": {},", name),
                                   fmt::format("{{\"event\":\"scene_loaded\",\"scene\":{},", name)});
}

void remove_kept_frames(const fs::path& video, const std::string& scene) {
  const fs::path kept = video::partial_name(video);
  std::error_code ignored;
  if (may_replace(kept) && is_of_scene(metadata_of(kept), scene)) fs::remove(kept, ignored);
}

}  // namespace weft::cli
