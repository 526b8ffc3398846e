// The commands run, simulate and render. Each turns its options into a FilmPlan, which make_film() carries out.
#include <algorithm>
#include <optional>
#include <utility>

#include "core/json.hpp"
#include "core/log.hpp"
#include "core/memory.hpp"
#include "core/parallel.hpp"
#include "core/temporary_file.hpp"
#include "film/cache/reader.hpp"
#include "film/video/encoder.hpp"
#include "film/video/frame_rate.hpp"
#include "tools/cli/cached_frames.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/film.hpp"
#include "tools/cli/own_files.hpp"
#include "tools/cli/path_ledger.hpp"
#include "tools/cli/scene_input.hpp"
#include "tools/cli/signals.hpp"
#include "tools/cli/stats.hpp"
#include "tools/cli/summary.hpp"
#include "tools/cli/system_info.hpp"
#include "tools/cli/whole_output.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;
using Kind = OutputTarget::Kind;

/// What a command makes, and where the output goes.
struct FilmPlan {
  cache::Manifest scene;
  std::string scene_text;     ///< the effective scene
  FrameRange made;            ///< frames that are simulated, or read from a cache
  FrameRange wanted;          ///< subset of `made` that is drawn, or written as meshes
  int simulated = 0;          ///< number of simulated frames, including those before frame 0; 0 if frames are only read
  bool finds_camera = false;  ///< whether the camera path must be computed from all frames before drawing begins
  std::optional<render::CameraPath> camera = {};  ///< computed from frames of a cache
  std::string camera_frames = {};                 ///< numbers of these frames; empty: all frames of the scene
  OutputTarget target;
  render::Settings settings;
  std::vector<std::string> objects;  ///< names of all objects
  Drawn drawn = {};                  ///< output of the earlier run that is resumed

  bool blurs = false;  ///< whether pictures may need the previous frame, for motion blur

  bool draws() const { return target.kind != Kind::none; }
  /// Whether the painter needs the previous frame.
  bool needs_motion() const { return draws() && (settings.layers || blurs); }

  /// Plans to make all frames, not only the wanted ones, so that the computed camera does not
  /// depend on --frames.
  void make_all(const scene::Scene& of) {
    made = {0, of.frame_count(), 1};
    simulated = of.preroll_frames() + made.count();
  }

  /// Metadata of the pictures. `gl`: description of OpenGL.
  Metadata metadata(const std::string& gl) const {
    Metadata entries = describe_pictures(scene, settings, gl);
    if (!camera_frames.empty()) entries["camera_frames"] = camera_frames;
    return entries;
  }

  /// What an earlier run has drawn of this film.
  Drawn find_drawn(const fs::path& meshes) const {
    return cli::find_drawn(target, wanted, settings, metadata(""), meshes, objects);
  }

  /// Path of the effective scene (checked, with all defaults), beside the output.
  fs::path effective_scene_file() const {
    const fs::path file = target.file(wanted.begin);
    return file.parent_path() / ((target.kind == Kind::video ? file.stem().string() : scene.scene) + ".effective.toml");
  }
};

bool finds_camera(const scene::Scene& scene, const std::string& name) {
  for (const scene::Camera& camera : scene.cameras)
    if (name.empty() || camera.name == name) return scene::is_computed(camera.kind);
  return true;
}

/// Warns of odd sizes before the run starts.
void warn_of_odd_size(const FilmPlan& plan, video::Codec codec) {
  const int width = plan.settings.width, height = plan.settings.height;
  const bool any_size = codec == video::Codec::ffv1 || codec == video::Codec::h264_lossless;
  if (any_size || (width % 2 == 0 && height % 2 == 0)) return;
  log::warn(
      fmt::format("{}x{}: expected an even width and height for this kind of video; the video gets {}x{}, with a "
                  "column or row repeated",
                  width, height, width + width % 2, height + height % 2));
}

