#include "tools/cli/sweep_jobs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include "core/error.hpp"
#include "core/json.hpp"
#include "core/temporary_file.hpp"
#include "tools/cli/own_files.hpp"
#include "tools/cli/scene_input.hpp"
#include "tools/review/find_runs.hpp"
#include "tools/review/output_folder.hpp"

namespace weft::cli {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

// Without --threads, on which results do not depend.
std::vector<std::string> options_of_results(std::vector<std::string> passed_on) {
  if (const auto threads = std::ranges::find(passed_on, "--threads"); threads != passed_on.end())
    passed_on.erase(threads, threads + std::min<std::ptrdiff_t>(2, passed_on.end() - threads));
  return passed_on;
}

}  // namespace

std::vector<std::string> SweepJob::overrides() const {
  std::vector<std::string> texts;
  for (const auto& [key, value] : run.changes) texts.push_back(fmt::format("{}={}", key, value));
  return texts;
}

bool SweepJob::is_done() const {
  const Json json = read_json_or_null(stats());
  const std::string hash = fmt::format("{:016x}", scene_hash);
  return fs::is_regular_file(video()) && value_or(json, "exit_code", -1) == 0 &&
         value_or(json, "scene_hash", std::string()) == hash && scene_hash_of(video()) == hash;
}

std::vector<SweepJob> read_sweep(const SweepOptions& options, PathLedger& paths) {
  const std::vector<Changes> list = options.list.empty() ? std::vector<Changes>{} : read_list(options.list);
  std::vector<SweepJob> jobs;
  for (SweepRun& run : plan_sweep(list, options.axes)) jobs.push_back({.run = std::move(run)});
  std::vector<std::string> mistakes;  // each text once, even if several runs have the same mistakes
  std::map<std::uint64_t, std::size_t> known;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    SweepJob& job = jobs[i];
    const scene::LoadResult loaded = scene::load(options.scene, job.overrides());
    if (!loaded.ok()) {
      const std::string text = mistakes_text(loaded);
      if (std::ranges::find(mistakes, text) == mistakes.end()) mistakes.push_back(text);
      continue;
    }
    job.scene_hash = loaded.scene.hash;
    job.scene = loaded.scene.name;
    job.frame_count = loaded.scene.frame_count();
    job.drawn.end = job.frame_count;
    const auto& cameras = loaded.scene.cameras;
    job.may_find_camera = cameras.empty() || std::ranges::any_of(cameras, scene::is_computed, &scene::Camera::kind);
    job.folder = options.output / job.run.name;
    const auto [first, is_new] = known.emplace(job.scene_hash, i);
    if (!is_new) job.equal_job = first->second;
    add_inputs(paths, loaded.scene);
  }
  if (!mistakes.empty()) throw Error(ExitCode::scene_invalid, "{}", fmt::join(mistakes, "\n"));
  if (!options.list.empty()) paths.reads(options.list, "the list of runs");
  return jobs;
}

void check_sweep_folder(const SweepOptions& options, PathLedger& paths, bool can_overwrite) {
  paths.register_output_folder("-o", options.output);
  const fs::path& folder = options.output;
  review::check_replaceable(folder / "page", true);
  for (const char* name : {"table.csv", "table.md", "sheet.png", review::kSweepName})
    if (!fs::exists(fs::symlink_status(folder / name))) protect_missing_file(folder / name);
  if (!fs::exists(folder) || fs::is_empty(folder)) return;
  const Json before = read_json_or_null(folder / review::kSweepName);
  if (!before.is_object() || !before.contains("runs") || !before.contains("options"))
    throw Error(ExitCode::output_failed, "{}: is no folder of a sweep, and not empty; give another name",
                folder.string());
  std::vector<std::string> words;
  for (const Json& word : before["options"]) words.push_back(word.is_string() ? word.get<std::string>() : word.dump());
  words = options_of_results(std::move(words));
  if (!options.overwrite && words != options_of_results(options.passed_on))
    throw Error(ExitCode::output_failed, "{}: holds runs with other options ({}); give the same options{} another name",
                folder.string(), fmt::join(words, " "), can_overwrite ? ", --overwrite to start again, or" : " or");
}

void write_sweep_index(const SweepOptions& options, const std::vector<SweepJob>& jobs) {
  Json runs = Json::array();
  for (const SweepJob& job : jobs) {
    Json set = Json::object();
    for (const auto& [key, value] : job.run.changes) set[key] = value;
    runs.push_back({{"folder", (job.equal_job ? jobs[*job.equal_job] : job).run.name},
                    {"scene", job.scene},
                    {"simulated_frames", job.simulated_count()},
                    {"drawn_frames", job.drawn.count()},
                    {"set", std::move(set)}});
  }
  const Json index{{"scene", options.scene.string()}, {"options", options.passed_on}, {"runs", std::move(runs)}};
  write_file(options.output / review::kSweepName, json_text(index, 2) + "\n");
}

}  // namespace weft::cli
