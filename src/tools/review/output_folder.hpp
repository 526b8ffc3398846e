// A folder that gets its final name only when it is complete.
#pragma once

#include <filesystem>
#include <memory>

#include "core/temporary_file.hpp"

namespace weft::review {

/// Name of the file that lists the files of a page, one per line. `weft review` replaces a page
/// only if this list names all files in its folder.
inline constexpr const char* kFileList = "files.txt";

/// Returns if `folder` does not exist, is empty, or contains a page that may be replaced; otherwise
/// throws Error(output_failed). A page may be replaced if `overwrite` is set and kFileList names
/// all files in the folder.
void check_replaceable(const std::filesystem::path& folder, bool overwrite);

/// A hidden temporary folder beside the final one. The destructor removes it unless commit() has succeeded.
class OutputFolder {
 public:
  /// Throws as check_replaceable() does.
  OutputFolder(const std::filesystem::path& final_name, bool overwrite);

  const std::filesystem::path& path() const { return temporary_->path(); }

  /// Flushes all files to disk, and gives the folder its final name. If a page with this name
  /// exists, exchanges the two folders (atomically, if the file system supports it); the destructor
  /// then removes the old page. Throws Error(output_failed).
  void commit();

 private:
  std::filesystem::path final_name_;
  bool overwrite_ = false;
  std::unique_ptr<TemporaryName> temporary_;
};

}  // namespace weft::review