/// Sets the target and the settings that depend on it. Throws Error(usage) if options do not fit the target, and
/// Error(output_failed) if videos cannot have the frame rate.
void take_output(FilmPlan& plan, const RunOptions& options) {
  plan.target = parse_output(options.output, plan.scene.scene);
  plan.settings.layers = plan.target.layered();
  plan.settings.needs_image16 = options.depth == 16;
  const bool video = plan.target.kind == Kind::video;
  if (options.depth == 16 && (video || plan.settings.layers))
    throw Error(ExitCode::usage, "--depth: expected pictures (.png), got {}", plan.target.text);
  if (!video && options.video.any())
    throw Error(ExitCode::usage, "--codec, --crf: expected a video, got {}", plan.target.text);
  if (!video) return;
  video::frame_rate(plan.scene.fps / plan.wanted.step);
  plan.target.codec = codec_of(plan.target.text, options.video);
  warn_of_odd_size(plan, plan.target.codec);
}

FilmPlan plan_of(const scene::Scene& scene, const RunOptions& options) {
  if ((options.error || options.mesh_error) && scene.cloths.empty())
    throw Error(ExitCode::usage, "--error: the scene has no cloth or rope, whose error could be estimated");
  FilmPlan plan;
  plan.settings = render_settings(scene, options.common);
  plan.scene = manifest_of(scene, plan.settings);
  plan.scene_text = scene::effective_scene(scene);
  plan.wanted = resolve_frames(options.frames, scene.frame_count());
  plan.made = {0, plan.wanted.last() + 1, 1};
  plan.simulated = scene.preroll_frames() + plan.made.count();
  plan.finds_camera = finds_camera(scene, plan.settings.camera);
  plan.blurs = plan.settings.motion_blur.value_or(scene.render.motion_blur) > 0;
  for (const scene::Cloth& cloth : scene.cloths) plan.objects.push_back(cloth.name);
  for (const scene::Obstacle& obstacle : scene.obstacles) plan.objects.push_back(obstacle.name);
  for (const scene::Character& character : scene.characters) plan.objects.push_back(character.name);
  return plan;
}

FilmPlan plan_of(const cache::Reader& reader, const RenderOptions& options) {
  FilmPlan plan;
  plan.scene = reader.manifest();
  plan.scene_text = reader.scene_text();
  if (!options.common.camera.empty()) check_camera(plan.scene.cameras, options.common.camera);
  plan.settings = render_settings({plan.scene.width, plan.scene.height}, plan.scene.camera, options.common);
  plan.wanted = plan.made = cached_frames(reader, options.frames, options.partial);
  take_output(plan, options);
  const frame::SnapshotPtr first = reader.snapshot(plan.wanted.begin);
  if (render::CameraPath::is_computed(*first, plan.settings.camera)) {
    plan.camera_frames = show_frames(reader, plan.camera.emplace(plan.settings.camera, plan.settings.aspect()));
    plan.camera->compute_cameras();
  }
  plan.blurs = plan.settings.motion_blur.value_or(first->stage->motion_blur) > 0;
  if (plan.needs_motion()) check_frame_before(reader, plan.wanted);
  for (const frame::ObjectInfo& object : plan.scene.objects) plan.objects.push_back(object.name);
  return plan;
}

void add_outputs(PathLedger& paths, const FilmPlan& plan, const RunOptions& options) {
  if (plan.draws()) {
    paths.writes("-o", plan.target.text, plan.target.files(plan.wanted));
    if (plan.target.kind == Kind::video) paths.writes("-o", video::partial_name(plan.target.file(0)));
    paths.writes_content("-o, for the effective scene,", plan.effective_scene_file(), plan.scene_text);
  }
  if (!options.meshes.empty())
    paths.writes("--meshes", options.meshes, mesh_files(options.meshes, plan.objects, plan.wanted));
  if (!options.stats.empty()) paths.writes("--stats", options.stats);
  if (!options.log_json.empty() && options.log_json != "-") paths.writes("--log-json", options.log_json);
}

