#include "tools/review/decisions.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/json.hpp"
#include "tools/compare/acceptance.hpp"

namespace weft::review {
namespace {

namespace fs = std::filesystem;

bool is_text(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found == object.end() || found->is_string();
}

bool is_point(const Json& point) {
  return point.is_array() && point.size() == 2 &&
         std::all_of(point.begin(), point.end(), [](const Json& share) { return share.is_number(); });
}

bool is_line(const Json& line) {
  return line.is_array() && std::all_of(line.begin(), line.end(), is_point);
}

bool is_note(const Json& note) {
  if (!note.is_object() || !is_text(note, "by") || !is_text(note, "date") || !is_text(note, "of")) return false;
  const auto frame = note.find("frame"), text = note.find("text"), marks = note.find("marks");
  return frame != note.end() && frame->is_number_integer() && text != note.end() && text->is_string() &&
         (marks == note.end() || (marks->is_array() && std::all_of(marks->begin(), marks->end(), is_line)));
}

}  // namespace

std::string mistake_of_decision(const Json& entry) {
  static const std::set<std::string> kStates{"open", "needs work", "approved"};
  if (!entry.is_object()) return "expected an object";
  const auto state = entry.find("state"), notes = entry.find("notes");
  if (state == entry.end() || !state->is_string() || !kStates.contains(state->get<std::string>()))
    return "state: expected open, needs work or approved";
  if (!is_text(entry, "by") || !is_text(entry, "date") || !is_text(entry, "of")) return "by, date, of: expected texts";
  if (notes != entry.end() && (!notes->is_array() || !std::all_of(notes->begin(), notes->end(), is_note)))
    return "notes: expected entries with a frame, a text, and marks as lists of points";
  return "";
}

const Decisions::File& Decisions::read(const fs::path& folder) {
  const auto [place, is_new] = files_.try_emplace(folder);
  File& file = place->second;
  std::error_code ignored;
  if (!is_new || !fs::exists(folder / kDecisionsName, ignored)) return file;
  const Json json = read_json_or_null(folder / kDecisionsName);
  if (json.is_object() && json.value("format", Json()) == "weft review 1" && json.contains("runs") &&
      json["runs"].is_object()) {
    file.runs = json["runs"];
  } else {
    file.problem = "expected what the page of weft review offers for download";
  }
  return file;
}

Json Decisions::of(RunFiles& run) {
  // The folders above the run up to `run.folder`, each with the path from this folder to the run. For the run
  // "stiff/band", these are stiff/ with "band", and `run.folder` with "stiff/band".
  const fs::path name = run.key;
  std::vector<std::pair<fs::path, std::string>> places;
  // Pictures such as band/00000.png are the run "band". A page that was made for the folder band/ alone calls this run
  // "band" too, and its review.json is in band/.
  if (!run.pictures.empty() && run.pictures.front().parent_path().lexically_relative(run.folder) == name)
    places.emplace_back(name, name.filename().string());
  std::string key = name.filename().string();
  for (fs::path below = name.parent_path();; below = below.parent_path()) {
    places.emplace_back(below, key);
    if (below.empty()) break;
    key = (below.filename() / key).generic_string();
  }
  Json latest;
  const auto date = [](const Json& entry) { return value_or(entry, "date", std::string()); };
  for (const auto& [below, key_there] : places) {
    const fs::path place = (run.folder / below).lexically_normal();
    const File& file = read(place);
    const auto entry = file.runs.find(key_there);
    std::string mistake = file.problem;
    if (mistake.empty() && entry != file.runs.end()) {
      mistake = mistake_of_decision(*entry);
      if (mistake.empty() && (latest.is_null() || date(*entry) > date(latest))) latest = *entry;
    }
    if (!mistake.empty()) run.problems.push_back((place / kDecisionsName).string() + ": " + mistake);
  }
  return latest;
}

std::string fingerprint(const RunFiles& run) {
  if (!run.video.empty()) return compare::short_hash(run.video);
  std::string hashes;
  for (const fs::path& picture : run.pictures) hashes += compare::short_hash(picture);
  return hashes.empty() ? "" : compare::short_hash_of(hashes);
}

std::string date_of(const RunFiles& run) {
  const fs::path file = !run.video.empty() ? run.video : !run.pictures.empty() ? run.pictures.front() : run.stats;
  struct stat status {};
  std::tm utc{};
  if (file.empty() || ::stat(file.c_str(), &status) != 0 || ::gmtime_r(&status.st_mtime, &utc) == nullptr) return "";
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text.data();
}

}  // namespace weft::review
