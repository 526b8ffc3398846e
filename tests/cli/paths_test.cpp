// The test sets every option that names a path, of every command, to an input, another output, an existing file, a link
// to a file, and a folder. No file may be lost. WEFT_PATHS_TABLE=FILE writes the results as a Markdown table.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <functional>
#include <optional>

#include "cli/subprocess.hpp"
#include "film/image/png.hpp"
#include "support/test_folder.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;

// Two frames without contact, and a file that the scene references.
constexpr const char* kSceneWithFile = R"(
time = { duration = 0.1, fps = 10, step = 0.1 }
cloth = [{ name = "cloth", size = 0.2, particles = 3 }]
obstacle = [{ name = "o", shape = "mesh", file = "o.obj", collide = false }]
)";
constexpr const char* kMesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// A command with one option that names a path, and its other outputs.
struct Command {
  const char* name;
  Arguments arguments;  ///< arguments; `@` stands for the path
  const char* option;
  const char* free;  ///< a path that the command accepts
  const char* input;
  const char* other;            ///< another output of the command; nullptr: it has none
  int exists_code = 6;          ///< exit code if the file exists
  bool is_folder = false;       ///< whether the option names a folder
  const char* clash = nullptr;  ///< a file that the command would write into this folder; nullptr: it refuses the
                                ///< folder itself
};

std::vector<Command> commands() {
  const auto small = [](const Arguments& arguments) { return joined(arguments, kSmall); };
  return {
      {"run", small({"run", "s.toml", "-o", "@", "--stats", "stats.mp4"}), "-o FILE", "new.mp4", "s.mp4", "stats.mp4"},
      {"run", small({"run", "s.toml", "-o", "@", "--stats", "p/1.png"}), "-o PATTERN", "n/{frame}.png", "i/{frame}.png",
       "p/{frame}.png", 6, false, "1.png"},
      {"run", small({"run", "s.toml", "-o", "d.mp4", "--stats", "@"}), "--stats", "new.json", "s.toml", "d.mp4"},
      {"run", small({"run", "s.toml", "-o", "d.mp4", "--log-json", "@"}), "--log-json", "new.json", "o.obj",
       "d.effective.toml"},
      {"run", small({"run", "s.toml", "-o", "d.mp4", "--meshes", "@"}), "--meshes", "n", "in", ".d.weft-cache", 6, true,
       "cloth_00001.ply"},
      {"simulate",
       {"simulate", "s.toml", "--progress", "none", "--stats", "m", "--cache", "@"},
       "--cache",
       "n",
       ".",
       "m",
       6,
       true},
      {"simulate",
       {"simulate", "s.toml", "--progress", "none", "--cache", "n", "--meshes", "@"},
       "--meshes",
       "m",
       "in",
       "n",
       6,
       true,
       "cloth_00001.ply"},
      {"simulate",
       {"simulate", "s.toml", "--progress", "none", "--cache", "n", "--stats", "@"},
       "--stats",
       "new.json",
       "s.toml",
       "n/manifest.json"},
      {"simulate",
       {"simulate", "s.toml", "--progress", "none", "--cache", "n", "--log-json", "@"},
       "--log-json",
       "new.json",
       "s.toml",
       "n/state.weft"},
      {"render", small({"render", "c", "-o", "@", "--stats", "stats.mp4"}), "-o FILE", "new.mp4", "c/new.mp4",
       "stats.mp4"},
      {"render", small({"render", "c", "-o", "@", "--stats", "p/1.png"}), "-o PATTERN", "n/{frame}.png",
       "c/{frame}.png", "p/{frame}.png", 6, false, "1.png"},
      {"render", small({"render", "c", "-o", "d.mp4", "--stats", "@"}), "--stats", "new.json", "c/manifest.json",
       "d.mp4"},
      {"render", small({"render", "c", "-o", "d.mp4", "--log-json", "@"}), "--log-json", "new.json",
       "c/frame_00001.weft", "d.effective.toml"},
      {"render", small({"render", "c", "-o", "d.mp4", "--meshes", "@"}), "--meshes", "n", "c", "d.mp4", 6, true,
       "cloth_00001.ply"},
      {"thumbnail", small({"thumbnail", "s.toml", "-o", "@"}), "-o", "new.png", "in.png", nullptr},
      {"thumbnail", small({"thumbnail", "c", "-o", "@"}), "-o, of a cache", "new.png", "c/new.png", nullptr},
      {"sheet", small({"sheet", "s.toml", "-o", "@"}), "-o", "new.png", "in.png", nullptr},
      {"diff", {"diff", "a.png", "b.png", "--heatmap", "@"}, "--heatmap FILE", "new.png", "a.png", nullptr},
      {"diff", {"diff", "ref", "out", "--heatmap", "@"}, "--heatmap DIR", "n", "ref", nullptr, 6, true, "a.png"},
      {"diff", {"diff", "a.png", "b.png", "--html", "@"}, "--html", "new.html", "a.png", nullptr},
      {"accept", {"accept", "@", "b.png", "--reason", "why"}, "REFERENCE", "new.png", "b.png", nullptr, 0},
      {"export",
       {"export", "c", "--format", "ply", "-o", "@"},
       "-o ply",
       "n",
       "c",
       nullptr,
       6,
       true,
       "cloth_00001.ply"},
      {"export", {"export", "c", "-o", "@"}, "-o gltf", "n", "c", nullptr, 6, true, "s.glb"},
      {"review", {"review", "runs", "-o", "@"}, "-o", "n", "runs", nullptr, 6, true},
      {"bench",
       {"bench", "accuracy", "s.toml", "--integrators", "bdf2", "--steps", "1", "--tolerances", "none", "--meshes",
        "none", "-o", "@"},
       "-o",
       "n",
       "s.toml",
       nullptr,
       6,
       true,
       "accuracy_s.md"},
  };
}