/// Removes the frames that an earlier run has kept instead of this video. With --overwrite, also removes pictures and
/// meshes of other frames, which an earlier run of a longer scene has left. Keeps these if --frames or --partial
/// selects a part of the film, since other commands may write the other frames, or have written them.
void remove_stale(const FilmPlan& plan, const RunOptions& options) {
  if (plan.target.kind == Kind::video) remove_kept_frames(plan.target.file(0), plan.scene.scene);
  const bool whole = options.frames.selects_all() && plan.wanted.count() == plan.scene.frame_count;
  if (!options.common.overwrite || !whole) return;
  const auto is_picture = [&](const fs::path& file, int frame) { return is_picture_of(file, plan.scene.scene, frame); };
  if (plan.target.kind == Kind::images) FramePattern(plan.target.text).remove_others(plan.wanted, is_picture);
  if (options.meshes.empty()) return;
  const auto is_mesh = [](const fs::path& file, int) { return is_own_mesh(file); };
  for (const std::string& object : plan.objects) mesh_files(options.meshes, object).remove_others(plan.wanted, is_mesh);
}

/// Carries out a FilmPlan for any of the three commands, and reports the results.
class Session {
 public:
  explicit Session(const RunOptions& options) : options_(options) { set_thread_count(options.common.threads); }

  const std::atomic<bool>& stop() const { return signals_.requested(); }
  bool wants_error() const { return options_.error || options_.mesh_error; }
  Progress& progress() { return *progress_; }

  /// Opens the log and begins the report. Call it after all checks that may refuse the command.
  void begin(const FilmPlan& plan);
  void make(const FilmPlan& plan, FilmParts parts);
  /// If the run is complete, estimates its error from companion runs (run_error/companions.hpp).
  void estimate_error(const scene::Scene& scene, run_error::Recorder& recorder);
  /// Writes all reports. After an early end, also prints how to continue. Returns the exit code.
  ExitCode end(const FilmPlan& plan, const Store* store);

 private:
  void sum_up(const FilmPlan& plan, FilmResult result);
  void end_early(const FilmPlan& plan, const Store* store);
  template <class Write>
  void try_side_file(const Write& write);

  const RunOptions& options_;
  const WallTimer wall_;
  const double cpu_ = thread_cpu_seconds();
  const StopSignals signals_;
  std::optional<EventLog> log_;
  std::optional<Progress> progress_;
  RunReport report_;
};

void Session::begin(const FilmPlan& plan) {
  log_.emplace(options_.log_json);
  report_.setup = {wall_.seconds(), thread_cpu_seconds() - cpu_};
  report_.scene = plan.scene.scene;
  report_.scene_file = options_.common.scene.string();
  report_.scene_hash = plan.scene.scene_hash;
  report_.threads = thread_count();
  report_.width = plan.draws() ? plan.settings.width : 0;
  report_.height = plan.draws() ? plan.settings.height : 0;
  report_.fps = plan.scene.fps;
  report_.output = plan.target.text;
  report_.wanted = plan.wanted;
  report_.replayed = plan.simulated == 0;
  log_->write("scene_loaded", {{"scene", report_.scene},
                               {"scene_file", report_.scene_file},
                               {"scene_hash", fmt::format("{:016x}", report_.scene_hash)},
                               {"frames", plan.scene.frame_count},
                               {"fps", plan.scene.fps}});
}

void Session::make(const FilmPlan& plan, FilmParts parts) {
  if (plan.draws()) {
    parts.open_painter = [&] {
      std::unique_ptr<FramePainter> painter = make_gl_painter(plan.settings);
      if (plan.camera) painter->set_camera_path(*plan.camera);
      return painter;
    };
    parts.open_writer = [&](const std::string& gl) {
      return make_writer({plan.target, plan.wanted, plan.settings.width, plan.settings.height, plan.scene.fps,
                          options_.depth, options_.video.crf, plan.metadata(gl)});
    };
  }
  if (plan.draws() && plan.finds_camera) parts.camera.emplace(plan.settings.camera, plan.settings.aspect());
  parts.motion = plan.needs_motion();
  parts.meshes = options_.meshes;
  parts.drawn = plan.drawn.frames;
  const int drawn = plan.draws() ? plan.wanted.count() - static_cast<int>(parts.drawn.size()) : 0;
  progress_.emplace(options_.common.progress, StageCounts{plan.simulated, drawn, drawn});
  FilmResult result = make_film(parts, plan.made, plan.wanted, stop(), *progress_, *log_);
  progress_.reset();
  sum_up(plan, std::move(result));
}

