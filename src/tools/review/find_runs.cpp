#include "tools/review/find_runs.hpp"

#include <algorithm>
#include <charconv>
#include <exception>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include "core/error.hpp"
#include "core/input_file.hpp"
#include "core/json.hpp"

namespace weft::review {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kEffectiveEnding = ".effective.toml";

bool is_hidden(const fs::path& path) {
  return path.filename().string().starts_with('.');
}

// Removes each "." from the path; "." alone stays. Keeps "..", since the folder before it may be a link.
fs::path without_dots(const fs::path& path) {
  fs::path plain;
  for (const fs::path& part : path)
    if (part != ".") plain /= part;
  return plain.empty() ? fs::path(".") : plain;
}

// All regular files below the folder, without_dots() and sorted by path. Skips hidden files and folders, and review
// pages. Skips links, since the page would publish their targets.
std::vector<fs::path> list_files(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw Error(ExitCode::asset_unreadable, "{}: expected a folder with runs, found none", folder.string());
  std::vector<fs::path> files;
  fs::recursive_directory_iterator entry(folder, fs::directory_options::skip_permission_denied, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    std::error_code ignored;  // a file that has disappeared is skipped
    if (entry->is_directory(ignored)) {
      if (is_hidden(entry->path()) || is_review_page(entry->path())) entry.disable_recursion_pending();
    } else if (fs::is_regular_file(entry->symlink_status(ignored)) && !is_hidden(entry->path())) {
      files.push_back(without_dots(entry->path()));
    }
  }
  if (error) throw Error(ExitCode::asset_unreadable, "{}: cannot be listed: {}", folder.string(), error.message());
  std::sort(files.begin(), files.end());
  return files;
}

// Splits "band_00012" into "band_" and "00012".
std::pair<std::string, std::string> split_number(const std::string& stem) {
  const std::size_t digits = stem.find_last_not_of("0123456789") + 1;  // npos + 1 is 0
  return {stem.substr(0, digits), stem.substr(digits)};
}

bool is_statistics(const Json& json) {
  if (!json.is_object() || !json.contains("scene") || !json["scene"].is_string()) return false;
  const auto frames = json.find("frames");
  return frames != json.end() && frames->is_array() &&
         std::all_of(frames->begin(), frames->end(), [](const Json& frame) { return frame.is_object(); });
}

bool is_not_negative(const Json& value) {
  return value.is_number() && value >= 0;
}

bool is_list_of(const Json& value, const std::function<bool(const Json&)>& fits) {
  return value.is_array() && std::all_of(value.begin(), value.end(), fits);
}

bool is_object_entry(const Json& entry) {
  const auto text = [&](const char* key) { return entry.contains(key) && entry[key].is_string(); };
  const auto count = [&](const char* key) { return !entry.contains(key) || is_not_negative(entry[key]); };
  return entry.is_object() && text("name") && text("kind") && count("vertices") && count("faces");
}

/// Removes values of the statistics that the page cannot show, and adds their names to `problems`, so that the page can
/// show the other values.
void drop_invalid_values(Json& stats, const std::string& file, std::vector<std::string>& problems) {
  const auto drop = [&](const char* key, const char* expected, const auto& fits) {
    const auto found = stats.find(key);
    if (found == stats.end() || fits(*found)) return;
    problems.push_back(fmt::format("{}: {}: expected {}", file, key, expected));
    stats.erase(key);
  };
  const auto is_text = [](const Json& value) { return value.is_string(); };
  for (const char* key : {"scene_file", "scene_hash", "version", "cpu", "gl", "message", "output"})
    drop(key, "a text", is_text);
  for (const char* key : {"threads", "exit_code", "width", "height", "fps", "particles", "peak_memory_bytes"})
    drop(key, "a number, 0 or more", is_not_negative);
  drop("totals", "numbers by name", [](const Json& value) {
    return value.is_object() && std::all_of(value.begin(), value.end(), [](const Json& v) { return v.is_number(); });
  });
  drop("warnings", "a list of texts", [&](const Json& value) { return is_list_of(value, is_text); });
  drop("objects", "a list of objects with name, kind, vertices and faces",
       [](const Json& value) { return is_list_of(value, is_object_entry); });
}

/// The values that a sweep has set for a run: texts by key; null if the entry is invalid.
Json set_of(const Json& run) {
  const auto set = run.find("set");
  const auto is_text = [](const Json& value) { return value.is_string(); };
  return set != run.end() && set->is_object() && std::all_of(set->begin(), set->end(), is_text) ? *set : Json();
}

// Composes runs from the files below one folder.
class Search {
 public:
  explicit Search(const fs::path& folder) : folder_(without_dots(folder)) {
    for (const fs::path& file : list_files(folder)) {
      const std::string ending = file.extension().string();
      if (ending == ".mp4") videos_.insert(file);
      if (file.filename() == kSweepName)
        add_sweep(file);
      else if (ending == ".json" && file.filename() != kDecisionsName)
        statistics_.push_back(file);
      if (file.filename().string().ends_with(kEffectiveEnding)) effective_.insert(file);
      if (ending != ".png") continue;
      const auto [prefix, digits] = split_number(file.stem().string());
      if (!digits.empty()) pictures_[file.parent_path() / (prefix + "{}")].push_back(file);
    }
    for (auto& [prefix, files] : pictures_) {
      std::stable_sort(files.begin(), files.end(),
                       [](const fs::path& a, const fs::path& b) { return picture_number(a) < picture_number(b); });
    }
  }

