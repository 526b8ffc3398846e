// Frames of a few surfaces, in the form in which a cache passes them to an export.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "support/test_folder.hpp"
#include "tools/export/export.hpp"

namespace weft::exporter {

/// Rounding error of single precision for coordinates of a metre [m].
inline constexpr double kSingle = 1.2e-7;

class MadeFrames : public support::TestFolder {
 protected:
  void SetUp() override {
    TestFolder::SetUp();
    request_.folder = folder_ / "out";
  }

  /// Positions of the vertices of each surface in frame k.
  virtual std::vector<std::vector<Vec3>> positions(int k) const = 0;

  /// Adds the surfaces, and a copy of the last one that is invisible.
  void add_surfaces(std::vector<frame::Surface> surfaces) {
    surfaces.push_back(surfaces.back());
    surfaces.back().name = "hidden";
    surfaces.back().visible = false;
    for (const auto& surface : surfaces) surfaces_.push_back(std::make_shared<frame::Surface>(surface));
  }

  frame::SnapshotPtr snapshot(int k) const {
    auto snapshot = std::make_shared<frame::FrameSnapshot>();
    snapshot->frame = k;
    snapshot->time = k / request_.fps;
    snapshot->stage = stage_;
    snapshot->surfaces.assign(surfaces_.begin(), surfaces_.end());
    for (const auto& of_surface : positions(k)) snapshot->states.push_back({of_surface, {}});
    snapshot->states.push_back(snapshot->states.back());
    return snapshot;
  }

  Request request_;
  std::shared_ptr<const frame::Stage> stage_ = std::make_shared<frame::Stage>();
  std::vector<std::shared_ptr<frame::Surface>> surfaces_;
};

}  // namespace weft::exporter
