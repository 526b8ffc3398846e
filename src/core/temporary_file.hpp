// Files appear under their final name only when they are whole.
#pragma once

#include <filesystem>
#include <string_view>

namespace weft {

/// Whether a file must be on the disk, not only in the system's memory, before it gets its name. Without it a process
/// that dies leaves whole files all the same; a machine that dies may leave empty ones, so the reader has to notice.
enum class Flush { yes, no };

/// A name that is held while something is written under it: `.<name>.weft-<process>.tmp` in the folder of the final
/// name, so that the rename stays within one file system. What is there is locked (flock) as long as its process lives:
/// the next one that writes into the folder removes what is not. Process numbers alone would not do: containers that
/// share a folder do not share them.
class TemporaryName {
 public:
  enum class Kind { file, folder };

  /// Makes missing folders, unless this process has used them before: then somebody has removed them. Makes the file or
  /// folder itself, empty. Throws Error(output_failed) with the system's reason.
  TemporaryName(const std::filesystem::path& final_name, Kind kind);
  /// Removes what is still there under the temporary name.
  ~TemporaryName();
  TemporaryName(const TemporaryName&) = delete;
  TemporaryName& operator=(const TemporaryName&) = delete;

  const std::filesystem::path& path() const { return path_; }
  int descriptor() const { return descriptor_; }
  /// There is nothing left to remove.
  void release();

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;  // holds the lock
  int slot_ = -1;  // in the table that the signal handler reads; -1: table full, the destructor still removes the file
};

/// A file to write to first. Unless committed, it is removed by the destructor, and by remove_temporary_files().
class TemporaryFile {
 public:
  /// As TemporaryName, and refuses a final name that is a folder or a device.
  explicit TemporaryFile(std::filesystem::path final_name);

  const std::filesystem::path& path() const { return temporary_.path(); }

  /// Gives the closed file its final name, replacing what was there if may_replace(). Throws Error(output_failed).
  void commit(Flush flush = Flush::yes);

 private:
  std::filesystem::path final_name_;
  TemporaryName temporary_;
};

/// For a file that was not there when the command began and that it may not replace: if somebody makes one meanwhile,
/// that file stays, and what was to get the name is refused at the end. Ends when this process has written the file.
void keep_if_made_meanwhile(const std::filesystem::path& file);
/// Not so.
bool may_replace(const std::filesystem::path& file);

/// The final name in a temporary one; empty for other names.
std::string_view final_name_of(std::string_view temporary_name);

/// Whether a file has exactly this content.
bool holds(const std::filesystem::path& file, std::string_view content);

/// Removes every temporary file of this process. Async-signal-safe: for the moment before _exit().
void remove_temporary_files() noexcept;

/// Writes `content` to `file` through a TemporaryFile. Throws Error(output_failed) with the system's reason.
void write_file(const std::filesystem::path& file, std::string_view content, Flush flush = Flush::yes);

/// Makes a file for a moment beside `file`: permissions alone do not tell whether it can be written (read-only mounts,
/// root, quotas). Makes missing folders. Throws Error(output_failed) with the system's reason.
void check_writable(const std::filesystem::path& file);

}  // namespace weft
