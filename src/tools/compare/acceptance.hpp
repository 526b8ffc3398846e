// Replaces references, and logs the reasons. A reference is an accepted picture or video with which
// new files are compared.
#pragma once

#include <filesystem>
#include <string>

namespace weft::compare {

/// A planned replacement of a reference.
struct Acceptance {
  std::filesystem::path test, reference;  ///< `test` replaces `reference`, which may not exist yet
  std::filesystem::path log;              ///< accepted.md in the folder of the references
  std::string reason, user;

  /// Plans the replacement; changes no file. `reference`: a file, or a folder in which
  /// `find_reference` (references.hpp) looks up `name`. If the folder has no such reference, `test`
  /// becomes a new one (in its subfolder `default`, if that exists). The caller sets `reason` and
  /// `user`. Throws Error(usage) if `test` is neither picture nor video, or if `reference` is a
  /// file with a different extension. Throws Error(asset_unreadable) if `test` cannot be read to
  /// its end.
  static Acceptance plan(const std::filesystem::path& reference, const std::filesystem::path& test,
                         const std::string& name);

  /// Adds a line to the log, then replaces the reference, so that the log names every replacement.
  /// Replaces each of the two files atomically. Locks the folder of the log against other calls in
  /// any process. If the test and an existing reference are equal in every pixel, changes nothing
  /// and returns false. Throws Error(output_failed), and Error(asset_unreadable) if the test or the
  /// log cannot be read.
  bool carry_out() const;
};

/// SHA-256 of a file, the first 16 hexadecimal digits. Throws Error(asset_unreadable).
std::string short_hash(const std::filesystem::path& file);
/// The same hash of `bytes`.
std::string short_hash_of(const std::string& bytes);

}  // namespace weft::compare
