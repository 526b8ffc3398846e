#include "export/export.hpp"

#include "cache/reader.hpp"
#include "cli/cached_frames.hpp"
#include "cli/commands.hpp"
#include "cli/output_target.hpp"
#include "cli/path_ledger.hpp"
#include "cli/signals.hpp"
#include "core/log.hpp"
#include "export/obj.hpp"

namespace weft::cli {

namespace {

/// What a longer film has left under the names of this one.
void remove_stale(const exporter::Request& request, const cache::Manifest& scene, const FrameRange& frames) {
  if (request.format != exporter::Format::ply && request.format != exporter::Format::obj) return;
  const char* ending = request.format == exporter::Format::ply ? ".ply" : ".obj";
  for (const frame::ObjectInfo& object : scene.objects)
    FramePattern((request.folder / (object.name + "_")).string(), 5, ending).remove_others(frames);
}

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
  const FrameRange frames = cached_frames(reader, options.frames, options.partial);
  for (int frame = frames.begin; frame < frames.end; frame += frames.step) request.frames.push_back(frame);

  const frame::SnapshotPtr first = reader.snapshot(frames.begin);
  auto files = exporter::files(request, *first);
  PathLedger paths;
  paths.reads_folder(options.cache, "the cache");
  // Parts of a film share its materials.
  std::erase_if(files, [](const auto& file) { return file.extension() == ".mtl"; });
  paths.writes("-o", options.output, files);
  if (request.format == exporter::Format::obj || request.format == exporter::Format::pc2)
    for (const auto& surface : first->surfaces)
      paths.writes_content("-o", request.folder / (surface->name + ".mtl"), exporter::mtl_text(*surface));
  paths.check_absent(options.overwrite);
  paths.check_writable();
  const bool whole = exporter::write(
      request, [&](int frame) { return reader.snapshot(frame); }, [&] { return signals.requested().load(); });
  if (!whole) return ExitCode::interrupted;
  if (options.overwrite && !options.frames.begin && !options.frames.end) remove_stale(request, manifest, frames);
  log::info(fmt::format("{}: {} file{} of {} frame{}", request.folder.string(), files.size(),
                        files.size() == 1 ? "" : "s", request.frames.size(), request.frames.size() == 1 ? "" : "s"));
  return ExitCode::ok;
}

}  // namespace weft::cli
