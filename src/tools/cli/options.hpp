// The options of all commands, as checked values.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/progress.hpp"
#include "film/render/renderer.hpp"
#include "film/video/encoder.hpp"
#include "lab/bench/accuracy_plan.hpp"
#include "tools/cli/frame_range.hpp"
#include "tools/cli/output_target.hpp"
#include "tools/cli/sweep_plan.hpp"
#include "tools/compare/compare.hpp"
#include "tools/export/export.hpp"

namespace weft::cli {

struct PictureSize {
  int width = 0, height = 0;  ///< pixels
};

/// Options shared by all commands that start from a scene.
struct SceneOptions {
  std::filesystem::path scene;
  std::vector<std::string> overrides;  ///< texts `key=value` of --set
  std::optional<PictureSize> size;     ///< default: that of the scene
  std::optional<double> fps;           ///< default: that of the scene
  std::string camera;  ///< name; empty: render.camera of the scene, else its first camera, else automatic framing
  std::optional<frame::Stage::Look> look;  ///< default: that of the scene
  std::optional<double> motion_blur;       ///< shutter angle [degrees], 0: none; default: that of the scene
  render::Quality quality = render::Quality::final;
  render::Backend backend = render::Backend::automatic;
  int threads = 0;  ///< 0: all cores
  bool overwrite = false;
  Progress::Style progress = Progress::Style::automatic;
};

struct RunOptions {
  SceneOptions common;
  std::string output;  ///< empty: output/<scene>.mp4
  FrameSelection frames;
  std::filesystem::path meshes;  ///< folder; empty: none
  std::filesystem::path stats;   ///< file; empty: none
  std::string log_json;          ///< file, "-" for standard output; empty: none
  bool resume = false;
  int depth = 8;  ///< bits per channel of PNG pictures, 8 or 16
  VideoOptions video;
  /// Estimate the error of the run; mesh_error: also estimate the error due to the mesh.
  bool error = false, mesh_error = false;
};

struct SimulateOptions : RunOptions {
  std::filesystem::path cache;  ///< folder
};

/// `common.scene` is the folder of a cache.
struct RenderOptions : RunOptions {
  bool partial = false;  ///< use the frames before the first missing or broken frame
};

struct CheckOptions {
  std::vector<std::filesystem::path> scenes;
  std::vector<std::string> overrides;
  std::filesystem::path against;  ///< a scene, an effective scene or a cache to compare with; empty: none
  bool plan = false;              ///< also list which parts of the program the scene uses
  bool estimate = false;          ///< also estimate time and memory of a run
};

struct ThumbnailOptions {
  SceneOptions common;                        ///< `scene` is set for each scene in turn
  std::vector<std::filesystem::path> scenes;  ///< scenes or caches, at least one
  /// The picture, or a folder for <scene>.png (with `start`: <scene>.start.png) of each scene. The path counts as a
  /// folder if it has no extension, or if it is an existing folder and there are several scenes. Empty: the folder
  /// `output`.
  std::filesystem::path output;
  std::optional<int> frame;  ///< default: the frame with the highest saliency
  bool start = false;        ///< draw the start of the scene, even if a run refuses it, instead of a frame
};

struct SheetOptions {
  SceneOptions common;           ///< `size`: of each picture on the sheet
  std::filesystem::path output;  ///< empty: output/<scene>.sheet.png
  int count = 12;                ///< maximum number of pictures
  int columns = 4;