void Session::estimate_error(const scene::Scene& scene, run_error::Recorder& recorder) {
  if (report_.exit_code != ExitCode::ok) return;
  log::info("simulating comparison runs to estimate the error");
  const production::SceneSimulation particles(scene);
  const run_error::CompanionOptions options{.mesh = options_.mesh_error, .proceed = [this] { return !stop(); }};
  try {
    report_.error = run_error::estimate_error(scene, recorder.finish(particles.state().masses), options);
  } catch (const Error& error) {
    report_.exit_code = error.code();
    report_.message = fmt::format("the error is not known: {}", error.what());
  }
}

void Session::sum_up(const FilmPlan& plan, FilmResult result) {
  report_.objects = std::move(result.objects);
  report_.particles = count_particles(report_.objects);
  report_.cloth_size = result.cloth_size;
  report_.setup += result.setup;
  report_.frames = std::move(result.frames);
  report_.written = result.written;
  report_.gl = result.painter;
  // The frames of an unfinished video do not count as written. Pictures count, since each written picture is complete.
  if (plan.target.kind == Kind::video && !result.finished_output) {
    report_.written = 0;
    for (FrameRecord& record : report_.frames) record.written = false;
  } else if (plan.target.kind == Kind::video) {
    std::error_code error;
    const std::uintmax_t bytes = fs::file_size(plan.target.file(0), error);
    report_.output_bytes = error ? 0 : bytes;
  }
  if (result.failure) {
    const Failure failure = report_.replayed ? describe_replay_failure(result.failure, options_.common.scene.string())
                                             : describe_failure(result.failure);
    report_.exit_code = failure.code;
    report_.message =
        failure.code == ExitCode::simulation_failed ? "the simulation failed: " + failure.text : failure.text;
  } else if (result.interrupted) {
    report_.exit_code = ExitCode::interrupted;
    // If the camera is computed, frames are drawn after the last one is made.
    const bool is_drawn_later = plan.draws() && plan.finds_camera;
    const auto last = std::ranges::find_if(report_.frames.rbegin(), report_.frames.rend(),
                                           [&](const FrameRecord& r) { return !is_drawn_later || r.written; });
    const FrameRecord& record = last == report_.frames.rend() ? report_.frames.back() : *last;
    report_.message = fmt::format("interrupted after frame {} of {}", record.report.frame, plan.wanted.last());
  }
}

void Session::end_early(const FilmPlan& plan, const Store* store) {
  std::error_code ignored;
  // The user may have removed the output in the meantime.
  const fs::path place =
      fs::absolute(plan.draws() ? plan.target.file(plan.wanted.begin) : fs::path(report_.output), ignored);
  const int written = plan.draws() ? report_.written : static_cast<int>(report_.frames.size());
  const int kept = fs::exists(plan.draws() ? place.parent_path() : place, ignored) ? written : 0;
  if (kept > 0)
    report_.message += fmt::format("; {} frame{} kept in {}", kept, kept == 1 ? " is" : "s are", report_.output);
  else
    report_.message += written > 0 ? "; no frame is kept" : "; no frame was written";
  // Does not suggest --resume after a failed simulation, which would fail again at the same frame.
  if (store != nullptr && store->can_resume() && report_.exit_code != ExitCode::simulation_failed &&
      fs::exists(store->folder(), ignored))
    report_.message += "; the same command with --resume continues from there";
}

