// Files that appear under their final name only when they are complete.
#pragma once

#include <filesystem>
#include <string_view>

namespace weft {

/// Whether a file is flushed to disk before it gets its name. Without the flush, a process that dies still leaves
/// complete files only, but a machine that crashes may leave empty ones, which the reader must notice.
enum class Flush { yes, no };

/// A temporary name for a file or folder while it is written: `.<name>.weft-<process>.tmp` in the folder of the final
/// name, so that the rename stays within one file system. The process keeps it locked (flock); the next process that
/// writes into the folder removes temporary files without a lock. The lock shows whether a process is alive. Process
/// numbers would not suffice: containers that share a folder do not share process numbers. If the temporary name would
/// exceed the limit of file systems, it contains a hash instead of the final name.
class TemporaryName {
 public:
  enum class Kind { file, folder };

  /// Creates missing folders. A folder that this process has used before is not created again: somebody has removed it
  /// on purpose. Creates the file or folder itself, empty. Throws Error(output_failed) with the system's reason.
  TemporaryName(const std::filesystem::path& final_name, Kind kind);
  /// Removes what still exists under the temporary name.
  ~TemporaryName();
  TemporaryName(const TemporaryName&) = delete;
  TemporaryName& operator=(const TemporaryName&) = delete;

  const std::filesystem::path& path() const { return path_; }
  int descriptor() const { return descriptor_; }
  /// Gives up the name: the destructor removes nothing.
  void release();

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;  // holds the lock
  int slot_ = -1;        // in the table that the signal handler reads; -1: none (folder, long path, full table)
};

/// A temporary file. Unless committed, the destructor or remove_temporary_files() removes it.
class TemporaryFile {
 public:
  /// Throws like TemporaryName(), and Error(output_failed) if the final name is a folder or a device.
  explicit TemporaryFile(std::filesystem::path final_name);

  const std::filesystem::path& path() const { return temporary_.path(); }

  /// Gives the closed file its final name, replacing an existing file if may_replace(). Throws Error(output_failed).
  void commit(Flush flush = Flush::yes);

 private:
  std::filesystem::path final_name_;
  TemporaryName temporary_;
};

/// For a file that did not exist when the command began, and that the command may not replace: if another process
/// creates it meanwhile, that file stays, and commit() fails. In effect until this process has written the file.
void keep_if_made_meanwhile(const std::filesystem::path& file);
/// Whether keep_if_made_meanwhile() is not in effect for a file.
bool may_replace(const std::filesystem::path& file);

/// The final name that a temporary name contains, or its hash; empty for other names.
std::string_view final_name_of(std::string_view temporary_name);

/// Whether a file has exactly this content.
bool holds(const std::filesystem::path& file, std::string_view content);

/// Removes the temporary files that have a slot (TemporaryName::slot_), but no folders. Call it right before _exit().
/// Async-signal-safe.
void remove_temporary_files() noexcept;

/// Writes `content` to `file` through a TemporaryFile. Throws Error(output_failed) with the system's reason.
void write_file(const std::filesystem::path& file, std::string_view content, Flush flush = Flush::yes);

/// Creates and removes a file beside `file`, because permissions alone do not show whether `file` can be written
/// (read-only mounts, root, quotas). Creates missing folders. Throws Error(output_failed) with the system's reason.
void check_writable(const std::filesystem::path& file);

}  // namespace weft
