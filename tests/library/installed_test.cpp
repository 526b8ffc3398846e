// A program outside of the source tree uses what `cmake --install` installs.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "library/scenes.hpp"
#include "support/ply.hpp"
#include "support/test_folder.hpp"

namespace weft::library {
namespace {

namespace fs = std::filesystem;

class InstalledLibrary : public support::TestFolder {
 protected:
  // Output of `command`, run in the folder of the test; if it fails, standard output and standard error.
  std::string run(const std::string& command) {
    const std::string line = "cd '" + folder_.string() + "' && { " + command + "; } 2>errors";
    FILE* pipe = ::popen(line.c_str(), "r");
    std::string output;
    char bytes[4096];
    for (std::size_t count; (count = std::fread(bytes, 1, sizeof bytes, pipe)) > 0;) output.append(bytes, count);
    const int status = ::pclose(pipe);
    EXPECT_EQ(status, 0) << command << "\n" << output << support::read_bytes(folder_ / "errors");
    return output;
  }

  void install() { run("cmake --install '" WEFT_BUILD_DIR "' --prefix '" + (folder_ / "prefix").string() + "'"); }

  std::string needed_by(const std::string& file) { return run("LC_ALL=C readelf -d '" + file + "' | grep NEEDED"); }
};

TEST_F(InstalledLibrary, StepsAsTheProgramDoes) {
  install();
  support::write_bytes(folder_ / "a.toml", kDrape);
  run("cmake -S '" WEFT_SOURCE_DIR "/tests/library/example' -B example -DCMAKE_PREFIX_PATH='" +
      (folder_ / "prefix").string() + "' && cmake --build example");
  std::istringstream printed(run("example/drape a.toml sheet"));
  run("prefix/bin/weft simulate a.toml --cache cache --meshes meshes --set cloth.sheet.material.fabric=silk");
  const support::PlyMesh mesh = support::read_ply(folder_ / "meshes/sheet_00010.ply");
  ASSERT_EQ(mesh.positions.size(), 256u);
  for (const Vec3& x : mesh.positions) {
    Vec3 got;
    printed >> got.x() >> got.y() >> got.z();
    ASSERT_TRUE(printed);
    EXPECT_EQ(got, x);
  }
}

TEST_F(InstalledLibrary, OfThePhysicsStepsAModelWithoutAnInstallation) {
  run("cmake -S '" WEFT_SOURCE_DIR "/tests/library/example' -B example -DWeft_DIR='" WEFT_BUILD_DIR
      "' && cmake --build example --target sheet");
  std::istringstream printed(run("example/sheet 9"));
  std::vector<Vec3> got;
  for (Vec3 x; printed >> x.x() >> x.y() >> x.z();) got.push_back(x);
  ASSERT_EQ(got.size(), 81U);
  EXPECT_EQ(got[0], Vec3(0, 0, 0));
  EXPECT_EQ(got[8], Vec3(1, 0, 0));
  // A free fall of 0.4 s would be 0.8 m long; the far side swings about the pinned corners.
  EXPECT_LT(got[76].z(), -0.4);
  EXPECT_GT(got[76].z(), -1);
}

// The physics reads no files and draws nothing, so its library needs no packages for that.
TEST_F(InstalledLibrary, OfThePhysicsNeedsNoFilesAndNoPictures) {
  const std::string needed = needed_by(WEFT_PHYSICS_LIBRARY);
  EXPECT_NE(needed.find("libtbb"), std::string::npos) << needed;
  for (const char* name : {"toml", "pugixml", "assimp", "zstd", "xxhash", "libav", "libsw", "libpng", "OpenEXR",
                           "Imath", "OSMesa", "freetype", "EGL", "embree"})
    EXPECT_EQ(needed.find(name), std::string::npos) << name << "\n" << needed;
}

TEST_F(InstalledLibrary, NeedsNothingForPicturesOrVideos) {
  const std::string needed = needed_by(WEFT_LIBRARY);
  EXPECT_NE(needed.find("libtbb"), std::string::npos) << needed;
  for (const char* name : {"libav", "libsw", "libpng", "OpenEXR", "Imath", "OSMesa", "freetype", "EGL"})
    EXPECT_EQ(needed.find(name), std::string::npos) << name << "\n" << needed;
}

TEST_F(InstalledLibrary, ComesWithManualPageCompletionsSchemaAndScenes) {
  install();
  for (const char* file : {"bin/weft", "bin/weft-tools", "include/weft/simulation.hpp", "share/man/man1/weft.1",
                           "share/bash-completion/completions/weft", "share/weft/scene.schema.json",
                           "share/weft/scenes/falling_band.toml", "share/doc/weft/LICENSE"})
    EXPECT_GT(fs::file_size(folder_ / "prefix" / file), 0u) << file;
  const std::string bits = run("grep -c . prefix/share/zsh/vendor-completions/_weft");
  EXPECT_GT(std::stoi(bits), 10);
}

}  // namespace
}  // namespace weft::library
