#include <fmt/format.h>

#include <cstdio>

#include "cli/commands.hpp"
#include "cli/scene_input.hpp"
#include "cli/table.hpp"
#include "core/log.hpp"
#include "scene/loader.hpp"
#include "simulation/simulation.hpp"

namespace weft::cli {
namespace {

std::string plan_table(const scene::Scene& scene) {
  std::vector<std::vector<std::string>> rows;
  for (const bool used : {true, false}) {
    for (const simulation::PlanItem& item : simulation::plan(scene)) {
      if (item.used == used) rows.push_back({used ? "uses" : "leaves out", item.part, item.reason});
    }
  }
  return format_table(rows, "lll", 2);
}

}  // namespace

ExitCode check(const CheckOptions& options) {
  ExitCode code = ExitCode::ok;
  for (const std::filesystem::path& file : options.scenes) {
    const scene::LoadResult loaded = scene::load(file, options.overrides);
    if (!loaded.ok()) {
      log::info(mistakes_text(loaded));
      code = ExitCode::scene_invalid;
      continue;
    }
    fmt::print("{}: ok: {}\n", file.string(), describe_scene(loaded.scene));
    if (options.plan) fmt::print("{}", plan_table(loaded.scene));
  }
  if (std::fflush(stdout) != 0) throw Error(ExitCode::output_failed, "standard output cannot be written");
  return code;
}

}  // namespace weft::cli
