#include "export/export.hpp"

#include "cache/reader.hpp"
#include "cli/cached_frames.hpp"
#include "cli/commands.hpp"
#include "cli/output_target.hpp"
#include "cli/path_ledger.hpp"
#include "cli/signals.hpp"
#include "core/log.hpp"

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

  const auto files = exporter::files(request, *reader.snapshot(frames.begin));
  PathLedger paths;
  paths.reads_folder(options.cache, "the cache");
  paths.writes("-o", options.output, files);
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
