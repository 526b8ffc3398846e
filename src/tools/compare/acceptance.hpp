// Replacement of references, and the log of the reasons.
#pragma once

#include <filesystem>
#include <string>

namespace weft::compare {

/// A planned replacement of a reference.
struct Acceptance {
  std::filesystem::path test, reference;  ///< `test` replaces `reference`, which may not exist yet
  std::filesystem::path log;              ///< accepted.md
  std::string reason, user;

  /// Plans the replacement. `reference` is the one named on the command line: a file, or a folder in which
  /// `find_reference` looks up `name`. Throws Error: usage if `reference` and `test` do not fit together,
  /// asset_unreadable if the test is not a complete picture or video.
  static Acceptance plan(const std::filesystem::path& reference, const std::filesystem::path& test,
                         const std::string& name);

  /// Adds a line to the log, then replaces the reference, so that every replaced reference has its line. Each of the
  /// two files is replaced atomically. Other processes that accept into the same folder wait meanwhile. Returns false
  /// without any change if test and reference are equal in every pixel. Throws Error(output_failed).
  bool carry_out() const;
};

/// SHA-256 of a file, the first 16 hexadecimal digits. Throws Error(asset_unreadable).
std::string short_hash(const std::filesystem::path& file);
/// The same hash of `bytes`.
std::string short_hash_of(const std::string& bytes);

}  // namespace weft::compare