// Writes side files (effective scene, statistics, log) first, since a failure to write them changes the exit code.
// Prints the message last, where users see it.
ExitCode Session::end(const FilmPlan& plan, const Store* store) {
  if (report_.exit_code != ExitCode::ok) end_early(plan, store);
  if (store != nullptr) {
    report_.cache = store->time();
    report_.cache_bytes = store->bytes();
  }
  report_.warnings = log::warnings();
  report_.notes = log::notes();
  for (std::string& warning : find_warnings(report_.frames)) report_.warnings.push_back(std::move(warning));
  report_.wall_s = wall_.seconds();
  report_.cpu_s = process_cpu_seconds();
  report_.peak_memory = peak_memory_bytes();
  try_side_file([&] {
    if (report_.written > 0 && plan.draws()) write_file(plan.effective_scene_file(), plan.scene_text);
  });
  try_side_file([&] {
    if (!options_.stats.empty()) write_file(options_.stats, json_text(stats_json(report_), 2) + "\n");
  });
  log_->write("finished", {{"exit_code", static_cast<int>(report_.exit_code)},
                           {"message", report_.message},
                           {"output", report_.output},
                           {"frames_written", report_.written},
                           {"frames_simulated", report_.frames.size()},
                           {"wall_s", report_.wall_s},
                           {"cpu_s", report_.cpu_s}});
  try_side_file([&] { log_->check(); });
  if (!report_.frames.empty()) log::info(summary(report_));
  if (!report_.message.empty()) log::info("weft: " + report_.message);
  if (report_.exit_code == ExitCode::ok) remove_stale(plan, options_);
  return report_.exit_code;
}

template <class Write>
void Session::try_side_file(const Write& write) {
  try {
    write();
  } catch (...) {
    const Failure failure = describe_failure(std::current_exception());
    log::info("weft: " + failure.text);
    if (report_.exit_code == ExitCode::ok) report_.exit_code = failure.code;
  }
}

// Prints which reports a command with --resume does not make because its output is complete already. Does not list
// statistics of the same scene: the run that completed the output has written them.
void note_missing_reports(const FilmPlan& plan, const RunOptions& options) {
  std::vector<std::string> missing;
  const std::string hash = fmt::format("{:016x}", plan.scene.scene_hash);
  if (!options.stats.empty() && value_or(read_json_or_null(options.stats), "scene_hash", std::string()) != hash)
    missing.push_back(fmt::format("{} is not written", options.stats.string()));
  std::error_code ignored;
  if (!options.log_json.empty() && !fs::exists(options.log_json, ignored))
    missing.push_back(options.log_json == "-" ? "no event is logged" : options.log_json + " is not written");
  if (options.error || options.mesh_error) missing.emplace_back("the error is not estimated");
  if (missing.empty()) return;
  log::info(fmt::format("note: {}, since nothing is made again; --overwrite instead of --resume makes everything again",
                        fmt::join(missing, ", ")));
}

/// Simulates the frames that `store` does not have yet, and carries out the plan.
ExitCode make_from_scene(Session& session, const scene::Scene& scene, const FilmPlan& plan, const PathLedger& paths,
                         Store& store) {
  if (!store.resumes()) store.clear();
  store.note_outputs(paths.outputs());
  session.begin(plan);
  FilmParts parts;
  parts.open_source = [&] { return std::make_unique<SceneSource>(scene, store, session.stop(), session.progress()); };
  parts.store = &store;
  std::optional<run_error::Recorder> recorder;
  if (session.wants_error())
    parts.on_frame = [&](const MadeFrame& made) {
      if (recorder)
        recorder->add_frame(made.snapshot, made.report);
      else
        recorder.emplace(scene, *made.snapshot, made.report);
    };
  session.make(plan, std::move(parts));
  if (recorder) session.estimate_error(scene, *recorder);
  return session.end(plan, &store);
}

}  // namespace

