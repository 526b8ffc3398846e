#include <fmt/format.h>

#include <algorithm>

#include "core/archive.hpp"
#include "core/isolated.hpp"
#include "core/log.hpp"
#include "core/parallel.hpp"
#include "core/progress.hpp"
#include "core/temporary_file.hpp"
#include "core/timer.hpp"
#include "film/scene/loader.hpp"
#include "lab/bench/accuracy_report.hpp"
#include "lab/bench/fabrics.hpp"
#include "lab/bench/html.hpp"
#include "lab/bench/report.hpp"
#include "lab/bench/scene_stability_report.hpp"
#include "lab/bench/speed_report.hpp"
#include "lab/bench/stability.hpp"
#include "tools/cli/bench_peer.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/path_ledger.hpp"
#include "tools/cli/scene_input.hpp"
#include "tools/cli/signals.hpp"
#include "tools/cli/stages.hpp"
#include "tools/cli/standard_output.hpp"
#include "tools/cli/system_info.hpp"

namespace weft::cli {
namespace {

bench::Outcome try_case(const bench::ExtremeCase& extreme) {
  scene::LoadResult loaded = scene::load_text(extreme.text, extreme.name + ".toml");
  if (!loaded.ok()) throw Error(ExitCode::internal, "{}", loaded.describe());
  return bench::try_scene(loaded.scene, extreme.frames, extreme.driven);
}

bench::Table try_cases(const std::filesystem::path& folder, bench::Tally& count) {
  bench::Table table{{"case", "what", "verdict", "frames", "steps", "rejected", "Newton a step", "energy gain",
                      "max speed m/s", "CPU s", "reason"}};
  for (const bench::ExtremeCase& extreme : bench::extreme_cases()) {
    write_file(folder / "scenes" / (extreme.name + ".toml"), extreme.text);
    const bench::Outcome o = try_case(extreme);
    count.add(o.verdict);
    log::info(fmt::format("{}: {}{}{}", extreme.name, describe(o.verdict), o.reason.empty() ? "" : ": ", o.reason));
    table.push_back({extreme.name, extreme.what, std::string(describe(o.verdict)),
                     fmt::format("{} of {}", o.frames, extreme.frames), std::to_string(o.steps),
                     std::to_string(o.rejected_steps),
                     fmt::format("{:.1f}", static_cast<double>(o.newton_iterations) / std::max(1, o.steps)),
                     fmt::format("{:.2g}", o.energy_gain), fmt::format("{:.3g}", o.max_speed),
                     fmt::format("{:.2f}", o.cpu_s), o.reason});
  }
  return table;
}

void check_outputs(PathLedger& paths, const BenchOptions& options, const std::filesystem::path& folder,
                   const std::vector<std::string>& names) {
  for (const std::string& name : names) paths.writes("-o", folder / name);
  paths.check_absent(options.overwrite);
  paths.check_writable();
}

ExitCode bench_stability(const BenchOptions& options, const std::filesystem::path& folder) {
  PathLedger paths;
  std::vector<std::string> names{"stability.md", "stability_map.csv", "stability_map.svg", "stability_cases.csv"};
  for (const bench::ExtremeCase& extreme : bench::extreme_cases()) names.push_back("scenes/" + extreme.name + ".toml");
  check_outputs(paths, options, folder, names);
  bench::Tally map_count, case_count;
  log::info("stability: the map");
  double map_cpu_s = 0;
  const auto cells = bench::stability_map([&](const bench::MapCell& cell) {
    map_count.add(cell.outcome.verdict);
    map_cpu_s += cell.outcome.cpu_s;
    log::info(fmt::format("stability: {}, {:g} N/m, {:g} s: {}, {:.1f} CPU s", name_of(cell.integrator), cell.stiffness,
                          cell.step, describe(cell.outcome.verdict), cell.outcome.cpu_s));
  });
  log::info("stability: extreme cases");
  const bench::Table cases = try_cases(folder, case_count);
  const bench::Table map = bench::map_table(cells);
  write_file(folder / "stability_map.csv", bench::csv(map));
  write_file(folder / "stability_map.svg", bench::map_svg(cells));
  write_file(folder / "stability_cases.csv", bench::csv(cases));
  write_file(folder / "stability.md",
             fmt::format("# Stability\n\nA sheet of 11 × 11 particles held at two corners, two swings or 25,000 steps: "
                         "{}; {:.0f} CPU s.\n\n![map](stability_map.svg)\n\n## Extreme cases\n\n{}. The scenes are in "
                         "`scenes/`; energy gain is relative to the allowed gain.\n\n{}\n## The map\n\n{}",
                         map_count.text(), map_cpu_s, case_count.text(), bench::markdown(cases), bench::markdown(map)));
  print("map: {}\ncases: {}\nwritten to {}\n", map_count.text(), case_count.text(), (folder / "stability.md").string());
  return map_count.wrong() + case_count.wrong() > 0 ? ExitCode::internal : ExitCode::ok;
}

/// Reads the scene that the options name. If they name none, reads the built-in scene `text`; messages call it `name`.
/// `more`: additional overrides.
scene::Scene scene_of(const BenchOptions& options, const char* text, const char* name,
                      const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides = options.overrides;
  overrides.insert(overrides.end(), more.begin(), more.end());
  scene::LoadResult loaded =
      options.scene.empty() ? scene::load_text(text, name, overrides) : scene::load(options.scene, overrides);
  if (!loaded.ok()) throw Error(ExitCode::scene_invalid, mistakes_text(loaded));
  return std::move(loaded.scene);
}

void check_moves(const scene::Scene& scene) {
  if (scene.frame_count() < 2)
    throw Error(
        ExitCode::scene_invalid,
        "{}: time.duration: expected at least one frame after frame 0, at which errors are measured, got {:g} s",
        scene.file.string(), scene.time.duration);
}

std::string title_of(const scene::Scene& scene) {
  return scene.title.empty() ? scene.name : scene.title;
}

// Prints each run and the remaining time.
class RunProgress {
 public:
  explicit RunProgress(std::string name) : name_(std::move(name)) {}

