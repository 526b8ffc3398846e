// Output files that get their final name only when they are complete.
#pragma once

#include <filesystem>
#include <string_view>

namespace weft {

/// Whether a file is flushed to disk before it gets its final name. Without the flush, a crash of
/// the machine may leave empty files, which readers must detect; a crash of the process alone
/// leaves only complete files.
enum class Flush { yes, no };

/// Name of a file or folder while it is written: `.<name>.weft-<process>.tmp` in the folder of the
/// final name, so that the rename stays within one file system. If this name would be too long for
/// a file system, it contains a hash instead of `<name>`. The process keeps the file or folder
/// locked (flock). When a process first writes into a folder, it removes the temporary files there
/// that are not locked, because their processes have died. Process numbers would not show this,
/// because containers that share a folder do not share process numbers.
class TemporaryName {
 public:
  enum class Kind { file, folder };

  /// Creates missing parent folders, then the file or folder itself, empty. If this process has
  /// used the parent folder before and the folder is now missing, does not create the folder again,
  /// because somebody has removed it on purpose. Throws Error(output_failed) with the system's
  /// reason if the file or folder cannot be created.
  TemporaryName(const std::filesystem::path& final_name, Kind kind);
  /// Removes the file or folder, unless it was renamed or released.
  ~TemporaryName();
  TemporaryName(const TemporaryName&) = delete;
  TemporaryName& operator=(const TemporaryName&) = delete;

  const std::filesystem::path& path() const { return path_; }
  int descriptor() const { return descriptor_; }
  /// Ends the lock; the destructor then removes nothing.
  void release();

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;  // holds the lock
  // Index into the table of the files that remove_temporary_files() removes; -1: not in this table,
  // because it is a folder, its path is too long, or the table is full.
  int slot_ = -1;
};

/// A temporary file. If commit() has not renamed it, the destructor or remove_temporary_files()
/// removes it.
class TemporaryFile {
 public:
  /// Throws like TemporaryName(), and Error(output_failed) if the final name is a folder or a device.
  explicit TemporaryFile(std::filesystem::path final_name);

  const std::filesystem::path& path() const { return temporary_.path(); }

  /// Gives the file its final name; the caller must have closed the file. Replaces an existing file of this name if
  /// may_replace() is true. Throws Error(output_failed) if the name exists and may_replace() is false, or if flushing
  /// or renaming fails.
  void commit(Flush flush = Flush::yes);

 private:
  std::filesystem::path final_name_;
  TemporaryName temporary_;
};

/// Call protect_missing_file() if `file` does not exist when the command begins and the command
/// must not replace files. If another process creates `file` later, that file stays, and commit()
/// fails. The protection ends when this process has written `file`.
void protect_missing_file(const std::filesystem::path& file);
/// Whether `file` is not protected by protect_missing_file().
bool may_replace(const std::filesystem::path& file);

/// The final name (or its hash) that a temporary name contains; empty if `temporary_name` is not a temporary name.
std::string_view final_name_of(std::string_view temporary_name);

/// Whether the open file or folder still has this name; another process may have removed or replaced it.
bool has_name(const std::filesystem::path& path, int descriptor);

/// Whether a file has exactly this content.
bool holds(const std::filesystem::path& file, std::string_view content);

/// Removes the temporary files of this process, except folders and files that did not fit into a
/// table of 64 entries. Async-signal-safe: a signal handler calls it right before _exit().
void remove_temporary_files() noexcept;

/// Writes `content` to `file` through a TemporaryFile. If may_replace() is false but `file` exists
/// with this content, keeps `file`. Throws Error(output_failed), with the system's reason, if
/// `file` cannot be written.
void write_file(const std::filesystem::path& file, std::string_view content, Flush flush = Flush::yes);

/// Throws Error(output_failed), with the system's reason, if `file` cannot be written. Permissions alone do not show
/// this (read-only mounts, root, quotas), so the function creates and removes a temporary file beside `file`. Creates
/// missing folders.
void check_writable(const std::filesystem::path& file);

}  // namespace weft
