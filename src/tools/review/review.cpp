#include "tools/review/review.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "core/error.hpp"
#include "core/json.hpp"
#include "core/version.hpp"
#include "embedded_review.hpp"
#include "film/image/png.hpp"
#include "tools/review/decisions.hpp"
#include "tools/review/output_folder.hpp"
#include "tools/review/pictures.hpp"
#include "tools/review/run_data.hpp"

namespace weft::review {
namespace {

namespace fs = std::filesystem;

// A name that is safe in every file system and URL.
std::string slug(const std::string& name) {
  std::string text;
  for (const unsigned char c : name) {
    if (std::isalnum(c) != 0 && c < 0x80) {
      text += static_cast<char>(std::tolower(c));
    } else if (!text.empty() && text.back() != '-') {
      text += '-';
    }
  }
  while (text.ends_with('-')) text.pop_back();
  return text.empty() ? "run" : text;
}

// Returns `name`, with a number appended if it is already taken.
std::string unique(const std::string& name, std::set<std::string>& taken) {
  std::string text = name;
  for (int i = 2; !taken.insert(text).second; ++i) text = fmt::format("{}-{}", name, i);
  return text;
}

std::string last_part(const std::string& name) {
  return name.substr(name.rfind('/') + 1);
}

// Finds the reference of a run. First choice: the same name (among several, the one with the same key, else the first).
// Second choice: the same key. Third choice: the only reference whose name has the same part after the last slash.
// Returns null if there is none of these.
const RunFiles* find_reference(const std::vector<RunFiles>& references, const RunFiles& run) {
  const RunFiles* found = nullptr;
  for (const RunFiles& reference : references)
    if (reference.name == run.name && (found == nullptr || reference.key == run.key)) found = &reference;
  if (found != nullptr) return found;
  const auto same = std::ranges::find(references, run.key, &RunFiles::key);
  if (same != references.end()) return &*same;
  for (const RunFiles& reference : references) {
    if (last_part(reference.name) != last_part(run.name)) continue;
    if (found != nullptr) return nullptr;
    found = &reference;
  }
  return found;
}

Json pair_json(const PairComparison& pair) {
  constexpr const char* kVerdicts[] = {"same", "within", "differs"};
  const compare::Figures& figures = pair.figures;
  return {{"picture", pair.picture},
          {"reference", pair.reference},
          {"verdict", kVerdicts[static_cast<int>(pair.verdict)]},
          {"flip", figures.flip},
          {"ssim", figures.ssim},
          {"share_over", figures.fraction_over()},
          {"largest", figures.largest},
          {"largest_x", figures.largest_x},
          {"largest_y", figures.largest_y}};
}

void copy_into(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::create_directories(to.parent_path(), error);
  if (!error) fs::copy_file(from, to, error);
  if (error) throw Error(ExitCode::output_failed, "{}: cannot be copied: {}", from.string(), error.message());
}

// Writes a file without a flush to disk, since the folder is flushed as a whole.
void write_text(const fs::path& file, std::string_view text) {
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  std::ofstream out(file, std::ios::binary);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  if (!out.flush()) throw Error(ExitCode::output_failed, "{}: cannot be written", file.string());
}

class Page {
 public:
  explicit Page(const Request& request) : request_(request), folder_(request.output, request.overwrite) {}

  Outcome write() {
    std::vector<RunFiles> runs = wanted_runs();
    const std::vector<RunFiles> references = wanted_references();
    Json data{{"version", kVersion}, {"runs", Json::array()}, {"references", Json::array()}};
    std::map<const RunFiles*, Entry> added_references;
    Decisions decisions;
    for (RunFiles& run : runs) {
      const Json decision = decisions.of(run);
      Entry entry = add(run, "runs");
      const RunFiles* reference = find_reference(references, run);
      if (reference != nullptr) {
        if (!added_references.contains(reference)) added_references[reference] = add(*reference, "references");
        compare(entry, added_references[reference]);
      } else if (!request_.reference.empty()) {
        entry.problem(fmt::format("no reference of this name in {}", request_.reference.string()));
      }
      add_decision(entry, decision, reference);
      outcome_.incomplete += entry.json["problems"].empty() ? 0 : 1;
      data["runs"].push_back(std::move(entry.json));
    }
    for (auto& [files, entry] : added_references) data["references"].push_back(std::move(entry.json));
    write_web_files(data);
    folder_.commit();
    outcome_.runs = static_cast<int>(runs.size());
    outcome_.page = request_.output / "index.html";
    return outcome_;
  }

