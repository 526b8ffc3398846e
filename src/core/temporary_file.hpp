// Files appear under their final name only when they are whole.
#pragma once

#include <filesystem>
#include <string_view>

namespace weft {

/// Whether a file must be on the disk, not only in the system's memory, before it gets its name. Without it a process
/// that dies leaves whole files all the same; a machine that dies may leave empty ones, so the reader has to notice.
enum class Flush { yes, no };

/// A name beside the final one to write to first: `.<name>.<process>.tmp` in the same folder, so that the rename stays
/// within one file system. Unless committed, the file is removed by the destructor, and by remove_temporary_files().
class TemporaryFile {
 public:
  /// Makes missing folders, not the file. Throws Error(output_failed) with the system's reason.
  explicit TemporaryFile(std::filesystem::path final_name);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// Gives the closed file its final name, replacing what was there. Throws Error(output_failed).
  void commit(Flush flush = Flush::yes);

 private:
  std::filesystem::path final_name_, path_;
  int slot_ = -1;  // in the table that the signal handler reads; -1: table full, the destructor still removes the file
};

/// Removes every temporary file of this process. Async-signal-safe: for the moment before _exit().
void remove_temporary_files() noexcept;

/// Writes `content` to `file` through a TemporaryFile. Throws Error(output_failed) with the system's reason.
void write_file(const std::filesystem::path& file, std::string_view content, Flush flush = Flush::yes);

}  // namespace weft