  std::vector<RunFiles> runs() {
    for (const fs::path& file : statistics_) add_with_statistics(file);
    for (const fs::path& file : std::set<fs::path>(videos_)) {
      RunFiles run = named(file);
      run.video = file;
      const auto problem = unusable_.find(run.name);
      if (problem != unusable_.end()) run.problems.push_back(problem->second);
      runs_.push_back(std::move(run));
    }
    for (const auto& [prefix, files] : pictures_) add_pictures(prefix, files);
    std::set<std::string> keys;
    for (RunFiles& run : runs_) {
      find_effective(run);
      run.folder = folder_;
      // Decisions are stored by key. Runs with statistics come first, and keep their names as keys.
      run.key = run.name;
      if (keys.contains(run.key)) run.key += run.video.empty() ? " (pictures)" : " (video)";
      const std::string key = run.key;
      for (int i = 2; !keys.insert(run.key).second; ++i) run.key = fmt::format("{} {}", key, i);
      if (const auto found = swept_.find(fs::path(run.name).parent_path()); found != swept_.end())
        run.values = found->second.values;
    }
    std::ranges::sort(runs_, {}, [&](const RunFiles& run) { return place_of(run); });
    return std::move(runs_);
  }

 private:
  /// A run of a sweep. `place` defines the order, since names with numbers do not sort by value (10 before 2).
  struct Swept {
    std::string sweep;      // folder of the sweep
    std::size_t place = 0;  // rank among the runs of all sweeps, in the order of their lists
    Json values;
  };

  void add_sweep(const fs::path& file) {
    const Json json = read_json_or_null(file);
    if (!json.is_object() || !json.contains("runs") || !json["runs"].is_array()) return;
    const fs::path beside = file.parent_path().lexically_relative(folder_);
    for (const Json& run : json["runs"])
      if (run.is_object() && run.contains("folder") && run["folder"].is_string())
        swept_.try_emplace((beside / run["folder"].get<std::string>()).lexically_normal(),
                           Swept{beside.generic_string(), swept_.size(), set_of(run)});
  }

  std::tuple<std::string, std::size_t, std::string> place_of(const RunFiles& run) const {
    const auto found = swept_.find(fs::path(run.name).parent_path());
    if (found == swept_.end()) return {run.name, 0, run.key};
    return {found->second.sweep, found->second.place, run.key};
  }

  RunFiles named(const fs::path& file) const {
    RunFiles run;
    run.name = fs::path(file).replace_extension().lexically_relative(folder_).generic_string();
    return run;
  }

  void add_with_statistics(const fs::path& file) {
    RunFiles run = named(file);
    try {
      run.stats_json = parse_json(read_file(file, kMaxTextBytes));
    } catch (const std::exception& error) {
      // Other programs may write JSON here, so the defect becomes a problem of a run only if a video of this name
      // exists.
      unusable_[run.name] = fmt::format("{}: not readable as JSON: {}", file.filename().string(), error.what());
      return;
    }
    run.stats = file;
    if (!take_statistics(run)) {
      unusable_[run.name] =
          fmt::format("{}: expected the statistics that weft run --stats writes", file.filename().string());
      return;
    }
    take_pictures(run);
    runs_.push_back(std::move(run));
  }

