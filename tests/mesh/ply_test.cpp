#include "physics/mesh/ply.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <limits>
#include <string>

#include "support/ply.hpp"
#include "support/test_folder.hpp"

namespace weft::mesh {
namespace {

using Triangles = std::vector<std::array<Index, 3>>;

// Values that reveal a change of any bit.
const std::vector<Vec3> kPositions{
    {0, -0.0, 1.0 / 3}, {1e-310, std::numeric_limits<double>::max(), -1}, {0.1, 0.2, 0.30000000000000004}};
const Triangles kTriangles{{0, 1, 2}, {2, 1, 0}};

class Ply : public support::TestFolder {
 protected:
  std::filesystem::path file() const { return folder_ / "mesh.ply"; }
};

TEST_F(Ply, FilesHoldLittleEndianDoublesAndTriangles) {
  write_ply(file(), kPositions, kTriangles);
  const std::string bytes = support::read_bytes(file());
  const std::string header =
      "ply\nformat binary_little_endian 1.0\ncomment Weft, metres\nelement vertex 3\nproperty double x\n"
      "property double y\nproperty double z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n";
  ASSERT_EQ(bytes.substr(0, header.size()), header);
  ASSERT_EQ(bytes.size(), header.size() + 3 * 24 + 2 * 13);
  double third = 0;
  std::memcpy(&third, &bytes[header.size() + 16], 8);
  EXPECT_EQ(third, 1.0 / 3);
  const std::string faces = bytes.substr(header.size() + 72);
  EXPECT_EQ(faces, std::string("\3\0\0\0\0\1\0\0\0\2\0\0\0\3\2\0\0\0\1\0\0\0\0\0\0\0", 26));
}

TEST_F(Ply, HasValuesOfVerticesUnderTheirName) {
  const std::vector<Vec2> uv{{0, 0}, {0.5, 0}, {0, 0.25}};
  const std::vector<float> strain{0.01F, 0.5F, 0.125F};
  write_ply(file(), kPositions, kTriangles, {.uv = uv, .values = strain, .values_name = "strain"});
  const std::string bytes = support::read_bytes(file());
  const std::string names =
      "property double z\nproperty float s\nproperty float t\nproperty float strain\nelement face";
  ASSERT_NE(bytes.find(names), std::string::npos) << bytes.substr(0, 300);
  const std::size_t begin = bytes.find("end_header\n") + 11;
  ASSERT_EQ(bytes.size(), begin + 3 * (24 + 8 + 4) + 2 * 13);
  for (std::size_t v = 0; v < 3; ++v) {
    float value = 0, t = 0;
    std::memcpy(&t, &bytes[begin + 36 * v + 28], 4);
    std::memcpy(&value, &bytes[begin + 36 * v + 32], 4);
    EXPECT_EQ(t, static_cast<float>(uv[v].y()));
    EXPECT_EQ(value, strain[v]);
  }
}

TEST_F(Ply, ReadsBackBitForBit) {
  write_ply(file(), kPositions, kTriangles);
  const support::PlyMesh mesh = support::read_ply(file());
  ASSERT_EQ(mesh.positions.size(), kPositions.size());
  EXPECT_EQ(std::memcmp(mesh.positions.data(), kPositions.data(), 3 * sizeof(Vec3)), 0);
  EXPECT_EQ(mesh.triangles, kTriangles);
}

TEST_F(Ply, OfNothingIsAFileToo) {
  write_ply(file(), {}, {});
  const support::PlyMesh mesh = support::read_ply(file());
  EXPECT_TRUE(mesh.positions.empty());
  EXPECT_TRUE(mesh.triangles.empty());
}

TEST_F(Ply, ReplacesAnOlderFileAndLeavesNothingElse) {
  support::write_bytes(file(), "older");
  write_ply(file(), kPositions, kTriangles);
  EXPECT_EQ(support::read_ply(file()).triangles, kTriangles);
  EXPECT_EQ(files().size(), 1U);
}

TEST_F(Ply, ToAPlaceThatCannotBeWrittenIsAnOutputError) {
  support::write_bytes(file(), "a file where a folder is needed");
  support::expect_error(ExitCode::output_failed, "mesh.ply",
                        [&] { write_ply(file() / "mesh.ply", kPositions, kTriangles); });
}

}  // namespace
}  // namespace weft::mesh
