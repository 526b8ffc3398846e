// Truncated files and files with changed bytes. Each file is either loaded as a valid mesh, or refused with its name.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "assets/small_files.hpp"
#include "core/error.hpp"
#include "film/assets/mesh_file.hpp"
#include "physics/mesh/topology.hpp"

namespace weft::assets {
namespace {

namespace fs = std::filesystem;

struct Format {
  const char* extension;
  std::string (*make)();
  int trials = 80;       ///< number of files with changed bytes
  std::size_t step = 7;  ///< difference of consecutive truncated lengths [bytes]
};

class DamagedFiles : public testing::TestWithParam<Format> {
 protected:
  DamagedFiles()
      : folder_(fs::path(testing::TempDir()) / ("weft_damaged_" + std::to_string(::getpid()))),
        file_(folder_ / (std::string("mesh.") + GetParam().extension)),
        whole_(GetParam().make()) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~DamagedFiles() override { fs::remove_all(folder_); }

  /// Returns true if these bytes are accepted. The test fails unless the result is a valid mesh or an asset error.
  bool try_to_load(const std::string& bytes) {
    std::ofstream(file_, std::ios::binary) << bytes;
    try {
      const mesh::Mesh mesh = load_mesh(file_, {}, "scene").mesh;
      const auto report = mesh::inspect(mesh.topology.triangles, mesh.positions.size());
      EXPECT_TRUE(report.out_of_range.empty() && report.degenerate.empty());
      EXPECT_FALSE(mesh.topology.triangles.empty());
      for (const Vec3& x : mesh.positions) EXPECT_TRUE(x.allFinite());
      return true;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::asset_unreadable) << error.what();
      return false;
    }
  }

  fs::path folder_, file_;
  std::string whole_;
};

TEST_P(DamagedFiles, CutShortAnywhereAreLoadedOrRefused) {
  EXPECT_TRUE(try_to_load(whole_));
  for (std::size_t length = 0; length < whole_.size(); length += GetParam().step) try_to_load(whole_.substr(0, length));
  EXPECT_FALSE(try_to_load(whole_.substr(0, whole_.size() / 4)));
}

TEST_P(DamagedFiles, WithBytesChangedAreLoadedOrRefused) {
  std::mt19937 random(20240601);
  int refused = 0;
  for (int trial = 0; trial < GetParam().trials; ++trial) {
    std::string bytes = whole_;
    const std::uint32_t changes = 1 + random() % 4;
    for (std::uint32_t k = 0; k < changes; ++k) bytes[random() % bytes.size()] = static_cast<char>(random() % 256);
    refused += try_to_load(bytes) ? 0 : 1;
  }
  EXPECT_GT(refused, 0);  // otherwise, no damage was detected
}

INSTANTIATE_TEST_SUITE_P(Formats, DamagedFiles,
                         testing::Values(Format{"obj", obj_cube, 20, 29}, Format{"ply", ply_tetrahedron},
                                         Format{"stl", stl_tetrahedron}, Format{"gltf", gltf_tetrahedron}),
                         [](const auto& format) { return format.param.extension; });
// Assimp clears 16 MB for each OBJ file, which takes 0.1 s.
INSTANTIATE_TEST_SUITE_P(SlowFormats, DamagedFiles, testing::Values(Format{"obj", obj_cube}),
                         [](const auto& format) { return format.param.extension; });

}  // namespace
}  // namespace weft::assets
