#include "review/output_folder.hpp"

#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

#include "core/error.hpp"
#include "review/find_runs.hpp"

namespace weft::review {
namespace {

namespace fs = std::filesystem;

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
}

// One step where the file system can exchange two names; else the former page is gone for a moment, never half.
bool exchange(const fs::path& fresh, const fs::path& former) {
  if (::renameat2(AT_FDCWD, fresh.c_str(), AT_FDCWD, former.c_str(), RENAME_EXCHANGE) == 0) return true;
  if (errno != EINVAL && errno != ENOSYS) return false;
  const fs::path aside = fresh.string() + ".former";
  if (std::rename(former.c_str(), aside.c_str()) != 0) return false;
  if (std::rename(fresh.c_str(), former.c_str()) != 0) return false;
  return std::rename(aside.c_str(), fresh.c_str()) == 0;
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& final_name, bool overwrite) {
  std::error_code error;
  final_name_ = fs::absolute(final_name, error).lexically_normal();
  if (!final_name_.has_filename()) final_name_ = final_name_.parent_path();  // "review/"
  check_replaceable(final_name_, overwrite);
  temporary_ = std::make_unique<TemporaryName>(final_name_, TemporaryName::Kind::folder);
}

void OutputFolder::commit() {
  // Without the flush a crash of the machine soon after the rename can leave empty files under the final name.
  int error = ::syncfs(temporary_->descriptor()) != 0 ? errno : 0;
  if (error == 0 && std::rename(path().c_str(), final_name_.c_str()) == 0) {  // takes the place of an empty folder, too
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
