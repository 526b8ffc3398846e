// The archive of the program that `ninja bundle` makes, for machines of a farm on which nothing is installed.
#pragma once

#include <filesystem>
#include <string>

namespace weft::cli {

/// The archive, compressed with zstd. The constructor reads and checks all of it, so that weft farm refuses a truncated
/// archive, or one of another program, before any task starts.
class ProgramArchive {
 public:
  /// Throws Error(asset_unreadable) with the defect.
  explicit ProgramArchive(const std::filesystem::path& file);

  /// Hash of the compressed archive; 16 hexadecimal digits.
  const std::string& fingerprint() const { return fingerprint_; }
  /// Writes the archive uncompressed, so that any tar program can read it. Throws Error(output_failed).
  void write_tar(const std::filesystem::path& tar) const;

 private:
  std::string compressed_, fingerprint_;
};

}  // namespace weft::cli