  /// `done`: fraction of all work.
  void operator()(double done, const std::string& run) {
    remaining_.sample(timer_.seconds(), {static_cast<int>(done * kUnits), 0, 0});
    const auto left = remaining_.seconds();
    log::info(fmt::format("{}: {:3.0f} %, {}{}", name_, 100 * done, run,
                          left ? fmt::format(", about {} left", format_duration(*left)) : ""));
  }

 private:
  std::string name_;
  static constexpr int kUnits = 100'000;
  WallTimer timer_;
  RemainingTime remaining_{{kUnits, 0, 0}};
};

// Lists the factors that are not 1, for example "friction 2, step 0.5".
std::string describe(const bench::Factors& factors) {
  std::string text;
  for (std::size_t a = 0; a < bench::kVariedValues; ++a)
    if (factors[a] != 1)
      text += fmt::format("{}{} {:g}", text.empty() ? "" : ", ", name_of(static_cast<bench::VariedParameter>(a)),
                          factors[a]);
  return text.empty() ? "as it is" : text;
}

ExitCode bench_scene_stability(const BenchOptions& options, const std::filesystem::path& folder) {
  const scene::Scene scene = scene_of(options, nullptr, nullptr);
  check_moves(scene);
  const std::string name = "stability_" + scene.name, picture = name + ".svg", title = title_of(scene);
  PathLedger paths;
  add_inputs(paths, scene);
  check_outputs(paths, options, folder, {name + ".md", name + ".html", name + ".csv", picture});
  const StopSignals signals("the finished measurements are written");
  RunProgress progress("stability");
  const bench::SceneStability stability = bench::measure_scene_stability(
      scene,
      [&](const bench::Trial& trial, double done) {
        progress(done,
                 fmt::format("{}: {}, {:.2f} CPU s", describe(trial.factors), describe(trial.verdict), trial.cpu_s));
      },
      [&] { return signals.requested().load(); });
  write_file(folder / (name + ".csv"), bench::csv(bench::trial_table(stability)));
  std::string plot = bench::trial_svg(title, stability);
  const std::string text = bench::scene_stability_markdown(title, stability, picture);
  write_file(folder / picture, plot);
  write_file(folder / (name + ".md"), text);
  write_file(folder / (name + ".html"), bench::html_page(title, text, [&](const std::string&) { return plot; }));
  print("{}\nwritten to {}\n", bench::margin_sentence(stability), (folder / (name + ".html")).string());
  return signals.requested() ? ExitCode::interrupted : ExitCode::ok;
}

ExitCode bench_accuracy(const BenchOptions& options, const std::filesystem::path& folder) {
  const scene::Scene scene = scene_of(options, bench::kSwingingSheet, "swinging_sheet.toml");
  check_moves(scene);
  const std::string name = "accuracy_" + scene.name, title = title_of(scene);
  const std::string work = name + ".svg", settings = name + "_settings.svg";
  PathLedger paths;
  if (!options.scene.empty()) add_inputs(paths, scene);
  check_outputs(paths, options, folder, {name + ".md", name + ".html", name + ".csv", work, settings});
  // Uses one thread, so that CPU seconds are comparable between machines.
  set_thread_count(1);
  RunProgress progress("accuracy");
  const auto report = [&](const bench::Run& run, double done) {
    progress(done, fmt::format("{}, {:.3g} {}: {}", name_of(run.setting.integrator),
                               run.setting.tolerance ? 1e3 * *run.setting.tolerance : 1e3 * run.setting.step,
                               run.setting.tolerance ? "mm" : "ms",
                               run.failed() ? run.failure : fmt::format("{:.2f} CPU s", run.work.cpu_s)));
  };
  const bench::Accuracy accuracy = bench::measure_accuracy(scene, report, options.plan);
  const std::string work_plot = bench::work_svg(title, accuracy), settings_plot = bench::settings_svg(title, accuracy);
  const std::string text = bench::accuracy_markdown(title, accuracy, work, settings);
  write_file(folder / (name + ".csv"), bench::csv(bench::accuracy_table(accuracy)));
  write_file(folder / work, work_plot);
  write_file(folder / settings, settings_plot);
  write_file(folder / (name + ".md"), text);
  write_file(folder / (name + ".html"), bench::html_page(title, text, [&](const std::string& plot) {
               return plot == bench::link_to(work) ? work_plot : settings_plot;
             }));
  print("{}\n{}written to {}\n", bench::recommendation(accuracy), bench::conclusion(accuracy),
        (folder / (name + ".html")).string());
  return ExitCode::ok;
}

bench::SpeedFrames speed_frames(const BenchOptions& options, const scene::Scene& scene) {
  const bench::SpeedFrames usual;
  const int begin = options.frames.begin.value_or(usual.begin);
  if (options.frames.end || options.frames.begin) {
    const FrameRange range = resolve_frames({begin, options.frames.end, 1}, scene.frame_count());
    return {range.begin, range.end};
  }
  check_moves(scene);
  return {begin, std::min(usual.end, scene.frame_count())};
}

/// A planned run of `bench speed`.
struct PlannedRun {
  bench::SpeedSetting setting;
  std::vector<std::string> overrides;  ///< that apply the setting, besides those of --set
  scene::Scene scene;
};

/// Reads the scenes of all runs, so that mistakes are found before the first run.
std::vector<PlannedRun> plan_speed(const BenchOptions& options, const scene::Scene& scene) {
  const std::vector<int> all_cores = thread_count() > 1 ? std::vector{1, thread_count()} : std::vector{1};
  const bool fixed_size = !bench::has_sizes(scene);
  if (fixed_size) log::info("note: no cloth of the scene has particles to be set: it is measured at its own size");
  std::vector<PlannedRun> runs;
  for (const bench::SpeedSetting& setting :
       bench::speed_settings(fixed_size ? std::vector<double>{1} : options.sizes,
                             options.threads.empty() ? all_cores : options.threads, options.steps)) {
    const std::vector<std::string> overrides = bench::overrides_of(scene, setting);
    runs.push_back({setting, overrides, scene_of(options, bench::kSphereDrape, "sphere_drape.toml", overrides)});
  }
  return runs;
}

/// The runs to compare with the peer: each size once, on one thread.
std::vector<PlannedRun> plan_peer_runs(const BenchOptions& options, const std::vector<PlannedRun>& planned) {
  std::vector<PlannedRun> runs;
  for (const PlannedRun& run : planned) {
    if (options.peer.empty() || run.setting.step != 1) continue;
    if (!runs.empty() && runs.back().setting.size == run.setting.size) continue;
    runs.push_back(run);
    runs.back().setting.threads = 1;
  }
  return runs;
}

/// Opens the drawing of a run; empty without --draw.
std::function<bench::Drawing()> drawing_of(const PlannedRun& planned, const BenchOptions& options) {
  if (!options.drawing) return {};
  return [&planned, quality = *options.drawing]() -> bench::Drawing {
    SceneOptions drawing;
    drawing.quality = quality;
    drawing.threads = planned.setting.threads;
    const std::shared_ptr<FramePainter> painter = make_gl_painter(render_settings(planned.scene, drawing));
    return [painter](const frame::FrameSnapshot& snapshot) { painter->draw(snapshot, nullptr); };
  };
}

bench::SpeedRun run_alone(const PlannedRun& planned, const bench::SpeedFrames& frames,
                          const std::function<bench::Drawing()>& open_drawing, const std::atomic<bool>& stop) {
  const auto work = [&] {
    bench::SpeedRun run = bench::run_for_speed(planned.scene, planned.setting, frames, open_drawing);
    ByteWriter writer;
    serialize(writer, run);
    return writer.bytes;
  };
  bench::SpeedRun run;
  try {
    const std::string bytes = run_isolated(work, {.name = "the run", .stop = &stop});
    ByteReader reader{bytes};
    serialize(reader, run);
  } catch (const std::exception& error) {
    if (stop) throw;
    run.setting = planned.setting;
    run.failure = error.what();
  }
  return run;
}

std::string describe(const bench::SpeedRun& run) {
  const std::string setting = fmt::format("size {:g}, {} thread{}, step {:g}", run.setting.size, run.setting.threads,
                                          run.setting.threads == 1 ? "" : "s", run.setting.step);
  if (run.failed()) return fmt::format("{}: {}", setting, run.failure);
  return fmt::format("{}: {} particles, {:.4g} CPU ms a frame", setting, run.particles,
                     1e3 * run.all().cpu_s / run.frames);
}

/// Timed runs of each program at each size. The programs take turns, so that both are measured while the machine is
/// equally fast. One more run of each writes meshes.
constexpr int kPeerTurns = 3, kPeerRuns = 2 * (kPeerTurns + 1);

double median_of(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

/// Compares Weft with the peer in frames 1 to `end` - 1. `folder`: for the scene and the meshes.
bench::PeerRun compare_with_peer(const PlannedRun& planned, const BenchOptions& options, int end,
                                 const std::filesystem::path& folder, const std::atomic<bool>& stop) {
  const std::filesystem::path scene = options.scene.empty() ? folder / "sphere_drape.toml" : options.scene;
  const std::filesystem::path meshes = folder / "meshes";
  std::vector<std::string> arguments{scene.string(), "--end", std::to_string(end)};
  for (const auto* overrides : {&options.overrides, &planned.overrides})
    for (const std::string& change : *overrides) arguments.insert(arguments.end(), {"--set", change});
  bench::PeerRun result{.size = planned.setting.size};
  const auto run_weft = [&](const std::function<bench::Drawing()>& open_drawing) {
    const bench::SpeedRun run = run_alone(planned, {1, end}, open_drawing, stop);
    if (run.failed()) throw std::runtime_error("weft: " + run.failure);
    result.particles = run.particles;
    return 1e3 * run.all().cpu_s / run.frames;
  };
  const auto count_pairs_after = [&](const auto& run) {
    std::filesystem::remove_all(meshes);
    std::filesystem::create_directories(meshes);
    run();
    return count_pairs(meshes, planned.scene, end, stop);
  };
  try {
    if (options.scene.empty()) write_file(scene, bench::kSphereDrape);
    std::vector<double> weft_ms, peer_ms;
    for (int turn = 0; turn < kPeerTurns; ++turn) {
      weft_ms.push_back(run_weft({}));
      peer_ms.push_back(run_peer(options.peer, arguments, stop));
    }
    result.weft_ms = median_of(weft_ms);
    result.peer_ms = median_of(peer_ms);
    const bench::Drawing write_frame = [&](const frame::FrameSnapshot& snapshot) { write_meshes(meshes, snapshot); };
    result.weft_pairs = count_pairs_after([&] { run_weft([&] { return write_frame; }); });
    arguments.insert(arguments.end(), {"--meshes", meshes.string()});
    result.peer_pairs = count_pairs_after([&] { run_peer(options.peer, arguments, stop); });
  } catch (const std::exception& error) {
    if (stop) throw;
    result.failure = error.what();
  }
  return result;
}

std::string describe(const bench::PeerRun& run) {
  if (run.failed()) return fmt::format("size {:g} beside the peer: {}", run.size, run.failure);
  return fmt::format("size {:g}: {} particles, {:.4g} CPU ms a frame beside {:.4g} of the peer", run.size,
                     run.particles, run.weft_ms, run.peer_ms);
}

ExitCode bench_speed(const BenchOptions& options, const std::filesystem::path& folder) {
  if (!options.peer.empty()) check_peer(options.peer);
  const scene::Scene scene = scene_of(options, bench::kSphereDrape, "sphere_drape.toml");
  bench::SpeedReport report{title_of(scene),
                            fmt::format("{}, {} cores", cpu_model(), thread_count()),
                            speed_frames(options, scene),
                            {},
                            options.peer.filename().string()};
  const std::vector<PlannedRun> planned = plan_speed(options, scene), with_peer = plan_peer_runs(options, planned);
  const std::string name = "speed_" + scene.name, plot = name + ".svg";
  PathLedger paths;
  if (!options.scene.empty()) add_inputs(paths, scene);
  if (!options.peer.empty()) paths.reads(options.peer, "the peer");
  check_outputs(paths, options, folder, {name + ".md", name + ".csv", plot});
  const StopSignals signals("the finished measurements are written");
  RunProgress progress("speed");
  double all_work = 0, done = 0;
  for (const PlannedRun& run : planned) all_work += bench::expected_work(run.setting);
  for (const PlannedRun& run : with_peer) all_work += kPeerRuns * bench::expected_work(run.setting);
  try {
    for (const PlannedRun& run : planned) {
      report.runs.push_back(run_alone(run, report.frames, drawing_of(run, options), signals.requested()));
      // Writes the table after each run, so that an interruption loses no results.
      write_file(folder / (name + ".csv"), bench::csv(bench::speed_table(report.runs)));
      done += bench::expected_work(run.setting);
      progress(done / all_work, describe(report.runs.back()));
    }
    if (!with_peer.empty()) {
      const TemporaryName work(folder / (name + "_peer"), TemporaryName::Kind::folder);
      for (const PlannedRun& run : with_peer) {
        report.peer_runs.push_back(
            compare_with_peer(run, options, report.frames.end, work.path(), signals.requested()));
        done += kPeerRuns * bench::expected_work(run.setting);
        progress(done / all_work, describe(report.peer_runs.back()));
      }
    }
  } catch (const Error& error) {
    if (error.code() != ExitCode::interrupted) throw;
  }
  const std::size_t all = planned.size() + with_peer.size(), finished = report.runs.size() + report.peer_runs.size();
  if (!report.runs.empty()) {
    write_file(folder / plot, bench::speed_svg(report));
    write_file(folder / (name + ".md"), bench::speed_markdown(report, plot));
    print("{}written to {}\n", bench::conclusion(report.runs), (folder / (name + ".md")).string());
  }
  if (finished < all) {
    log::info(fmt::format("weft: interrupted after {} of {} runs", finished, all));
    return ExitCode::interrupted;
  }
  const auto all_failed = [](const auto& runs) {
    return !runs.empty() && std::ranges::all_of(runs, [](const auto& run) { return run.failed(); });
  };
  return all_failed(report.runs) || all_failed(report.peer_runs) ? ExitCode::simulation_failed : ExitCode::ok;
}

ExitCode bench_fabrics(const BenchOptions& options, const std::filesystem::path& folder) {
  PathLedger paths;
  check_outputs(paths, options, folder, {"fabrics.md", "fabrics.csv", "fabrics.svg"});
  RunProgress progress("fabrics");
  std::vector<bench::FabricRun> runs;
  for (const scene::Fabric& fabric : scene::fabrics()) {
    runs.push_back(bench::test_fabric(fabric, folder));
    progress(static_cast<double>(runs.size()) / static_cast<double>(scene::fabrics().size()),
             fmt::format("{}: drapes by {:.1f} %", fabric.material.fabric, 100 * runs.back().mean_drape()));
  }
  write_file(folder / "fabrics.csv", bench::csv(bench::fabrics_table(runs)));
  write_file(folder / "fabrics.svg", bench::fabrics_svg(runs));
  write_file(folder / "fabrics.md", bench::fabrics_markdown(runs, "fabrics.svg"));
  print("{}written to {}\n", bench::conclusion(runs), (folder / "fabrics.md").string());
  return ExitCode::ok;
}

}  // namespace

ExitCode bench(const BenchOptions& options) {
  const std::filesystem::path folder = options.output.empty() ? "output/bench" : options.output;
  switch (options.kind) {
    case BenchOptions::Kind::stability:
      return options.scene.empty() ? bench_stability(options, folder) : bench_scene_stability(options, folder);
    case BenchOptions::Kind::accuracy:
      return bench_accuracy(options, folder);
    case BenchOptions::Kind::speed:
      return bench_speed(options, folder);
    case BenchOptions::Kind::fabrics:
      return bench_fabrics(options, folder);
  }
  return ExitCode::internal;
}

}  // namespace weft::cli
