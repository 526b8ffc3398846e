#include "cli/job.hpp"

#include <utility>

#include "cli/failure.hpp"
#include "cli/stages.hpp"
#include "cli/stats.hpp"
#include "cli/summary.hpp"
#include "cli/system_info.hpp"
#include "core/log.hpp"
#include "core/parallel.hpp"
#include "core/temporary_file.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

std::size_t count_particles(const std::vector<frame::ObjectInfo>& objects) {
  std::size_t particles = 0;
  for (const frame::ObjectInfo& object : objects)
    if (object.kind == frame::ObjectKind::cloth) particles += object.vertices;
  return particles;
}

}  // namespace

Job::Job(const RunOptions& options) : options_(options), log_(options.log_json) {}

ExitCode Job::execute() {
  const double cpu = thread_cpu_seconds();
  set_thread_count(options_.common.threads);
  plan_ = prepare();
  if (!options_.stats.empty()) check_writable(options_.stats);
  report_.setup = {wall_.seconds(), thread_cpu_seconds() - cpu};
  describe();
  sum_up(run_stages());
  conclude(report_);
  publish();
  finish(report_.exit_code);
  return report_.exit_code;
}

std::unique_ptr<FramePainter> Job::make_painter() const {
  return make_gl_painter(plan_.settings);
}

void Job::prepare_meshes(const std::vector<std::string>& objects, const FrameRange& wanted, bool overwrite) const {
  if (options_.meshes.empty()) return;
  for (const std::string& name : objects)
    for (int frame = wanted.begin; frame < wanted.end; frame += wanted.step)
      check_absent(mesh_file(options_.meshes, name, frame), overwrite);
  check_writable(options_.meshes / "probe.ply");
}

void Job::describe() {
  const bool pictures = plan_.target.kind != OutputTarget::Kind::none;
  report_.scene = plan_.scene.scene;
  report_.scene_file = options_.common.scene.string();
  report_.scene_hash = plan_.scene.scene_hash;
  report_.threads = thread_count();
  report_.width = pictures ? plan_.settings.width : 0;
  report_.height = pictures ? plan_.settings.height : 0;
  report_.fps = plan_.scene.fps;
  report_.output = plan_.target.text;
  report_.wanted = plan_.wanted;
  report_.replayed = plan_.simulated == 0;
  log_.write("scene_loaded", {{"scene", report_.scene},
                              {"scene_file", report_.scene_file},
                              {"scene_hash", fmt::format("{:016x}", report_.scene_hash)},
                              {"frames", plan_.scene.frame_count},
                              {"fps", plan_.scene.fps}});
}

PipelineResult Job::run_stages() {
  const int drawn = plan_.target.kind == OutputTarget::Kind::none ? 0 : plan_.wanted.count();
  const StageCounts totals{plan_.simulated, drawn, drawn};
  Progress progress(options_.common.progress, totals);
  const auto advance = [&](Stage stage) {
    if (totals[static_cast<std::size_t>(stage)] > 0) progress.advance(stage);
  };
  const PipelineParts parts{
      [&] { return set_up_source([&] { advance(Stage::simulate); }); }, [this] { return make_painter(); },
      [this](const std::string& gl) {
        return make_writer({plan_.target, plan_.wanted, plan_.settings.width, plan_.settings.height, plan_.scene.fps,
                            options_.meshes, describe_pictures(plan_.scene, plan_.settings, gl)});
      }};
  const PipelineObserver observer{advance,
                                  [this](const FrameRecord& record) { log_.write("frame_done", frame_json(record)); }};
  return run_pipeline(parts, plan_.made, plan_.wanted, signals_.requested(), observer);
}

