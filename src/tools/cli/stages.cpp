#include "tools/cli/stages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/log.hpp"
#include "core/version.hpp"
#include "film/frame/frame_snapshot.hpp"
#include "film/image/png.hpp"
#include "film/render/framing.hpp"
#include "film/render/seen.hpp"
#include "film/video/encoder.hpp"
#include "physics/mesh/ply.hpp"
#include "tools/cli/option_groups.hpp"

namespace weft::cli {
namespace {

bool shows_single_color(const image::Image& image) {
  // If each pixel equals the next pixel, all pixels are equal.
  return image.rgb.size() > 3 && std::equal(image.rgb.begin() + 3, image.rgb.end(), image.rgb.begin());
}

class GlPainter : public FramePainter {
 public:
  explicit GlPainter(const render::Settings& settings) : renderer_(settings), needs_image16_(settings.needs_image16) {}

  void set_camera_path(render::CameraPath path) override { renderer_.set_camera_path(std::move(path)); }

  Picture draw(const frame::FrameSnapshot& snapshot, const frame::FrameSnapshot* before) override {
    Picture picture{renderer_.draw(snapshot, before), renderer_.layers()};
    if (needs_image16_) picture.image16 = renderer_.image16();
    if (!warned_ && shows_single_color(picture.image)) {
      warned_ = true;
      log::warn(fmt::format("frame {} shows a single color: does the camera look at the scene?", snapshot.frame));
    }
    return picture;
  }

  StageTime last_time() const override { return renderer_.last_time(); }

  std::string description() const override { return renderer_.description(); }

 private:
  render::Renderer renderer_;
  bool needs_image16_ = false, warned_ = false;
};

// Adds the name of each object, under the number that the object has in the layer id.object.
Metadata name_objects(Metadata metadata, const frame::FrameSnapshot& snapshot) {
  int number = render::kFirstSurface;
  for (const auto& surface : snapshot.surfaces)
    if (render::is_subject(*surface)) metadata[fmt::format("object.{}", number++)] = surface->name;
  return metadata;
}

class OutputWriter : public FrameWriter {
 public:
  explicit OutputWriter(const WriterSettings& settings) : settings_(settings) {
    if (settings.target.kind == OutputTarget::Kind::video) open_video();
  }

  void write(const frame::FrameSnapshot& snapshot, const Picture& picture) override {
    if (video_) return video_->add(picture.image);
    if (settings_.target.kind != OutputTarget::Kind::images) return;
    const std::filesystem::path file = settings_.target.file(snapshot.frame);
    const Metadata metadata = describe_still(settings_.metadata, snapshot.frame, snapshot.time);
    if (settings_.target.layered()) {
      image::write_exr(file, picture.layers, name_objects(metadata, snapshot));
    } else if (settings_.depth == 16) {
      image::write_png(file, picture.image16, metadata);
    } else {
      image::write_png(file, picture.image, metadata);
    }
  }

  void finish() override {
    if (video_) video_->finish();
  }

 private:
  void open_video() {
    video::Settings video;
    video.width = settings_.width;
    video.height = settings_.height;
    // If only every step-th frame is drawn, a lower frame rate keeps the true speed of the motion.
    video.fps = settings_.fps / settings_.frames.step;
    video.codec = settings_.target.codec;
    video.crf = settings_.crf.value_or(video.crf);
    video.metadata = settings_.metadata;
    video.metadata["frames"] = settings_.frames.text();
    video_.emplace(settings_.target.file(0), video);
  }

  const WriterSettings settings_;
  std::optional<video::Encoder> video_;
};

}  // namespace

std::unique_ptr<FramePainter> make_gl_painter(const render::Settings& settings) {
  return std::make_unique<GlPainter>(settings);
}

Metadata describe_pictures(const cache::Manifest& scene, const render::Settings& settings, const std::string& gl) {
  const auto quality = std::ranges::find(kQualities, settings.quality, &Choice<render::Quality>::second);
  Metadata metadata{{"scene", scene.scene},
                    {"scene_hash", fmt::format("{:016x}", scene.scene_hash)},
                    {"weft_version", kVersion},
                    {"gl", gl},
                    {"fps", fmt::format("{}", scene.fps)},
                    {"scene_frames", fmt::format("{}", scene.frame_count)},
                    {"quality", quality->first}};
  const auto look = std::ranges::find_if(kLooks, [&](const auto& each) { return each.second == settings.look; });
  if (look != kLooks.end()) metadata["look"] = look->first;
  if (settings.motion_blur) metadata["motion_blur"] = fmt::format("{}", *settings.motion_blur);
  if (!settings.camera.empty()) metadata["camera"] = settings.camera;
  if (!scene.title.empty()) metadata["title"] = scene.title;
  return metadata;
}

Metadata describe_still(Metadata metadata, int frame, double time_s) {
  metadata["frame"] = fmt::format("{}", frame);
  metadata["time_s"] = fmt::format("{}", time_s);
  return metadata;
}

std::unique_ptr<FrameWriter> make_writer(const WriterSettings& settings) {
  return std::make_unique<OutputWriter>(settings);
}

FramePattern mesh_files(const std::filesystem::path& folder, const std::string& object) {
  return {(folder / (object + "_")).string(), 5, ".ply"};
}

std::vector<std::filesystem::path> mesh_files(const std::filesystem::path& folder,
                                              const std::vector<std::string>& objects, const FrameRange& frames) {
  std::vector<std::filesystem::path> files;
  if (folder.empty()) return files;
  for (const std::string& object : objects)
    for (std::filesystem::path& file : mesh_files(folder, object).names(frames)) files.push_back(std::move(file));
  return files;
}

void write_meshes(const std::filesystem::path& folder, const frame::FrameSnapshot& snapshot) {
  for (std::size_t i = 0; i < snapshot.surfaces.size(); ++i) {
    const frame::Surface& surface = *snapshot.surfaces[i];
    mesh::write_ply(mesh_files(folder, surface.name).name(snapshot.frame), snapshot.states[i].positions,
                    surface.triangles,
                    {.passed_through = surface.passed_through,
                     .values = snapshot.states[i].heat,
                     .values_name = name_of(snapshot.stage->heat)});
  }
}

}  // namespace weft::cli
