#include <fmt/format.h>

#include <cstdio>

#include "bench/accuracy_report.hpp"
#include "bench/report.hpp"
#include "bench/stability.hpp"
#include "cli/commands.hpp"
#include "cli/path_ledger.hpp"
#include "cli/scene_input.hpp"
#include "core/log.hpp"
#include "core/parallel.hpp"
#include "core/progress.hpp"
#include "core/temporary_file.hpp"
#include "core/timer.hpp"
#include "scene/loader.hpp"

namespace weft::cli {
namespace {

bench::Outcome try_case(const bench::ExtremeCase& extreme) {
  scene::LoadResult loaded = scene::load_text(extreme.text, extreme.name + ".toml");
  if (!loaded.ok()) throw Error(ExitCode::internal, "{}", loaded.describe());
  return bench::try_scene(loaded.scene, extreme.frames, extreme.limit);
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

/// Refuses before anything is measured.
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
  write_file(
      folder / "stability.md",
      fmt::format("# Stability\n\nA sheet of 11 × 11 particles held at two corners, two swings or 25,000 steps: {}; "
                  "{:.0f} CPU s.\n\n"
                  "![map](stability_map.svg)\n\n## Extreme cases\n\n{}. The scenes are in `scenes/`; energy gain "
                  "is in shares of what is allowed.\n\n{}\n## The map\n\n{}",
                  map_count.text(), map_cpu_s, case_count.text(), bench::markdown(cases), bench::markdown(map)));
  fmt::print("map: {}\ncases: {}\nwritten to {}\n", map_count.text(), case_count.text(),
             (folder / "stability.md").string());
  return map_count.wrong() + case_count.wrong() > 0 ? ExitCode::internal : ExitCode::ok;
}

scene::Scene scene_of(const BenchOptions& options) {
  scene::LoadResult loaded = options.scene.empty()
                                 ? scene::load_text(bench::kSwingingSheet, "swinging_sheet.toml", options.overrides)
                                 : scene::load(options.scene, options.overrides);
  if (!loaded.ok()) throw Error(ExitCode::scene_invalid, mistakes_text(loaded));
  return std::move(loaded.scene);
}

// Tells of each run, and how long the others will take.
class AccuracyProgress {
 public:
  void operator()(const bench::Run& run, double done) {
    remaining_.sample(timer_.seconds(), {static_cast<int>(done * kUnits), 0, 0});
    const auto left = remaining_.seconds();
    log::info(fmt::format("accuracy: {:3.0f} %, {}, {:.3g} {}: {}{}", 100 * done, name_of(run.setting.integrator),
                          run.setting.tolerance ? 1e3 * *run.setting.tolerance : 1e3 * run.setting.step,
                          run.setting.tolerance ? "mm" : "ms",
                          run.failed() ? run.failure : fmt::format("{:.2f} CPU s", run.work.cpu_s),
                          left ? fmt::format(", about {} left", format_duration(*left)) : ""));
  }

 private:
  static constexpr int kUnits = 100'000;
  WallTimer timer_;
  RemainingTime remaining_{{kUnits, 0, 0}};
};

ExitCode bench_accuracy(const BenchOptions& options, const std::filesystem::path& folder) {
  const scene::Scene scene = scene_of(options);
  if (scene.frame_count() < 2)
    throw Error(ExitCode::scene_invalid,
                "{}: time.duration: expected a frame after the start to measure at, got {:g} s", scene.file.string(),
                scene.time.duration);
  const std::string name = "accuracy_" + scene.name, title = scene.title.empty() ? scene.name : scene.title;
  const std::string work = name + ".svg", settings = name + "_settings.svg";
  PathLedger paths;
  if (!options.scene.empty()) add_inputs(paths, scene);
  check_outputs(paths, options, folder, {name + ".md", name + ".csv", work, settings});
  // So that CPU seconds mean the same everywhere.
  set_thread_count(1);
  AccuracyProgress progress;
  const bench::Accuracy accuracy = bench::measure_accuracy(scene, std::ref(progress));
  write_file(folder / (name + ".csv"), bench::csv(bench::accuracy_table(accuracy)));
  write_file(folder / work, bench::work_svg(title, accuracy));
  write_file(folder / settings, bench::settings_svg(title, accuracy));
  write_file(folder / (name + ".md"), bench::accuracy_markdown(title, accuracy, work, settings));
  fmt::print("{}written to {}\n", bench::conclusion(accuracy), (folder / (name + ".md")).string());
  return ExitCode::ok;
}

}  // namespace

ExitCode bench(const BenchOptions& options) {
  const std::filesystem::path folder = options.output.empty() ? "output/bench" : options.output;
  return options.kind == BenchOptions::Kind::accuracy ? bench_accuracy(options, folder)
                                                      : bench_stability(options, folder);
}

}  // namespace weft::cli
