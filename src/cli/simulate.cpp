#include "cli/commands.hpp"
#include "cli/simulating.hpp"
#include "cli/stages.hpp"

namespace weft::cli {
namespace {

// Into a frame cache, and meshes where they are asked for.
class Simulate : public SimulatingJob {
 public:
  explicit Simulate(const SimulateOptions& options) : SimulatingJob(options), folder_(options.cache) {}

 private:
  Plan prepare() override {
    Plan plan = load();
    plan.target = {OutputTarget::Kind::none, folder_.string()};
    open_store(folder_, Store::Need::required, plan);
    const bool overwrite = options_.common.overwrite || store_->resumes();
    if (store_->has_leftover() && !overwrite && !options_.resume)
      throw Error(ExitCode::output_failed,
                  "{}: holds a cache already; give --resume to go on with it, --overwrite to start again, or another "
                  "name",
                  folder_.string());
    prepare_meshes(object_names(), plan.wanted, overwrite);
    if (!store_->resumes()) store_->clear();
    return plan;
  }

  std::unique_ptr<FramePainter> make_painter() const override { return make_idle_painter(); }

  const std::filesystem::path folder_;
};

}  // namespace

ExitCode simulate(const SimulateOptions& options) {
  return Simulate(options).execute();
}

}  // namespace weft::cli
