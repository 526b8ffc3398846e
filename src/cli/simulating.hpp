// What run and simulate share: a scene, and a store that its frames go into.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/job.hpp"
#include "cli/store.hpp"
#include "scene/scene.hpp"

namespace weft::cli {

class SimulatingJob : public Job {
 public:
  using Job::Job;

 protected:
  std::unique_ptr<FrameSource> make_source(std::function<bool()> proceed) override;
  std::vector<frame::ObjectInfo> objects() const override { return store_->objects(); }
  void conclude(RunReport& report) override;
  std::string way_on(ExitCode code) const override;

  /// The scene, its frames and settings; all that does not depend on where they go.
  Plan load();
  std::vector<std::string> object_names() const;
  void open_store(std::filesystem::path folder, Store::Need need, const Plan& plan);

  scene::Scene scene_;
  std::optional<Store> store_;
};

}  // namespace weft::cli