 private:
  // If several folders are given, puts the name of the folder before the name of each run.
  std::vector<RunFiles> wanted_runs() const {
    std::vector<RunFiles> runs;
    for (const fs::path& folder : request_.folders) {
      for (RunFiles& run : find_runs(folder)) {
        if (request_.folders.size() > 1) run.name = folder_name(folder) + "/" + run.name;
        runs.push_back(std::move(run));
      }
    }
    if (runs.empty()) {
      std::vector<std::string> names;
      for (const fs::path& folder : request_.folders) names.push_back(folder.string());
      throw Error(ExitCode::asset_unreadable, "{}: expected videos, pictures or statistics of weft run, found none",
                  fmt::join(names, ", "));
    }
    return runs;
  }

  std::vector<RunFiles> wanted_references() const {
    if (request_.reference.empty()) return {};
    std::error_code ignored;
    std::vector<RunFiles> references;
    if (fs::is_directory(request_.reference, ignored)) references = find_runs(request_.reference);
    if (references.empty())
      throw Error(ExitCode::reference_missing, "{}: expected a folder with runs to compare with",
                  request_.reference.string());
    return references;
  }

  // A run that was added to the folder of the page.
  struct Entry {
    const RunFiles* run = nullptr;
    Json json;
    std::string place;  // its folder relative to the page, with a slash at the end
    PictureTimes times;
    std::vector<long long> tiles;

    void problem(const std::string& text) { json["problems"].push_back(text); }
  };

  // Copies the files of a run and describes it.
  Entry add(const RunFiles& run, const char* kind) {
    if (request_.stop()) throw Error(ExitCode::interrupted, "interrupted; no page was written");
    Entry entry{&run, run_data(run), {}, picture_times(run), {}};
    const std::string id = fmt::format("{}/{}", kind, unique(slug(run.name), ids_[kind]));
    entry.place = id + "/";
    entry.json["id"] = id;
    entry.json["date"] = date_of(run);
    if (run.values.is_object()) entry.json["values"] = run.values;
    // Data that only the run's own page needs go into a file that is loaded when that page is opened.
    Json detail = Json::object();
    for (const char* part : {"columns", "effective"}) {
      detail[part] = std::move(entry.json[part]);
      entry.json.erase(part);
    }
    write_text(folder_.path() / entry.place / "data.js",
               fmt::format("review.loaded({}, {});\n", script_json(id), script_json(detail)));
    if (!run.stats.empty()) copy_into(run.stats, folder_.path() / entry.place / "stats.json");
    if (!run.effective.empty()) copy_into(run.effective, folder_.path() / entry.place / "scene.toml");
    add_pictures(entry);
    try {
      add_tiles(entry);
    } catch (const Error& error) {
      if (error.code() != ExitCode::asset_unreadable) throw;
      entry.problem(error.what());
    }
    Json& pictures = entry.json["pictures"];
    pictures["first"] = entry.times.first;
    pictures["step"] = entry.times.step;
    pictures["count"] = entry.times.count;
    pictures["fps"] = entry.times.fps;
    if (!entry.times.frames.empty()) pictures["frames"] = entry.times.frames;
    return entry;
  }

  void add_pictures(Entry& entry) const {
    const RunFiles& run = *entry.run;
    Json files = Json::array();
    if (!run.video.empty()) {
      files.push_back(entry.place + "video.mp4");
      copy_into(run.video, folder_.path() / entry.place / "video.mp4");
    }
    for (const fs::path& picture : run.pictures) {
      files.push_back(fmt::format("{}picture_{:05}.png", entry.place, files.size()));
      copy_into(picture, folder_.path() / files.back().get<std::string>());
    }
    entry.json["pictures"] = {{"kind", files.empty() ? "none" : !run.video.empty() ? "video" : "stills"}};
    entry.json["pictures"]["files"] = std::move(files);
  }

  // Adds the contact sheet, and its middle tile as poster. Takes the number of pictures, and the
  // frame rate of a video, from the pictures instead of the statistics.
  void add_tiles(Entry& entry) const {
    if (entry.json["pictures"]["kind"] == "none") return;
    const PictureSummary found = read_pictures(*entry.run);
    if (!entry.run->stats.empty() && found.count != entry.times.count) {
      entry.problem(fmt::format("{} picture{} can be read, the statistics name {}", found.count,
                                found.count == 1 ? "" : "s", entry.times.count));
    }
    entry.times.count = found.count;
    if (found.fps > 0) entry.times.fps = found.fps;
    entry.json["pictures"]["width"] = found.width;
    entry.json["pictures"]["height"] = found.height;
    Json& sheet = entry.json["sheet"] = Json::array();
    for (const Tile& tile : found.tiles) {
      const std::string file = fmt::format("{}tile_{:05}.png", entry.place, tile.picture);
      image::write_png(folder_.path() / file, tile.image);
      sheet.push_back({{"picture", tile.picture}, {"file", file}});
      entry.tiles.push_back(tile.picture);
    }
    if (!sheet.empty()) entry.json["poster"] = sheet[sheet.size() / 2]["file"];
  }