  // Finds the video or pictures that the statistics name as output. The folders may have been moved
  // or copied from another machine. So, for the output a/b.mp4, this function tries a/b.mp4 and
  // then b.mp4 in the folder of the statistics. If neither exists, it takes the video with the name
  // of the statistics.
  void take_pictures(RunFiles& run) {
    const fs::path beside = run.stats.parent_path();
    const auto named_output = run.stats_json.find("output");
    const fs::path output =
        named_output != run.stats_json.end() && named_output->is_string() ? named_output->get<std::string>() : "";
    for (auto part = output.begin(); part != output.end(); ++part) {
      fs::path file = beside;
      for (auto rest = part; rest != output.end(); ++rest) file /= rest->relative_path();
      if (take(run, without_dots(file)) || take(run, file.lexically_normal())) return;
    }
    if (take(run, fs::path(run.stats).replace_extension(".mp4"))) return;
    const fs::path other = beside / output.filename();
    if (output.has_filename() && output.extension() != ".png" && fs::is_regular_file(other))
      run.problems.push_back(other.filename().string() +
                             ": browsers play H.264 in .mp4 only; weft run -o NAME.mp4 or weft render writes it");
  }

  bool take(RunFiles& run, const fs::path& file) {
    if (videos_.erase(file) > 0) {
      run.video = file;
      return true;
    }
    const std::string name = file.filename().string();
    const auto pictures = pictures_.find(file.parent_path() / (name.substr(0, name.find('{')) + "{}"));
    if (name.find('{') == std::string::npos || pictures == pictures_.end()) return false;
    run.pictures = std::move(pictures->second);
    pictures_.erase(pictures);
    return true;
  }

  // Whether these pictures lie in a subfolder of a sweep's run that has a video: a farm draws the pictures of a run
  // there, and joins them to this video.
  bool are_in_a_video(const fs::path& prefix) const {
    const fs::path run = prefix.parent_path().parent_path();
    return swept_.contains(run.lexically_relative(folder_)) && std::ranges::any_of(runs_, [&](const RunFiles& other) {
             return !other.video.empty() && other.video.parent_path() == run;
           });
  }

  // Adds a run of numbered pictures. A single picture is a thumbnail or a sheet, not a run.
  void add_pictures(const fs::path& prefix, const std::vector<fs::path>& files) {
    if (files.size() < 2 || are_in_a_video(prefix)) return;
    std::string name = prefix.lexically_relative(folder_).generic_string();
    name.resize(name.size() - 2);
    while (!name.empty() && std::string_view("_-./").find(name.back()) != std::string_view::npos) name.pop_back();
    RunFiles run;
    run.name = name.empty() ? folder_name(folder_) : name;
    run.pictures = files;
    runs_.push_back(std::move(run));
  }

  void find_effective(RunFiles& run) const {
    const fs::path pictures = run.pictures.empty() ? fs::path() : run.pictures.front();
    std::vector<fs::path> places;
    for (const fs::path& file : {run.video, pictures, run.stats}) {
      if (file.empty()) continue;
      places.push_back(file.parent_path() / file.stem());
      if (!run.stats.empty()) places.push_back(file.parent_path() / run.stats_json["scene"].get<std::string>());
    }
    for (const fs::path& place : places) {
      const fs::path file = place.string() + std::string(kEffectiveEnding);
      if (!effective_.contains(file)) continue;
      run.effective = file;
      return;
    }
  }

  const fs::path folder_;
  std::vector<fs::path> statistics_;
  std::set<fs::path> videos_, effective_;               // .mp4 files not yet assigned to a run; all effective scenes
  std::map<fs::path, std::vector<fs::path>> pictures_;  // by prefix before the number; not yet assigned to a run
  std::map<fs::path, Swept> swept_;                     // by the folder of the run
  std::map<std::string, std::string> unusable_;         // by name of a run: why its JSON file is unusable
  std::vector<RunFiles> runs_;
};

}  // namespace

bool take_statistics(RunFiles& run) {
  if (!is_statistics(run.stats_json)) return false;
  drop_invalid_values(run.stats_json, run.stats.filename().string(), run.problems);
  return true;
}

std::vector<RunFiles> find_runs(const fs::path& folder) {
  return Search(folder).runs();
}

std::string folder_name(const fs::path& folder) {
  return (fs::absolute(folder) / "").lexically_normal().parent_path().filename().string();
}

long long picture_number(const fs::path& picture) {
  const std::string digits = split_number(picture.stem().string()).second;
  long long number = -1;
  std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return number;
}

bool is_review_page(const fs::path& folder) {
  return read_start(folder / "index.html", 1024).find(kPageMark) != std::string::npos;
}

}  // namespace weft::review
