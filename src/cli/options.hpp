// The command line as checked values.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "bench/accuracy_plan.hpp"
#include "cli/frame_range.hpp"
#include "cli/output_target.hpp"
#include "cli/sweep_plan.hpp"
#include "compare/compare.hpp"
#include "core/progress.hpp"
#include "export/export.hpp"
#include "render/renderer.hpp"
#include "video/encoder.hpp"

namespace weft::cli {

struct PictureSize {
  int width = 0, height = 0;  ///< pixels
};

/// What all commands that start from a scene share.
struct SceneOptions {
  std::filesystem::path scene;
  std::vector<std::string> overrides;      ///< of --set
  std::optional<PictureSize> size;         ///< else that of the scene
  std::optional<double> fps;               ///< else that of the scene
  std::string camera;                      ///< empty: the scene's choice
  std::optional<frame::Stage::Look> look;  ///< else that of the scene
  std::optional<double> motion_blur;       ///< angle of the shutter [degrees], else that of the scene
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
  int depth = 8;  ///< bits a channel of PNG pictures, 8 or 16
  VideoOptions video;
  bool error = false, mesh_error = false;  ///< whether companions are to tell the error; the second: of the mesh too
};

struct SimulateOptions : RunOptions {
  std::filesystem::path cache;  ///< folder
};

/// Its scene is the folder of a cache.
struct RenderOptions : RunOptions {
  bool partial = false;  ///< takes the frames before the first that is missing
};

struct CheckOptions {
  std::vector<std::filesystem::path> scenes;
  std::vector<std::string> overrides;
  std::filesystem::path against;  ///< a scene, an effective scene or a cache; may be empty
  bool plan = false;
  bool estimate = false;  ///< also of time and memory
};

struct ThumbnailOptions {
  SceneOptions common;                        ///< `scene` is set while one is drawn
  std::vector<std::filesystem::path> scenes;  ///< or caches; one at least
  /// A picture, or without an ending a folder, which gets <scene>.png of each; empty: output/<scene>.png.
  std::filesystem::path output;
  std::optional<int> frame;  ///< else the one that tells most
  bool start = false;        ///< instead of a frame: the start, also one that is refused
};

struct SheetOptions {
  SceneOptions common;           ///< the size is that of each picture
  std::filesystem::path output;  ///< empty: output/<scene>.sheet.png
  int count = 12;                ///< pictures at most
  std::optional<int> columns;

  SheetOptions() { common.quality = render::Quality::preview; }
};

struct JoinOptions {
  std::vector<std::filesystem::path> parts;  ///< videos, or folders of pictures
  std::filesystem::path output;
  VideoOptions video;  ///< of what is made of pictures
  FrameSelection frames;
  bool partial = false;  ///< takes the frames before the first that is missing
  bool overwrite = false;
};

struct SweepOptions {
  std::filesystem::path scene, list;  ///< the list may be empty
  std::vector<Axis> axes;
  std::filesystem::path output;        ///< folder
  std::vector<std::string> passed_on;  ///< to each run, checked
  int jobs = 1;                        ///< runs at once
  std::optional<int> frame;            ///< of the sheet, else the last
  bool gather = false;                 ///< makes no run, only sheet, table and page of what is there
  bool overwrite = false;
};

struct FarmOptions {
  enum class Action { submit, status, cancel };
  Action action = Action::status;
  SweepOptions sweep;  ///< of submit: its scene, and its folder in all cases
  FrameSelection frames;
  int part = 50;                           ///< frames that one task draws
  int threads = 1;                         ///< of a task
  int retries = 3;                         ///< of a task that was killed or found no room
  std::optional<int> memory, minutes;      ///< of a task [MB, min]; else from a trial
  std::vector<std::string> for_scheduler;  ///< options of sbatch
  std::filesystem::path program;           ///< archive that tasks unpack and run; empty: this program, where it lies
  bool dry_run = false;                    ///< writes the scripts and prints them
};

struct NewOptions {
  std::string name;            ///< of the scene, with its folder
  std::string kind = "drape";  ///< of the template
  bool overwrite = false;
};

struct WatchOptions {
  std::filesystem::path scene;
  std::vector<std::string> overrides;  ///< of --set
  std::vector<std::string> passed_on;  ///< to what draws, checked
  bool film = false;                   ///< the whole video, not a still
  int times = 0;                       ///< ends after so many; 0: when it is interrupted
};

struct SchemaOptions {
  bool pattern = false;  ///< of sewing patterns, not of scenes
};

struct DoctorOptions {
  render::Backend backend = render::Backend::automatic;
};

struct BenchOptions {
  enum class Kind { stability, accuracy, speed, fabrics };
  Kind kind = Kind::stability;
  std::filesystem::path scene;         ///< of stability, accuracy and speed; empty: built-in ones
  std::vector<std::string> overrides;  ///< of --set
  /// Of speed: what is varied, ascending, and which frames are measured.
  std::vector<double> sizes{0.5, 1, 2, 4}, steps{0.5, 1, 2};
  std::vector<int> threads;  ///< empty: 1, and all cores
  FrameSelection frames;     ///< as typed
  std::optional<render::Quality> drawing;
  bench::AccuracyPlan plan;      ///< of accuracy
  std::filesystem::path output;  ///< folder; empty: output/bench
  bool overwrite = false;
};

/// An option of weft bench that is not for every kind.
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
  bool annotations = false;           ///< also where no GitHub Actions asks for them
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
  bool partial = false;  ///< takes the frames before the first that is missing
  bool overwrite = false;
};

/// Help or version: to be printed on standard output, and that was all.
struct PrintText {
  std::string text;
};

using Command =
    std::variant<RunOptions, SimulateOptions, RenderOptions, CheckOptions, ThumbnailOptions, SheetOptions, JoinOptions,
                 SweepOptions, FarmOptions, NewOptions, WatchOptions, SchemaOptions, DoctorOptions, BenchOptions,
                 DiffOptions, AcceptOptions, ReviewOptions, ExportOptions, PrintText>;

/// `arguments` without the program's name. Throws Error(usage) with what was expected and the nearest known name.
Command parse_command_line(const std::vector<std::string>& arguments);

/// Reads `1280x720`. Throws Error(usage).
PictureSize parse_size(const std::string& text);

}  // namespace weft::cli
