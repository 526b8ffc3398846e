// New references, and the log of why they are.
#pragma once

#include <filesystem>
#include <string>

namespace weft::compare {

/// One reference about to be replaced.
struct Acceptance {
  std::filesystem::path test, reference;  ///< what it becomes; may not exist yet
  std::filesystem::path log;              ///< accepted.md
  std::string reason, user;

  /// From the file to accept and the reference named on the command line: a file, or a folder whose reference of this
  /// `name` is meant, as `find_reference` finds it. Throws Error: usage where both do not fit together,
  /// asset_unreadable where the test is no whole picture or video.
  static Acceptance plan(const std::filesystem::path& reference, const std::filesystem::path& test,
                         const std::string& name);

  /// Adds a line to the log, then puts the test in the place of the reference; both appear whole or not at all, and no
  /// reference is ever without its line. False, and nothing done, where both are equal in every pixel. Throws
  /// Error(output_failed).
  bool carry_out() const;
};

/// SHA-256 of a file, the first 16 hexadecimal digits. Throws Error(asset_unreadable).
std::string short_hash(const std::filesystem::path& file);
std::string short_hash_of(const std::string& bytes);

}  // namespace weft::compare
