// The archive that `ninja bundle` makes, for the machines of a farm on which nothing is installed.
#pragma once

#include <filesystem>
#include <string>

namespace weft::cli {

/// Such an archive, read and checked as a whole: a stopped download and the archive of another program are found before
/// any task starts.
class ProgramArchive {
 public:
  /// Throws Error(asset_unreadable) with what was expected.
  explicit ProgramArchive(const std::filesystem::path& file);

  /// Differs between contents; 16 hexadecimal digits.
  const std::string& fingerprint() const { return fingerprint_; }
  /// As an uncompressed archive, for which any tar program does. Throws Error(output_failed).
  void write_tar(const std::filesystem::path& tar) const;

 private:
  std::filesystem::path file_;
  std::string compressed_, fingerprint_;
};

}  // namespace weft::cli
