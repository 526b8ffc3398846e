// The archive that `ninja bundle` makes, for farm machines on which nothing is installed.
#pragma once

#include <filesystem>
#include <string>

namespace weft::cli {

/// A program archive, read and checked completely, so that a truncated download or the archive of another program is
/// found before any task starts.
class ProgramArchive {
 public:
  /// Throws Error(asset_unreadable) with what was expected.
  explicit ProgramArchive(const std::filesystem::path& file);

  /// Hash of the content; 16 hexadecimal digits.
  const std::string& fingerprint() const { return fingerprint_; }
  /// Writes it as an uncompressed archive, which any tar program reads. Throws Error(output_failed).
  void write_tar(const std::filesystem::path& tar) const;

 private:
  std::filesystem::path file_;
  std::string compressed_, fingerprint_;
};

}  // namespace weft::cli
