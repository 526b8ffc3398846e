// Options that several commands share, defined for CLI11, which parses the command line.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "tools/cli/option_values.hpp"
#include "tools/cli/options.hpp"

namespace CLI {
class App;
}

namespace weft::cli {

inline constexpr int kMaxThreads = 1024;
inline constexpr std::array kLooks{Choice<frame::Stage::Look>{"studio", frame::Stage::Look::studio},
                                   Choice<frame::Stage::Look>{"stage", frame::Stage::Look::stage},
                                   Choice<frame::Stage::Look>{"daylight", frame::Stage::Look::daylight},
                                   Choice<frame::Stage::Look>{"clay", frame::Stage::Look::clay},
                                   Choice<frame::Stage::Look>{"wire", frame::Stage::Look::wire},
                                   Choice<frame::Stage::Look>{"strain", frame::Stage::Look::strain}};
inline constexpr std::array kCodecs{Choice<video::Codec>{"h264", video::Codec::h264},
                                    Choice<video::Codec>{"h264_lossless", video::Codec::h264_lossless},
                                    Choice<video::Codec>{"ffv1", video::Codec::ffv1},
                                    Choice<video::Codec>{"prores", video::Codec::prores}};
inline constexpr std::array kQualities{Choice<render::Quality>{"draft", render::Quality::draft},
                                       Choice<render::Quality>{"preview", render::Quality::preview},
                                       Choice<render::Quality>{"final", render::Quality::final}};

/// Adds an option with one value, which `read` receives as text. `value`: placeholder of the value in the help.
void add_value(CLI::App& command, const char* name, const char* value, const std::string& description,
               std::function<void(const std::string&)> read);

/// The same for an option that another command gets: `passed_on` receives its first name and its text.
void add_passed_on(CLI::App& command, std::vector<std::string>& passed_on, const char* name, const char* value,
                   const std::string& description, std::function<void(const std::string&)> read);

/// Adds --set.
void add_overrides(CLI::App& command, std::vector<std::string>& overrides);
void add_backend(CLI::App& command, render::Backend& backend);
/// Adds --size, --camera, --look, --quality, --backend.
void add_picture(CLI::App& command, SceneOptions& options);
/// Adds --threads, --progress, --overwrite.
void add_process(CLI::App& command, SceneOptions& options);
/// Adds --fps and the options of --set, add_picture() and add_process().
void add_scene_changes(CLI::App& command, SceneOptions& options);
/// Adds the scene argument and the options of add_scene_changes().
void add_common(CLI::App& command, SceneOptions& options, const char* what = "The scene, a TOML file");
void add_output(CLI::App& command, RunOptions& options);
void add_video(CLI::App& command, VideoOptions& options);
void add_frames(CLI::App& command, RunOptions& options, const char* description);
/// Adds --meshes, --stats, --log-json.
void add_side_files(CLI::App& command, RunOptions& options);
/// Adds --error, --mesh-error.
void add_error(CLI::App& command, RunOptions& options);
void add_partial(CLI::App& command, bool& partial);

}  // namespace weft::cli
