#include "tools/review/output_folder.hpp"

#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <system_error>

#include "core/error.hpp"
#include "core/input_file.hpp"
#include "tools/review/find_runs.hpp"

namespace weft::review {
namespace {

namespace fs = std::filesystem;

/// The first file in the folder that its list of files does not name; empty if there is none.
fs::path foreign_file(const fs::path& folder) {
  std::set<std::string> own{kFileList};
  std::istringstream lines(read_start(folder / kFileList, kMaxTextBytes));
  for (std::string line; std::getline(lines, line);) own.insert(line);
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (!fs::is_directory(entry->symlink_status()) &&
        !own.contains(entry->path().lexically_relative(folder).generic_string()))
      return entry->path();
  return {};
}

}  // namespace

void check_replaceable(const fs::path& folder, bool overwrite) {
  std::error_code error;
  const auto status = fs::symlink_status(folder, error);
  if (!fs::exists(status)) return;
  if (fs::is_directory(status) && fs::is_empty(folder, error)) return;
  if (!fs::is_directory(status) || !is_review_page(folder)) {
    throw Error(ExitCode::output_failed, "{}: expected a new folder, an empty one, or a former review page",
                folder.string());
  }
  if (!overwrite) {
    throw Error(ExitCode::output_failed, "{}: exists already; give --overwrite to replace it, or another name",
                folder.string());
  }
  if (!fs::exists(folder / kFileList, error))
    throw Error(
        ExitCode::output_failed,
        "{}: is a review page without its {}, so that nothing tells which files are its own; remove it, or give "
        "another name",
        folder.string(), kFileList);
  if (const fs::path other = foreign_file(folder); !other.empty())
    throw Error(ExitCode::output_failed, "{}: is no file of the review page in this folder; move it to another place",
                other.string());
}

namespace {

/// Writes the list of all files of a page into its folder.
void write_file_list(const fs::path& folder) {
  std::string list;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) list += entry.path().lexically_relative(folder).generic_string() + "\n";
  std::ofstream out(folder / kFileList, std::ios::binary);
  if (!(out << list).flush())
    throw Error(ExitCode::output_failed, "{}: cannot be written", (folder / kFileList).string());
}

// Exchanges both folders. The exchange is atomic if the file system supports it. Otherwise there is no page for a
// moment, but never an incomplete one.
bool exchange(const fs::path& fresh, const fs::path& former) {
  if (::renameat2(AT_FDCWD, fresh.c_str(), AT_FDCWD, former.c_str(), RENAME_EXCHANGE) == 0) return true;
  if (errno != EINVAL && errno != ENOSYS) return false;
  const fs::path aside = fresh.string() + ".former";
  if (std::rename(former.c_str(), aside.c_str()) != 0) return false;
  if (std::rename(fresh.c_str(), former.c_str()) != 0) return false;
  return std::rename(aside.c_str(), fresh.c_str()) == 0;
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& final_name, bool overwrite) : overwrite_(overwrite) {
  std::error_code error;
  final_name_ = fs::absolute(final_name, error).lexically_normal();
  if (!final_name_.has_filename()) final_name_ = final_name_.parent_path();  // "review/"
  check_replaceable(final_name_, overwrite);
  temporary_ = std::make_unique<TemporaryName>(final_name_, TemporaryName::Kind::folder);
}

void OutputFolder::commit() {
  write_file_list(path());
  check_replaceable(final_name_, overwrite_);  // the folder may have changed meanwhile
  // Without the flush, a crash of the machine soon after the rename could leave empty files under the final name.
  int error = ::syncfs(temporary_->descriptor()) != 0 ? errno : 0;
  if (error == 0 && std::rename(path().c_str(), final_name_.c_str()) == 0) {  // also replaces an empty folder
    temporary_->release();
  } else if (error == 0) {
    error = errno == ENOTEMPTY || errno == EEXIST ? 0 : errno;
    if (error == 0 && !exchange(path(), final_name_)) error = errno;
  }
  if (error != 0) {
    throw Error(ExitCode::output_failed, "{}: cannot be written: {}", final_name_.string(),
                std::generic_category().message(error));
  }
}

}  // namespace weft::review
