// Replaces references (accepted pictures and videos that new ones are compared with), and logs the reasons.
#pragma once

#include <filesystem>
#include <string>

namespace weft::compare {

/// A planned replacement of a reference.
struct Acceptance {
  std::filesystem::path test, reference;  ///< `test` replaces `reference`, which may not exist yet
  std::filesystem::path log;              ///< accepted.md
  std::string reason, user;

  /// Plans the replacement; changes no file. `reference`: a file, or a folder in which `find_reference` looks up
  /// `name`. If it finds nothing, `test` becomes a new reference. Throws Error(usage) if `test` is neither picture nor
  /// video or the extensions differ, and Error(asset_unreadable) if `test` is not complete.
  static Acceptance plan(const std::filesystem::path& reference, const std::filesystem::path& test,
                         const std::string& name);

  /// Adds a line to the log, then replaces the reference, so that the log names every replacement. Replaces both files
  /// atomically, and locks the folder of the log against other calls in any process. If test and reference are equal in
  /// every pixel, changes nothing and returns false. Throws Error(output_failed).
  bool carry_out() const;
};

/// SHA-256 of a file, the first 16 hexadecimal digits. Throws Error(asset_unreadable).
std::string short_hash(const std::filesystem::path& file);
/// The same hash of `bytes`.
std::string short_hash_of(const std::string& bytes);

}  // namespace weft::compare