  // Adds the decision, the folder into which review.json belongs, and the arguments of weft accept.
  void add_decision(Entry& entry, const Json& decision, const RunFiles* reference) {
    const RunFiles& run = *entry.run;
    entry.json["key"] = run.key;
    entry.json["home"] = run.folder.string();
    try {
      entry.json["of"] = fingerprint(run);
    } catch (const Error& error) {
      if (error.code() != ExitCode::asset_unreadable) throw;
      entry.problem(error.what());
      entry.json["of"] = "";
    }
    if (!decision.is_null()) {
      entry.json["decision"] = decision;
      const bool now = value_or(decision, "of", std::string()) == entry.json["of"];
      outcome_.approved += now && decision["state"] == "approved" ? 1 : 0;
      outcome_.needing_work += now && decision["state"] == "needs work" ? 1 : 0;
    }
    Json accept = Json::object();
    if (!run.video.empty()) {
      accept["file"] = run.video.string();
    } else if (!run.pictures.empty()) {
      const std::string stem = (run.pictures.front().parent_path() / run.pictures.front().stem()).string();
      const std::string prefix = stem.substr(0, stem.find_last_not_of("0123456789") + 1);  // npos + 1 is 0
      accept["prefix"] = prefix.empty() ? "./" : prefix;  // empty: working folder, file names of digits only
    }
    fs::path place = request_.reference.empty() ? fs::path("references") : request_.reference;
    if (reference != nullptr && !run.video.empty() && !reference->video.empty()) place = reference->video;
    if (reference != nullptr && run.video.empty() && !reference->pictures.empty())
      place = reference->pictures.front().parent_path();
    accept["reference"] = place.string();
    entry.json["accept"] = std::move(accept);
  }

  // Compares the pictures of the contact sheet with the pictures of the reference at the same
  // times.
  void compare(Entry& entry, const Entry& reference) {
    entry.json["reference"] = reference.json["id"];
    if (reference.tiles.empty()) entry.problem("the reference has no pictures that can be read");
    if (entry.tiles.empty() || reference.tiles.empty()) return;
    try {
      Json& pairs = entry.json["comparison"] = Json::array();
      bool differs = false;
      for (const PairComparison& pair :
           compare_with_reference(*entry.run, entry.times, *reference.run, reference.times, entry.tiles)) {
        pairs.push_back(pair_json(pair));
        differs = differs || pair.verdict == compare::Verdict::differs;
        if (pair.heat.width == 0) continue;
        pairs.back()["heat"] = fmt::format("{}heat_{:05}.png", entry.place, pair.picture);
        image::write_png(folder_.path() / pairs.back()["heat"].get<std::string>(), pair.heat);
      }
      outcome_.differing += differs ? 1 : 0;
    } catch (const Error& error) {
      if (error.code() != ExitCode::asset_unreadable) throw;
      entry.problem(error.what());
    }
    if (entry.times.count != reference.times.count) {
      entry.problem(fmt::format("{} pictures, the reference has {}", entry.times.count, reference.times.count));
    }
  }

  void write_web_files(const Json& data) const {
    for (const EmbeddedFile& file : kEmbeddedReview) {
      const fs::path place = folder_.path() / file.name;
      write_text(place, file.name == "index.html" ? page_html(file.text, data) : std::string(file.text));
    }
  }

  const Request& request_;
  OutputFolder folder_;
  std::map<std::string, std::set<std::string>> ids_;  // ids in use, for "runs" and for "references"
  Outcome outcome_;
};

void replace_once(std::string& text, const std::string& mark, const std::string& with) {
  const std::size_t at = text.find(mark);
  if (at == std::string::npos) throw Error(ExitCode::internal, "index.html: no {}", mark);
  text.replace(at, mark.size(), with);
}

}  // namespace

std::string script_json(const Json& data) {
  // A scene may be called "</script>"; escaping every < prevents any tag.
  const std::string json = json_text(data);
  std::string safe;
  safe.reserve(json.size());
  for (const char c : json) c == '<' ? safe += "\\u003c" : safe += c;
  return safe;
}

std::string page_html(std::string_view page, const Json& data) {
  std::string html(page);
  replace_once(html, "{{version}}", kVersion);
  replace_once(html, "{{data}}", script_json(data));
  return html;
}

Outcome write_review(const Request& request) {
  return Page(request).write();
}

}  // namespace weft::review
