#include "export/export.hpp"

#include "cache/reader.hpp"
#include "cli/cached_frames.hpp"
#include "cli/commands.hpp"
#include "cli/output_target.hpp"
#include "cli/signals.hpp"
#include "core/log.hpp"

namespace weft::cli {

ExitCode export_frames(const ExportOptions& options) {
  const StopSignals signals;
  const cache::Reader reader(options.cache);
  const cache::Manifest& manifest = reader.manifest();
  exporter::Request request;
  request.format = options.format;
  request.folder = options.output;
  request.name = manifest.scene;
  request.fps = manifest.fps;
  const FrameRange frames = cached_frames(reader, options.frames);
  for (int frame = frames.begin; frame < frames.end; frame += frames.step) request.frames.push_back(frame);

  const auto files = exporter::files(request, *reader.snapshot(frames.begin));
  for (const auto& file : files) check_absent(file, options.overwrite);
  if (!files.empty()) check_writable(files.front());
  const bool whole = exporter::write(
      request, [&](int frame) { return reader.snapshot(frame); }, [&] { return signals.requested().load(); });
  if (!whole) return ExitCode::interrupted;
  log::info(fmt::format("{}: {} file{} of {} frame{}", request.folder.string(), files.size(),
                        files.size() == 1 ? "" : "s", request.frames.size(), request.frames.size() == 1 ? "" : "s"));
  return ExitCode::ok;
}

}  // namespace weft::cli