  SheetOptions() { common.quality = render::Quality::preview; }
};

struct JoinOptions {
  std::vector<std::filesystem::path> parts;  ///< videos, or folders of pictures
  std::filesystem::path output;
  VideoOptions video;  ///< used if the parts are pictures
  FrameSelection frames;
  bool partial = false;  ///< use the frames before the first missing or broken frame
  bool overwrite = false;
};

struct SweepOptions {
  std::filesystem::path scene, list;  ///< `list`: file with the values of each run; empty: none
  std::vector<Axis> axes;
  std::filesystem::path output;        ///< folder
  std::vector<std::string> passed_on;  ///< options of `weft run` and their values, checked; each run gets them
  SceneOptions pictures;               ///< size, camera and quality of `passed_on`; the rest is not set
  int jobs = 1;                        ///< number of concurrent runs
  std::optional<int> frame;            ///< picture of each video shown on the sheet, from 0; default: the last
  bool only_report = false;            ///< only make the sheet, the table and the page of existing runs
  bool overwrite = false;
};

struct FarmOptions {
  enum class Action { submit, status, cancel };
  Action action = Action::status;
  SweepOptions sweep;  ///< `output`: folder of the runs; `scene`: the scene for `submit`, else the same folder
  FrameSelection frames;
  int part = 50;    ///< frames per drawing task; more if a run would have over 1000 such tasks
  int threads = 1;  ///< threads per task
  int retries = 3;  ///< retries per task that was killed, had an internal error, or could not write its output
  std::optional<int> memory, minutes;      ///< limits per task [MB, min]; default: estimated from a trial
  std::vector<std::string> for_scheduler;  ///< options of sbatch
  std::filesystem::path program;  ///< program archive that tasks unpack and run; empty: this program at its own path
  bool dry_run = false;           ///< write and print the scripts, submit nothing
};

struct NewOptions {
  std::string name;  ///< path of the new scene, with or without .toml; for the template `ci`, of the new folder
  std::string kind = "drape";  ///< name of the template
  bool overwrite = false;
};

struct WatchOptions {
  std::filesystem::path scene;
  std::vector<std::string> overrides;  ///< of --set
  std::vector<std::string> passed_on;  ///< options of the drawing command and their values, checked
  bool film = false;                   ///< draw the whole video (`weft run`) instead of a still (`weft thumbnail`)
  int times = 0;                       ///< number of drawings after which the command ends; 0: no limit
};

struct SchemaOptions {
  bool pattern = false;  ///< schema of sewing patterns instead of scenes
};

struct DoctorOptions {
  render::Backend backend = render::Backend::automatic;
};

struct BenchOptions {
  enum class Kind { stability, accuracy, speed, fabrics };
  Kind kind = Kind::stability;
  std::filesystem::path scene;         ///< for stability, accuracy and speed; empty: built-in scenes
  std::vector<std::string> overrides;  ///< of --set
  /// For speed: factors on the number of particles along each side, and on the time step; ascending.
  std::vector<double> sizes{0.5, 1, 2, 4}, steps{0.5, 1, 2};
  std::vector<int> threads;                ///< empty: 1, and all cores
  FrameSelection frames;                   ///< for speed: the measured frames
  std::optional<render::Quality> drawing;  ///< for speed: also draw the frames, with this quality
  std::filesystem::path peer;              ///< for speed: program to compare with; empty: none
  bench::AccuracyPlan plan;                ///< for accuracy
  std::filesystem::path output;            ///< folder; empty: output/bench
  bool overwrite = false;
};

/// An option of weft bench that only some kinds accept.
struct BenchOption {
  std::string name;
  std::vector<BenchOptions::Kind> kinds;
};

struct DiffOptions {
  std::filesystem::path reference, test;  ///< files or folders
  compare::Limits limits;
  std::filesystem::path limits_file;  ///< limits and masks of single pictures; empty: none
  std::filesystem::path heatmap;      ///< picture or folder; empty: none
  std::filesystem::path junit, html;  ///< files; empty: none
  bool annotations = false;           ///< print annotations (diff_report.hpp) even outside GitHub Actions
  bool overwrite = false;
  bool json = false;
};

struct AcceptOptions {
  std::filesystem::path reference;           ///< file or folder
  std::vector<std::filesystem::path> tests;  ///< files or folders
  std::string reason;
};

struct ReviewOptions {
  std::vector<std::filesystem::path> folders;
  std::filesystem::path reference;  ///< folder; empty: none
  std::filesystem::path output;     ///< folder; empty: output/review
  bool overwrite = false;
};

struct ExportOptions {
  std::filesystem::path cache, output;  ///< folders
  exporter::Format format = exporter::Format::gltf;
  FrameSelection frames;
  bool partial = false;  ///< use the frames before the first missing or broken frame
  bool overwrite = false;
};

/// Text of help or version, to be printed on standard output instead of running a command.
struct PrintText {
  std::string text;
};

using Command =
    std::variant<RunOptions, SimulateOptions, RenderOptions, CheckOptions, ThumbnailOptions, SheetOptions, JoinOptions,
                 SweepOptions, FarmOptions, NewOptions, WatchOptions, SchemaOptions, DoctorOptions, BenchOptions,
                 DiffOptions, AcceptOptions, ReviewOptions, ExportOptions, PrintText>;

/// `arguments`: without the program's name. Throws Error(usage), which says what was expected. If a
/// name is unknown and a known name is similar, the message suggests the known name.
Command parse_command_line(const std::vector<std::string>& arguments);

/// Parses `1280x720`. Throws Error(usage).
PictureSize parse_size(const std::string& text);

}  // namespace weft::cli
