// What runs with a cache are tested on: a cloth that falls over a ball, and comparisons to the last bit.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "cli/subprocess.hpp"
#include "support/test_folder.hpp"

namespace weft::cli {

class CachedRun : public support::TestFolder {
 protected:
  using Arguments = std::vector<std::string>;
  static constexpr int kFrames = 21;

  void SetUp() override;

  /// `weft command...`, small and quick, in the folder of the test.
  Outcome weft(Arguments arguments) const;
  void expect_well(const Arguments& arguments) const;

  /// Files below a folder that end so, by their name, without those of working caches.
  std::map<std::string, std::string> contents(const std::string& folder, const std::string& ending) const;
  /// Expects the same files with the same bytes in both, and `count` of them.
  void expect_same(const std::string& a, const std::string& b, const std::string& ending, std::size_t count) const;
  /// Checksums of the decoded frames, by another program.
  std::string decoded(const std::string& video) const;
  /// One number for all that is drawn: positions, heat, cameras and lights of all frames of a cache.
  std::uint64_t hash_of_frames(const std::string& cache, int count) const;
};

}  // namespace weft::cli
