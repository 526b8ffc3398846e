// Files that appear under their final name only when they are whole.
#pragma once

#include <cstddef>
#include <filesystem>

namespace weft {

/// A file written under a temporary name beside its final one. A crash leaves the temporary file at most; the final
/// name holds the old content or all of the new.
class OutputFile {
 public:
  /// Creates the empty temporary file: `band.mp4` becomes `band.partial.mp4`, or `band.partial2.mp4` and so on while
  /// other writers, or killed ones, have left such a name. Throws Error(output_failed).
  explicit OutputFile(std::filesystem::path file);
  ~OutputFile();  ///< without commit() or keep(): removes the temporary file
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Where the bytes go until commit(); also for libraries that open files by name.
  const std::filesystem::path& temporary() const { return temporary_; }

  /// Appends `size` bytes. Throws Error(output_failed) with the system's reason, such as a full disk.
  void write(const void* data, std::size_t size);

  /// Brings the bytes to the disk, then renames to the final name. Throws Error(output_failed).
  void commit();

  /// Leaves the temporary file where it is, for the user to rescue.
  void keep() { owned_ = false; }

 private:
  std::filesystem::path file_, temporary_;
  int descriptor_ = -1;
  bool owned_ = false;  ///< the temporary file is ours to remove
};

}  // namespace weft