class Paths : public support::TestFolder {
 protected:
  void SetUp() override {
    support::TestFolder::SetUp();
    support::write_bytes(folder_ / "s.toml", kSceneWithFile);
    support::write_bytes(folder_ / "o.obj", kMesh);
    for (const char* folder : {"ref", "out", "runs", "in", "i"}) fs::create_directories(folder_ / folder);
    image::Image image(16, 16);
    for (const char* name : {"a.png", "ref/a.png", "runs/r1.png", "runs/r2.png"})
      image::write_png(folder_ / name, image);
    image.rgb.assign(image.rgb.size(), 200);
    for (const char* name : {"b.png", "out/a.png"}) image::write_png(folder_ / name, image);
    // Values of Command::input that are hard links to the file that the scene names.
    for (const char* name : {"s.mp4", "in.png", "i/1.png", "in/cloth_00001.ply"})
      fs::create_hard_link(folder_ / "o.obj", folder_ / name);
    Arguments simulate{"simulate", "s.toml", "--cache", "c", "--progress", "none"};
    ASSERT_EQ(run_weft(simulate, folder_).exit_code, 0);
  }

  /// Content of every file and link below the folder, by name. Empty folders do not count, since they contain nothing
  /// to lose.
  std::map<std::string, std::string> all() const {
    std::map<std::string, std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
      const std::string name = fs::relative(entry.path(), folder_).string();
      if (entry.is_symlink())
        found[name] = "-> " + fs::read_symlink(entry.path()).string();
      else if (entry.is_regular_file())
        found[name] = support::read_bytes(entry.path());
    }
    return found;
  }

  /// Runs the command with this path; expects the exit code and that all existing files are unchanged.
  void expect(const Command& command, const std::string& kind, const std::string& path, int code) {
    Arguments arguments = command.arguments;
    std::replace(arguments.begin(), arguments.end(), std::string("@"), path);
    const auto before = all();
    const Outcome outcome = run_weft(arguments, folder_);
    const auto after = all();
    EXPECT_EQ(outcome.exit_code, code) << kind << ": " << path << "\n" << outcome.err;
    std::size_t lost = 0, added = 0;
    for (const auto& [name, bytes] : before)
      if (const auto here = after.find(name); here == after.end() || here->second != bytes) {
        ++lost;
        ADD_FAILURE() << command.name << ' ' << command.option << ", " << kind << ": lost " << name;
      }
    for (const auto& [name, bytes] : after) added += before.contains(name) ? 0 : 1;
    EXPECT_TRUE(code == 0 || code == 7 || added == 0) << kind << ": left something behind";
    tell(command, kind, path, outcome, lost, added);
  }

  static void tell(const Command& command, const std::string& kind, const std::string& path, const Outcome& outcome,
                   std::size_t lost, std::size_t added) {
    const char* table = std::getenv("WEFT_PATHS_TABLE");
    if (table == nullptr) return;
    const std::string left = lost > 0 ? "LOST" : added > 0 ? "all as before, and what it writes" : "all as before";
    std::ofstream(table, std::ios::app) << fmt::format("| {} | `{}` | {}: `{}` | {} | {} |\n", command.name,
                                                       command.option, kind, path, outcome.exit_code, left);
  }

  /// Value of the option that makes the command write into `folder`.
  static std::string given(const Command& command, const std::string& folder) {
    return std::string(command.free).find('{') == std::string::npos ? folder : folder + "/{frame}.png";
  }
};

