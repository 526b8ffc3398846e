#include "tools/cli/path_ledger.hpp"

#include <sys/stat.h>

#include <optional>
#include <system_error>

#include "core/error.hpp"
#include "core/temporary_file.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

// Removes a slash at the end.
fs::path without_trailing_slash(const fs::path& path) {
  return path.has_filename() ? path : path.parent_path();
}

}  // namespace

std::string PathLedger::resolved(const fs::path& path) {
  const fs::path absolute = fs::absolute(without_trailing_slash(path)), folder = absolute.parent_path(),
                 name = absolute.filename();
  std::error_code error;
  const bool leads_elsewhere = name == "." || name == ".." || fs::is_symlink(absolute, error);
  if (leads_elsewhere || folder == absolute) {
    const fs::path canonical = fs::weakly_canonical(absolute, error);
    return error ? absolute.lexically_normal().string() : without_trailing_slash(canonical).string();
  }
  auto known = folders_.find(folder.string());
  if (known == folders_.end()) known = folders_.emplace(folder.string(), resolved(folder)).first;
  return (fs::path(known->second) / name).string();
}

void PathLedger::add_input(const fs::path& path, const std::string& what, bool searched) {
  const std::string text = what + ", which is read";
  places_.emplace(resolved(path), Place{text, searched});
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode))
    inputs_.emplace(FileId{status.st_dev, status.st_ino}, text);
}

void PathLedger::reads(const fs::path& file, const std::string& what) {
  add_input(file, what, false);
}

void PathLedger::reads_folder(const fs::path& folder, const std::string& what) {
  add_input(folder, what, false);
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    add_input(entry->path(), what, false);
}

void PathLedger::searches(const fs::path& folder, const std::string& what) {
  add_input(folder, what, true);
}

void PathLedger::add_output(const std::string& option, const fs::path& path) {
  const auto refuse = [&](const std::string& relation) {
    throw Error(ExitCode::usage, "{}: {} {}; give it a place of its own", option, path.string(), relation);
  };
  const std::string place = resolved(path);
  if (const auto same = places_.find(place); same != places_.end()) refuse("is " + same->second.what);
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0)
    if (const auto same = inputs_.find({status.st_dev, status.st_ino}); same != inputs_.end())
      refuse("is " + same->second);
  for (fs::path above = fs::path(place).parent_path();; above = above.parent_path()) {
    const auto around = places_.find(above.string());
    if (around != places_.end() && !around->second.searched) refuse("lies in " + around->second.what);
    if (above == above.parent_path()) break;
  }
  const auto inside = places_.lower_bound(place + "/");
  if (inside != places_.end() && inside->first.starts_with(place + "/")) refuse("holds " + inside->second.what);
}

void PathLedger::writes(const std::string& option, const fs::path& place, const std::vector<fs::path>& files) {
  for (const fs::path& file : files) add_output(option, file);
  // Registers the files after all checks, so that files of one output do not conflict with each other.
  for (const fs::path& file : files) places_.emplace(resolved(file), Place{"what " + option + " writes"});
  outputs_.push_back({option + " " + resolved(place), files, {}});
}

void PathLedger::writes_content(const std::string& option, const fs::path& file, const std::string& content) {
  writes(option, file);
  outputs_.back().content = content;
}

void PathLedger::register_output_folder(const std::string& option, const fs::path& folder) {
  add_output(option, folder);
  places_.emplace(resolved(folder), Place{"what " + option + " fills"});
}

void PathLedger::check_absent(bool overwrite, const std::set<std::string>& own,
                              const std::function<bool(const fs::path&)>& is_own) const {
  for (const Output& output : outputs_) {
    const bool is_continued = own.contains(output.name);
    for (const fs::path& file : output.files) {
      std::error_code error;  // if the path cannot be accessed, writing it reports the error
      if (fs::is_directory(file, error))
        throw Error(ExitCode::output_failed, "{}: is a folder, expected a file name", file.string());
      // Temporary names are shorter: without this check, such a file would fail when it is complete.
      if (error == std::errc::filename_too_long)
        throw Error(ExitCode::usage, "{}: its name is too long; give a shorter one", file.string());
      // A symbolic link counts as an existing file even if its target does not exist.
      if (overwrite) continue;
      if (!fs::exists(fs::symlink_status(file, error))) {
        protect_missing_file(file);
        continue;
      }
      if (!output.content.empty() && holds(file, output.content)) continue;
      if (is_continued && is_own(file)) continue;
      throw Error(ExitCode::output_failed, "{}: exists already; give --overwrite to replace it, or another name",
                  file.string());
    }
  }
}

void PathLedger::check_writable() const {
  for (const Output& output : outputs_)
    if (!output.files.empty()) weft::check_writable(output.files.front());
}

std::set<std::string> PathLedger::outputs() const {
  std::set<std::string> names;
  for (const Output& output : outputs_) names.insert(output.name);
  return names;
}

}  // namespace weft::cli
