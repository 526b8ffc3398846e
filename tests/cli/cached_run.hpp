// Fixture for tests of runs with a cache: a cloth that falls over a ball, and bitwise comparisons.
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

  /// Runs `weft command...` with small, quick settings in the folder of the test.
  Outcome weft(const Arguments& arguments) const;
  void expect_well(const Arguments& arguments) const;

  /// Contents of the files below a folder whose names end with `ending`, by name. Working caches are left out.
  std::map<std::string, std::string> contents(const std::string& folder, const std::string& ending) const;
  /// Expects `count` files in both folders, with the same names and bytes.
  void expect_same(const std::string& a, const std::string& b, const std::string& ending, std::size_t count) const;
  /// Checksums of the decoded frames, computed by ffmpeg.
  std::string decoded(const std::string& video) const;
  /// Hash of everything that is drawn: positions, heat, cameras and lights of `count` frames of a cache.
  std::uint64_t hash_of_frames(const std::string& cache, int count) const;
};

}  // namespace weft::cli
