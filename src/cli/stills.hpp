// Frames of a scene, for commands that draw few of them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cli/options.hpp"
#include "cli/stages.hpp"
#include "core/progress.hpp"
#include "frame/frame_snapshot.hpp"
#include "render/renderer.hpp"

namespace weft::cli {

class Stills {
 public:
  virtual ~Stills() = default;

  virtual std::string name() const = 0;
  virtual double fps() const = 0;
  /// The frames that can be had, ascending.
  virtual std::vector<int> frames() const = 0;
  virtual render::Settings settings() const = 0;
  virtual Metadata describe(const std::string& gl) const = 0;

  /// Frames to simulate before `last` can be had.
  virtual int cost(int last) const = 0;
  /// To be called with ascending numbers. Throws Error(interrupted) once SIGINT or the like asked for it.
  virtual frame::SnapshotPtr at(int frame, Progress& progress) = 0;
};

/// Reads what `options.scene` names. Throws as load_scene() does.
std::unique_ptr<Stills> open_stills(const SceneOptions& options);

/// The file that `-o` names, or output/<name><ending>, checked before any work is done. Throws Error(usage) where it
/// is no PNG, Error(output_failed) where it cannot be written.
std::filesystem::path still_file(const std::filesystem::path& output, const std::string& default_name, bool overwrite);

}  // namespace weft::cli
