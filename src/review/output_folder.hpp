// A folder that appears under its final name only when it is whole.
#pragma once

#include <filesystem>
#include <memory>

#include "core/temporary_file.hpp"

namespace weft::review {

/// The files of a page, one a line: what a later page may remove.
inline constexpr const char* kFileList = "files.txt";

/// Throws Error(output_failed) where a page in place of `folder` would lose something: a page that exists, unless
/// `overwrite` is set, and in any case a file that no page has put there.
void check_replaceable(const std::filesystem::path& folder, bool overwrite);

/// A hidden folder beside the final one to write into first. Unless committed, it is removed by the destructor.
class OutputFolder {
 public:
  /// Throws as check_replaceable().
  OutputFolder(const std::filesystem::path& final_name, bool overwrite);

  const std::filesystem::path& path() const { return temporary_->path(); }

  /// Flushes everything to disk and gives the folder its final name; a former page is exchanged for it in one step,
  /// then removed. Throws Error(output_failed).
  void commit();

 private:
  std::filesystem::path final_name_;
  bool overwrite_ = false;
  std::unique_ptr<TemporaryName> temporary_;
};

}  // namespace weft::review
