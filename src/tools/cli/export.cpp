#include "tools/export/export.hpp"

#include <algorithm>
#include <optional>

#include "core/error.hpp"
#include "core/log.hpp"
#include "film/cache/reader.hpp"
#include "film/render/lighting.hpp"
#include "film/render/surroundings.hpp"
#include "film/render/transforms.hpp"
#include "tools/cli/cached_frames.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/output_target.hpp"
#include "tools/cli/own_files.hpp"
#include "tools/cli/path_ledger.hpp"
#include "tools/cli/signals.hpp"

namespace weft::cli {

namespace {

/// Removes meshes of frames outside of `frames` that an earlier export of a longer film has left.
void remove_stale(const exporter::Request& request, const cache::Manifest& scene, const FrameRange& frames) {
  if (request.format != exporter::Format::ply && request.format != exporter::Format::obj) return;
  const char* ending = request.format == exporter::Format::ply ? ".ply" : ".obj";
  for (const frame::ObjectInfo& object : scene.objects)
    FramePattern((request.folder / (object.name + "_")).string(), 5, ending)
        .remove_others(frames, [](const std::filesystem::path& file, int) { return is_own_mesh(file); });
}

bool places_cameras(exporter::Format format) {
  return format == exporter::Format::gltf || format == exporter::Format::usd || format == exporter::Format::usdz ||
         format == exporter::Format::blender;
}

/// All cameras of a scene, the camera of the pictures first. A scene without cameras gets the computed one.
class Cameras {
 public:
  Cameras(const cache::Reader& reader, const frame::FrameSnapshot& first) {
    const cache::Manifest& scene = reader.manifest();
    std::vector<std::string> names = scene.cameras;
    if (names.empty()) names.emplace_back();
    std::stable_partition(names.begin(), names.end(), [&](const std::string& name) { return name == scene.camera; });
    for (const std::string& name : names) {
      render::CameraPath path(name, static_cast<double>(scene.width) / scene.height);
      if (render::CameraPath::is_computed(first, name)) {
        show_frames(reader, path);
        path.compute_cameras();
      }
      paths_.emplace_back(name.empty() ? "camera" : name, std::move(path));
    }
  }

  std::vector<exporter::View> at(const frame::FrameSnapshot& snapshot) const {
    std::vector<exporter::View> views;
    for (const auto& [name, path] : paths_) {
      const frame::Camera camera = path.at(snapshot);
      const render::ViewAxes view = axes(camera, *snapshot.stage);
      render::Mat4 world_from_view = render::Mat4::Identity();
      world_from_view.topRows<3>() << view.right, view.up, -view.forward, camera.position;
      views.push_back({name, world_from_view, camera.field_of_view});
    }
    return views;
  }

  /// Lighting of a frame, as in its pictures.
  exporter::Lighting lighting(const frame::FrameSnapshot& snapshot) const {
    const frame::Camera camera = paths_.front().second.at(snapshot);
    const frame::Stage& stage = *snapshot.stage;
    const render::Style style = render::style_of(stage);
    return {render::effective_lights(snapshot, stage.look, axes(camera, stage), stage.up), style.sky_color,
            style.sky_intensity};
  }

 private:
  static render::ViewAxes axes(const frame::Camera& camera, const frame::Stage& stage) {
    return render::view_axes(camera.target - camera.position, stage.up);
  }

  std::vector<std::pair<std::string, render::CameraPath>> paths_;
};

}  // namespace

ExitCode export_frames(const ExportOptions& options) {
  const StopSignals signals;
  const cache::Reader reader(options.cache);
  const cache::Manifest& manifest = reader.manifest();
  exporter::Request request;
  request.format = options.format;
  request.folder = options.output;
  request.name = manifest.scene;
  request.fps = manifest.fps;
  request.width = manifest.width;
  request.height = manifest.height;
  const FrameRange frames = cached_frames(reader, options.frames, options.partial);
  for (int frame = frames.begin; frame < frames.end; frame += frames.step) request.frames.push_back(frame);

  const frame::SnapshotPtr first = reader.snapshot(frames.begin);
  const auto files = exporter::files(request, *first);
  PathLedger paths;
  paths.reads_folder(options.cache, "the cache");
  paths.writes("-o", options.output, files);
  for (const auto& [file, content] : exporter::shared_files(request, *first)) paths.writes_content("-o", file, content);
  paths.check_absent(options.overwrite);
  paths.check_writable();
  std::optional<Cameras> cameras;
  if (places_cameras(request.format)) {
    cameras.emplace(reader, *first);
    request.views = [&](const frame::FrameSnapshot& snapshot) { return cameras->at(snapshot); };
    request.lighting = cameras->lighting(*first);
  }
  std::size_t done = 0;
  const bool whole = exporter::write(
      request, [&](int frame) { return ++done, reader.snapshot(frame); }, [&] { return signals.requested().load(); });
  if (!whole)
    throw Error(ExitCode::interrupted, "interrupted after {} of {} frames; export again with --overwrite", done,
                request.frames.size());
  // With --partial, the meshes after the first missing frame may be good ones of an earlier export.
  if (options.overwrite && options.frames.selects_all() && frames.count() == manifest.frame_count)
    remove_stale(request, manifest, frames);
  log::info(fmt::format("{}: {} file{} of {} frame{}", request.folder.string(), files.size(),
                        files.size() == 1 ? "" : "s", request.frames.size(), request.frames.size() == 1 ? "" : "s"));
  return ExitCode::ok;
}

}  // namespace weft::cli