std::unique_ptr<FrameSource> Job::set_up_source(const std::function<void()>& preroll_frame_done) {
  const WallTimer wall;
  const double cpu = thread_cpu_seconds();
  std::unique_ptr<FrameSource> source = make_source([this, preroll_frame_done] {
    preroll_frame_done();
    return !signals_.requested();
  });
  report_.objects = objects();
  report_.particles = count_particles(report_.objects);
  report_.setup += {wall.seconds(), thread_cpu_seconds() - cpu};
  log_.write("simulation_ready", {{"objects", report_.objects.size()}, {"particles", report_.particles}});
  return source;
}

void Job::sum_up(const PipelineResult& result) {
  report_.frames = result.frames;
  report_.written = result.written;
  report_.gl = result.painter;
  const bool video = plan_.target.kind == OutputTarget::Kind::video;
  // A video that could not be finished holds nothing; pictures are whole one by one.
  if (video && !result.finished_output) {
    report_.written = 0;
    for (FrameRecord& record : report_.frames) record.written = false;
  }
  if (video && result.finished_output) {
    std::error_code error;
    const std::uintmax_t bytes = fs::file_size(plan_.target.file(0), error);
    report_.output_bytes = error ? 0 : bytes;
  }
  if (result.failure) {
    const Failure failure = describe_failure(result.failure);
    end_early(failure.code, failure.text);
  } else if (result.interrupted) {
    end_early(ExitCode::interrupted,
              fmt::format("interrupted after frame {} of {}", report_.frames.back().report.frame, plan_.wanted.last()));
  }
}

void Job::end_early(ExitCode code, const std::string& reason) {
  report_.exit_code = code;
  report_.message = code == ExitCode::simulation_failed ? "the simulation failed: " + reason : reason;
  const bool pictures = plan_.target.kind != OutputTarget::Kind::none;
  const int kept = pictures ? report_.written : static_cast<int>(report_.frames.size());
  report_.message += kept > 0
                         ? fmt::format("; {} frame{} kept in {}", kept, kept == 1 ? " is" : "s are", report_.output)
                         : "; no frame was written";
  if (const std::string way = way_on(code); !way.empty()) report_.message += "; " + way;
}

// Side files first: what they cannot take must show in the exit code. The message comes last, where it is seen.
void Job::publish() {
  report_.warnings = log::warnings();
  for (std::string& warning : find_warnings(report_.frames)) report_.warnings.push_back(std::move(warning));
  report_.wall_s = wall_.seconds();
  report_.cpu_s = process_cpu_seconds();
  report_.peak_memory = peak_memory_bytes();
  try_side_file([this] {
    if (report_.written > 0 && plan_.target.kind != OutputTarget::Kind::none)
      write_file(effective_scene_file(), plan_.scene_text);
  });
  try_side_file([this] {
    if (!options_.stats.empty()) write_file(options_.stats, stats_json(report_).dump(2) + "\n");
  });
  log_.write("finished", {{"exit_code", static_cast<int>(report_.exit_code)},
                          {"message", report_.message},
                          {"output", report_.output},
                          {"frames_written", report_.written},
                          {"frames_simulated", report_.frames.size()},
                          {"wall_s", report_.wall_s},
                          {"cpu_s", report_.cpu_s}});
  try_side_file([this] { log_.check(); });
  if (!report_.frames.empty()) log::info(summary(report_));
  if (!report_.message.empty()) log::info("weft: " + report_.message);
}

template <class Write>
void Job::try_side_file(const Write& write) {
  try {
    write();
  } catch (...) {
    const Failure failure = describe_failure(std::current_exception());
    log::info("weft: " + failure.text);
    if (report_.exit_code == ExitCode::ok) report_.exit_code = failure.code;
  }
}

// Beside the output: the checked scene with every default filled in.
fs::path Job::effective_scene_file() const {
  const fs::path file = plan_.target.file(plan_.wanted.begin);
  const bool video = plan_.target.kind == OutputTarget::Kind::video;
  return file.parent_path() / ((video ? file.stem().string() : plan_.scene.scene) + ".effective.toml");
}

}  // namespace weft::cli
