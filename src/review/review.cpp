#include "review/review.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "core/error.hpp"
#include "core/version.hpp"
#include "embedded_review.hpp"
#include "review/output_folder.hpp"
#include "review/run_data.hpp"

namespace weft::review {
namespace {

namespace fs = std::filesystem;

// Names that are safe in every file system and address.
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

// `name`, or with a number after it the first that is not taken yet.
std::string unique(const std::string& name, std::set<std::string>& taken) {
  std::string text = name;
  for (int i = 2; !taken.insert(text).second; ++i) text = fmt::format("{}-{}", name, i);
  return text;
}

std::string last_part(const std::string& name) {
  return name.substr(name.rfind('/') + 1);
}

// The reference of the same path, else the only one of the same last name.
const RunFiles* find_reference(const std::vector<RunFiles>& references, const std::string& name) {
  const RunFiles* found = nullptr;
  for (const RunFiles& reference : references) {
    if (reference.name == name) return &reference;
    if (last_part(reference.name) != last_part(name)) continue;
    if (found != nullptr) return nullptr;
    found = &reference;
  }
  return found;
}

void copy_into(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::create_directories(to.parent_path(), error);
  if (!error) fs::copy_file(from, to, error);
  if (error) throw Error(ExitCode::output_failed, "{}: cannot be copied: {}", from.string(), error.message());
}

// Without a flush of its own: the folder is flushed as a whole.
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
    const std::vector<RunFiles> runs = wanted_runs();
    const std::vector<RunFiles> references = wanted_references();
    Json data{{"version", kVersion}, {"runs", Json::array()}, {"references", Json::array()}};
    std::map<const RunFiles*, std::string> reference_ids;
    for (const RunFiles& run : runs) {
      Json json = add(run, "runs");
      const RunFiles* reference = find_reference(references, run.name);
      if (reference != nullptr && !reference_ids.contains(reference)) {
        data["references"].push_back(add(*reference, "references"));
        reference_ids[reference] = data["references"].back()["id"];
      }
      if (reference != nullptr) json["reference"] = reference_ids[reference];
      if (reference == nullptr && !request_.reference.empty())
        json["problems"].push_back(fmt::format("no reference of this name in {}", request_.reference.string()));
      outcome_.incomplete += json["problems"].empty() ? 0 : 1;
      data["runs"].push_back(std::move(json));
    }
    write_web_files(data);
    folder_.commit();
    outcome_.runs = static_cast<int>(runs.size());
    outcome_.page = request_.output / "index.html";
    return outcome_;
  }

 private:
  // Names tell the folder where several were given.
  std::vector<RunFiles> wanted_runs() const {
    std::vector<RunFiles> runs;
    for (const fs::path& folder : request_.folders) {
      for (RunFiles& run : find_runs(folder)) {
        if (request_.folders.size() > 1)
          run.name = (folder.lexically_normal() / "").parent_path().filename().string() + "/" + run.name;
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

  // Copies the files of a run and describes it.
  Json add(const RunFiles& run, const char* kind) {
    if (request_.stop()) throw Error(ExitCode::interrupted, "interrupted; no page was written");
    Json json = run_data(run);
    const std::string id = unique(slug(run.name), ids_[kind]);
    const std::string place = fmt::format("{}/{}/", kind, id);
    json["id"] = fmt::format("{}/{}", kind, id);
    Json files = Json::array();
    if (!run.video.empty()) {
      copy_into(run.video, folder_.path() / place / "video.mp4");
      files.push_back(place + "video.mp4");
    }
    for (const fs::path& picture : run.pictures) {
      files.push_back(fmt::format("{}{:05}.png", place, picture_number(picture)));
      copy_into(picture, folder_.path() / files.back().get<std::string>());
    }
    json["pictures"]["kind"] = files.empty() ? "none" : !run.video.empty() ? "video" : "stills";
    json["pictures"]["files"] = std::move(files);
    if (!run.stats.empty()) copy_into(run.stats, folder_.path() / place / "stats.json");
    if (!run.effective.empty()) copy_into(run.effective, folder_.path() / place / "scene.toml");
    return json;
  }

  void write_web_files(const Json& data) const {
    for (const EmbeddedFile& file : kEmbeddedReview) {
      const fs::path place = folder_.path() / file.name;
      write_text(place, file.name == "index.html" ? page_html(file.text, data) : std::string(file.text));
    }
  }

  const Request& request_;
  OutputFolder folder_;
  std::map<std::string, std::set<std::string>> ids_;  // taken ones of each kind
  Outcome outcome_;
};

void replace_once(std::string& text, const std::string& mark, const std::string& with) {
  const std::size_t at = text.find(mark);
  if (at == std::string::npos) throw Error(ExitCode::internal, "index.html: no {}", mark);
  text.replace(at, mark.size(), with);
}

}  // namespace

std::string page_html(std::string_view page, const Json& data) {
  // A scene may be called "</script>": no tag can begin where every < is written as an escape.
  const std::string json = data.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string safe;
  safe.reserve(json.size());
  for (const char c : json) c == '<' ? safe += "\\u003c" : safe += c;
  std::string html(page);
  replace_once(html, "{{version}}", kVersion);
  replace_once(html, "{{data}}", safe);
  return html;
}

Outcome write_review(const Request& request) {
  return Page(request).write();
}

}  // namespace weft::review
