#include <set>
#include <utility>

#include "cli/commands.hpp"
#include "cli/simulating.hpp"
#include "cli/stages.hpp"
#include "core/log.hpp"
#include "video/encoder.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

// Beside the output, hidden: `output/.falling_band.weft-cache`. Pictures have a folder, and one run at a time for each
// scene in it.
fs::path working_cache(const OutputTarget& target, const std::string& scene) {
  const fs::path file = target.file(0);
  const std::string name = target.kind == OutputTarget::Kind::video ? file.stem().string() : scene;
  return file.parent_path() / ("." + name + ".weft-cache");
}

// Simulates, draws and writes side by side. What is simulated is kept until the output is whole.
class Run : public SimulatingJob {
 public:
  using SimulatingJob::SimulatingJob;

 private:
  Plan prepare() override {
    Plan plan = load();
    plan.target = parse_output(options_.output, scene_.name);
    check_writable(plan.target.file(plan.wanted.begin));
    open_store(working_cache(plan.target, scene_.name), Store::Need::helpful, plan);
    // What is there already are then the first frames of the same run.
    const bool overwrite = options_.common.overwrite || store_->resumes();
    prepare_output(plan.target, plan.wanted, overwrite);
    prepare_meshes(object_names(), plan.wanted, overwrite);
    if (store_->has_leftover()) clean_up(plan);
    return plan;
  }

  void clean_up(const Plan& plan) const {
    if (!store_->resumes()) {
      if (!options_.resume)
        log::info(
            fmt::format("note: {} frames of a run that did not end well are thrown away; with --resume it would "
                        "have gone on",
                        store_->leftover_frames()));
      store_->clear();
    }
    std::set<std::string> pictures{video::partial_name(plan.target.file(0)).filename().string()}, meshes;
    for (int frame = plan.wanted.begin; frame < plan.wanted.end; frame += plan.wanted.step) {
      pictures.insert(plan.target.file(frame).filename().string());
      if (options_.meshes.empty()) continue;
      for (const std::string& name : object_names())
        meshes.insert(mesh_file(options_.meshes, name, frame).filename().string());
    }
    remove_half_files(plan.target.file(0).parent_path(), pictures);
    if (!options_.meshes.empty()) remove_half_files(options_.meshes, meshes);
  }

  void finish(ExitCode code) override {
    if (code == ExitCode::ok) store_->remove();
  }
};

}  // namespace

ExitCode run(const RunOptions& options) {
  return Run(options).execute();
}

}  // namespace weft::cli
