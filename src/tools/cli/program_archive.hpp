// The archive that `ninja bundle` makes, for farm machines on which nothing is installed.
#pragma once

#include <filesystem>
#include <string>

namespace weft::cli {

/// A program archive. The constructor reads and checks it completely, so that a truncated download or the archive of
/// another program is found before any task starts.
class ProgramArchive {
 public:
  /// Throws Error(asset_unreadable) with what was expected.
  explicit ProgramArchive(const std::filesystem::path& file);

  /// Hash of the content; 16 hexadecimal digits.
  const std::string& fingerprint() const { return fingerprint_; }
  /// Writes the archive uncompressed, so that any tar program can read it. Throws Error(output_failed).
  void write_tar(const std::filesystem::path& tar) const;

 private:
  std::filesystem::path file_;
  std::string compressed_, fingerprint_;
};

}  // namespace weft::cli