class PathOption : public Paths, public ::testing::WithParamInterface<std::size_t> {};

TEST_P(PathOption, LosesNothing) {
  const Command command = commands()[GetParam()];
  const std::string ending = fs::path(command.free).extension().string();
  expect(command, "input", command.input, 2);
  Command overwriting = command;
  if (command.name != std::string("accept")) overwriting.arguments.push_back("--overwrite");
  expect(overwriting, "input, with --overwrite", command.input, 2);
  const bool in_folder = command.clash != nullptr;
  const bool replaces = command.exists_code == 0;
  // Paths to the input: with "..", through a link to it, and through a link to its folder.
  expect(command, "input, by a detour", "in/../" + std::string(command.input), 2);
  fs::create_directory_symlink(".", folder_ / "here");
  expect(command, "input, through a link", "here/" + std::string(command.input), 2);
  if (command.other) expect(command, "other output", command.other, 2);
  if (command.other) expect(command, "other output, by a detour", "out/../" + std::string(command.other), 2);
  if (replaces) {
    fs::create_directories(folder_ / "folder.png");
    expect(command, "folder", "folder.png", 0);
    expect(command, "nothing there", command.free, 0);
    return;
  }
  // An existing file, a link to it, a dangling link.
  const std::string file = in_folder ? "old/" + std::string(command.clash) : "old" + ending;
  if (in_folder) fs::create_directories(folder_ / "old");
  support::write_bytes(folder_ / file, "precious");
  const std::string old = in_folder ? given(command, "old") : file;
  expect(command, "existing file", old, command.exists_code);
  const std::string link = in_folder ? "linked/" + std::string(command.clash) : "linked" + ending;
  if (in_folder) fs::create_directories(folder_ / "linked");
  fs::create_symlink(folder_ / file, folder_ / link);
  expect(command, "link to it", in_folder ? given(command, "linked") : link, command.exists_code);
  fs::remove(folder_ / link);
  fs::create_symlink("nothing", folder_ / link);
  expect(command, "link to nothing", in_folder ? given(command, "linked") : link, command.exists_code);
  // A folder with content in place of a file.
  const std::string place = in_folder ? "holder/" + std::string(command.clash) : "folder" + ending;
  fs::create_directories(folder_ / place);
  support::write_bytes(folder_ / place / "x.txt", "precious");
  expect(command, "folder", in_folder ? given(command, "holder") : place, 6);
  expect(command, "nothing there", command.free, command.name == std::string("diff") ? 7 : 0);
}

TEST_F(Paths, OverwrittenUnderOneNameAFileKeepsWhatItHoldsUnderAnother) {
  for (const char* option : {"-o", "--stats", "--log-json"}) {
    const std::string ending = option == std::string("-o") ? ".mp4" : ".json";
    const std::string link = option + std::string("_link") + ending, hard = option + std::string("_hard") + ending;
    support::write_bytes(folder_ / "precious", "precious");
    fs::create_symlink("precious", folder_ / ("x" + link));
    fs::create_hard_link(folder_ / "precious", folder_ / ("x" + hard));
    for (const std::string& name : {"x" + link, "x" + hard}) {
      Arguments arguments{"run", "s.toml", option, name, "--overwrite"};
      if (option != std::string("-o")) arguments.insert(arguments.end(), {"-o", "d.mp4"});
      expect_exit(run_weft(joined(arguments, kSmall), folder_), 0);
      EXPECT_EQ(support::read_bytes(folder_ / "precious"), "precious") << name;
      EXPECT_NE(support::read_bytes(folder_ / name), "precious") << name;
    }
  }
}

std::string name_of(const ::testing::TestParamInfo<std::size_t>& test) {
  return fmt::format("{:02}_{}", test.param, commands()[test.param].name);
}

INSTANTIATE_TEST_SUITE_P(Commands, PathOption, ::testing::Range<std::size_t>(0, commands().size()), name_of);

}  // namespace
}  // namespace weft::cli
