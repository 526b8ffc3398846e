#include "tools/cli/option_groups.hpp"

#include <CLI/CLI.hpp>

namespace weft::cli {
namespace {

constexpr std::array kBackends{Choice<render::Backend>{"auto", render::Backend::automatic},
                               Choice<render::Backend>{"osmesa", render::Backend::osmesa},
                               Choice<render::Backend>{"egl", render::Backend::egl}};
constexpr std::array kProgressStyles{
    Choice<Progress::Style>{"auto", Progress::Style::automatic}, Choice<Progress::Style>{"bar", Progress::Style::bar},
    Choice<Progress::Style>{"plain", Progress::Style::plain}, Choice<Progress::Style>{"none", Progress::Style::none}};

}  // namespace

void add_overrides(CLI::App& command, std::vector<std::string>& overrides) {
  command
      .add_option_function<std::vector<std::string>>(
          "--set",
          [&overrides](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) overrides.push_back(check_override(text));
          },
          "Change one value of the scene, checked like the file; may be given several times")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

void add_value(CLI::App& command, const char* name, const char* value, const std::string& description,
               std::function<void(const std::string&)> read) {
  command.add_option_function<std::string>(name, read, description)->type_name(value);
}

void add_passed_on(CLI::App& command, std::vector<std::string>& passed_on, const char* name, const char* value,
                   const std::string& description, std::function<void(const std::string&)> read) {
  const std::string names = name, first = names.substr(0, names.find(','));
  add_value(command, name, value, description, [&passed_on, first, read](const std::string& text) {
    read(text);
    passed_on.insert(passed_on.end(), {first, text});
  });
}

void add_backend(CLI::App& command, render::Backend& backend) {
  add_value(command, "--backend", "auto|osmesa|egl", "Library that makes the OpenGL context [auto]",
            [&](const std::string& text) { backend = parse_choice("--backend", text, kBackends); });
}

void add_picture(CLI::App& command, SceneOptions& options) {
  add_value(command, "--size", "WxH", "Size of the picture in pixels [the scene's, or 1280x720]",
            [&](const std::string& text) { options.size = parse_size(text); });
  add_value(command, "--camera", "NAME",
            "Camera of the scene that draws [render.camera, the first one, or automatic framing]",
            [&](const std::string& text) { options.camera = text; });
  add_value(command, "--look", "studio|stage|daylight|clay|wire|strain",
            "Surroundings, or a style for review [the scene's]",
            [&](const std::string& text) { options.look = parse_choice("--look", text, kLooks); });
  const char* quality = options.quality == render::Quality::preview ? "preview" : "final";
  add_value(command, "--quality", "draft|preview|final", fmt::format("Quality of the pictures [{}]", quality).c_str(),
            [&](const std::string& text) { options.quality = parse_choice("--quality", text, kQualities); });
  add_backend(command, options.backend);
}

void add_process(CLI::App& command, SceneOptions& options) {
  add_value(command, "--threads", "N", "Maximum number of threads [all cores]; results do not depend on it",
            [&](const std::string& text) { options.threads = parse_integer("--threads", text, 1, kMaxThreads); });
  add_value(command, "--progress", "auto|bar|plain|none", "Progress on standard error [auto]",
            [&](const std::string& text) { options.progress = parse_choice("--progress", text, kProgressStyles); });
  command.add_flag("--overwrite", options.overwrite, "Replace files that exist already");
}

void add_scene_changes(CLI::App& command, SceneOptions& options) {
  add_value(command, "--fps", "N", "Frames per second [the scene's]",
            [&](const std::string& text) { options.fps = parse_fps(text); });
  add_overrides(command, options.overrides);
  add_picture(command, options);
  add_process(command, options);
}

void add_common(CLI::App& command, SceneOptions& options, const char* what) {
  command.add_option("SCENE", options.scene, what)->required()->type_name("");
  add_scene_changes(command, options);
}

void add_output(CLI::App& command, RunOptions& options) {
  add_value(command, "-o,--output", "FILE",
            "Video (.mp4; for editing .mov, .mkv), pictures ('out/{frame:05}.png') or layers for compositing (.exr) "
            "[output/<scene>.mp4]",
            [&](const std::string& text) { options.output = text; });
  add_value(command, "--depth", "8|16", "Bits per channel of PNG pictures [8]", [&](const std::string& text) {
    options.depth = parse_choice("--depth", text, std::array{Choice<int>{"8", 8}, Choice<int>{"16", 16}});
  });
  add_video(command, options.video);
  add_value(
      command, "--motion-blur", "DEGREES", "Shutter angle; film uses 180; 0: no motion blur [the scene's]",
      [&](const std::string& text) { options.common.motion_blur = parse_integer("--motion-blur", text, 0, 360); });
}

void add_video(CLI::App& command, VideoOptions& options) {
  add_value(command, "--codec", "h264|h264_lossless|ffv1|prores",
            "Codec of the video [by the ending: .mp4 h264, .mov prores, .mkv ffv1]",
            [&](const std::string& text) { options.codec = parse_choice("--codec", text, kCodecs); });
  add_value(command, "--crf", "N", "Quality of H.264: 1 is the best, 51 gives the smallest file [18]",
            [&](const std::string& text) { options.crf = parse_integer("--crf", text, 1, 51); });
}

void add_frames(CLI::App& command, RunOptions& options, const char* description) {
  add_value(command, "--frames", "A:B[:STEP]", description,
            [&](const std::string& text) { options.frames = parse_frames(text); });
}

void add_side_files(CLI::App& command, RunOptions& options) {
  add_value(command, "--meshes", "DIR", "Also write each cloth and obstacle of the chosen frames as PLY",
            [&](const std::string& text) { options.meshes = text; });
  add_value(command, "--stats", "FILE", "Also write times, iterations and energies as JSON",
            [&](const std::string& text) { options.stats = text; });
  add_value(command, "--log-json", "FILE|-", "Also write events as JSON lines (-: standard output)",
            [&](const std::string& text) { options.log_json = text; });
}

void add_error(CLI::App& command, RunOptions& options) {
  command.add_flag("--error", options.error,
                   "Also estimate the error of the run, from runs with other steps, solver settings and starts");
  command.add_flag("--mesh-error", options.mesh_error,
                   "As --error, and from runs with half and a quarter of the cells");
}

void add_partial(CLI::App& command, bool& partial) {
  command.add_flag("--partial", partial, "If frames are missing or broken, use those before the first of them");
}

}  // namespace weft::cli