// Simulates, draws and writes at the same time. Keeps the simulated frames in a cache until the output is complete.
ExitCode run(const RunOptions& options) {
  Session session(options);
  const scene::Scene scene = load_scene(options.common);
  FilmPlan plan = plan_of(scene, options);
  take_output(plan, options);
  if (plan.finds_camera) plan.make_all(scene);
  PathLedger paths;
  add_inputs(paths, scene);
  add_outputs(paths, plan, options);
  const fs::path cache = working_cache(plan.target, scene.name);
  paths.register_output_folder("-o, for its working cache,", cache);
  const bool overwrite = options.common.overwrite;
  if (options.resume && !overwrite && !cache::is_cache(cache) &&
      plan.find_drawn(options.meshes).is_whole(plan.wanted)) {
    if (fs::exists(cache)) cache::Lock(cache).remove();  // an earlier run was killed while it removed this cache
    log::info(fmt::format("note: {} is complete already: frames {}", plan.target.text, plan.wanted.text()));
    note_missing_reports(plan, options);
    return ExitCode::ok;
  }
  if (!options.resume) paths.check_absent(overwrite);
  paths.check_writable();
  // If the camera path is computed, pictures are drawn from the store, so the run must end if the store fails.
  Store store(cache, plan.finds_camera ? Store::Need::required : Store::Need::helpful, plan.scene, plan.scene_text);
  if (options.resume) {
    store.find_start();
    paths.check_absent(overwrite, store.outputs(),
                       [&](const fs::path& file) { return is_output_of(file, scene.name) || store.holds_scene(file); });
  } else if (store.has_leftover()) {
    log::info(fmt::format("note: {} frames of an unfinished run are discarded; --resume would have continued it",
                          store.leftover_frames()));
  }
  const ExitCode code = make_from_scene(session, scene, plan, paths, store);
  if (code == ExitCode::ok) store.remove();
  return code;
}

ExitCode simulate(const SimulateOptions& options) {
  Session session(options);
  const scene::Scene scene = load_scene(options.common);
  FilmPlan plan = plan_of(scene, options);
  plan.target = {Kind::none, options.cache.string()};
  PathLedger paths;
  add_inputs(paths, scene);
  paths.register_output_folder("--cache", options.cache);
  add_outputs(paths, plan, options);
  Store store(options.cache, Store::Need::required, plan.scene, plan.scene_text);
  if (options.resume) store.find_start();
  if (store.has_leftover() && !options.common.overwrite && !options.resume)
    throw Error(ExitCode::output_failed,
                "{}: holds a cache already; give --resume to continue it, --overwrite to start again, or another name",
                options.cache.string());
  paths.check_absent(options.common.overwrite, options.resume ? store.outputs() : std::set<std::string>{},
                     [&](const fs::path& file) { return is_output_of(file, scene.name); });
  paths.check_writable();
  if (store.resumes() && store.holds(plan.wanted.last()))
    log::info(fmt::format("note: {} is complete already: frames 0:{}", options.cache.string(), plan.made.end));
  return make_from_scene(session, scene, plan, paths, store);
}

// Draws the frames of a cache. Several processes may draw different frames at the same time.
ExitCode render(const RenderOptions& options) {
  Session session(options);
  const cache::Reader reader(options.common.scene);
  FilmPlan plan = plan_of(reader, options);
  if (options.resume) {
    plan.drawn = plan.find_drawn(options.meshes);
    const bool whole = plan.drawn.is_whole(plan.wanted);
    if (!plan.drawn.frames.empty())
      log::info(fmt::format("note: {} is {}: frames {}", plan.target.text, whole ? "complete already" : "there in part",
                            frames_text({plan.drawn.frames.begin(), plan.drawn.frames.end()})));
    if (whole) {
      note_missing_reports(plan, options);
      return ExitCode::ok;
    }
    // The earlier command has left its reports and, if the disk was full, the frames of its video.
    const fs::path kept = video::partial_name(plan.target.file(plan.wanted.begin));
    for (const fs::path& file : {options.stats, fs::path(options.log_json), kept})
      if (is_output_of(file, plan.scene.scene)) plan.drawn.own.insert(file);
  }
  PathLedger paths;
  paths.reads_folder(options.common.scene, "the cache");
  add_outputs(paths, plan, options);
  paths.check_absent(options.common.overwrite, paths.outputs(),
                     [&](const fs::path& file) { return plan.drawn.own.contains(file); });
  paths.check_writable();
  session.begin(plan);
  FilmParts parts;
  parts.open_source = [&] { return std::make_unique<CacheSource>(reader, plan.made); };
  parts.keeps_partial_output = false;
  session.make(plan, std::move(parts));
  return session.end(plan, nullptr);
}

}  // namespace weft::cli
