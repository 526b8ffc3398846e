// OpenEXR files, read back by OpenImageIO.
#include "film/image/exr.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <sstream>

#include "support/test_folder.hpp"

namespace weft::image {
namespace {

using support::expect_error;
using support::read_bytes;

class ExrTest : public support::TestFolder {
 protected:
  void SetUp() override {
    TestFolder::SetUp();
    const int status = std::system("oiiotool --version >/dev/null 2>&1");
    if (WEXITSTATUS(status) == 127) GTEST_SKIP() << "oiiotool is not here: apt-get install openimageio-tools";
  }
  std::string run_oiiotool(const std::string& options) {
    const std::string out = (folder_ / "out").string();
    EXPECT_EQ(std::system(fmt::format("oiiotool {} >'{}' 2>&1", options, out).c_str()), 0);
    return read_bytes(out);
  }
};

// Four layers of different values, which numbers of 16 bits represent exactly.
Layers patterned_layers(int width, int height) {
  Layers layers{width, height, {}};
  for (const char* name : {"R", "A", "depth.Z", "normal.X"}) {
    Layers::Channel channel{name, {}, name[1] == '\0'};
    const float first = static_cast<float>(layers.channels.size());
    for (int i = 0; i < width * height; ++i) channel.values.push_back(first + static_cast<float>(i) / 64);
    layers.channels.push_back(std::move(channel));
  }
  layers.channels[2].values[1] = std::numeric_limits<float>::infinity();
  return layers;
}

TEST_F(ExrTest, EveryValueIsReadBackInItsPlace) {
  const Layers layers = patterned_layers(5, 3);
  const std::string file = (folder_ / "a.exr").string();
  write_exr(file, layers);
  std::istringstream lines(run_oiiotool("--dumpdata '" + file + "'"));
  int pixels = 0;
  for (std::string line; std::getline(lines, line);) {
    int x = 0, y = 0, at = 0;
    if (std::sscanf(line.c_str(), " Pixel (%d, %d):%n", &x, &y, &at) < 2 || at == 0) continue;
    const char* text = line.c_str() + at;
    for (const Layers::Channel& channel : layers.channels) {
      char* end = nullptr;
      EXPECT_EQ(std::strtof(text, &end), channel.values[static_cast<std::size_t>(5 * y + x)]) << channel.name << line;
      text = end;
    }
    ++pixels;
  }
  EXPECT_EQ(pixels, 15);
}

TEST_F(ExrTest, HeaderHasNamesDepthsAndMetadata) {
  const std::string file = (folder_ / "a.exr").string();
  write_exr(file, patterned_layers(2, 2), {{"object.2", "sheet"}});
  const std::string header = run_oiiotool("--info -v '" + file + "'");
  EXPECT_NE(header.find("R (half), A (half), depth.Z (float), normal.X (float)"), std::string::npos) << header;
  EXPECT_NE(header.find("object.2: \"sheet\""), std::string::npos) << header;
  EXPECT_NE(header.find("chromaticities: 0.64, 0.33, 0.3, 0.6, 0.15, 0.06"), std::string::npos) << header;
}

TEST_F(ExrTest, HeaderIsReadBackAndBrokenFilesAreRefused) {
  const std::filesystem::path file = folder_ / "a.exr";
  write_exr(file, patterned_layers(7, 3), {{"frame", "12"}});
  const ExrHeader header = read_exr_header(file);
  EXPECT_EQ(header.width, 7);
  EXPECT_EQ(header.height, 3);
  EXPECT_EQ(header.metadata, (Metadata{{"frame", "12"}}));
  support::write_bytes(folder_ / "b.exr", "no picture");
  expect_error(ExitCode::asset_unreadable, "b.exr", [&] { read_exr_header(folder_ / "b.exr"); });
  expect_error(ExitCode::asset_unreadable, "c.exr", [&] { read_exr_header(folder_ / "c.exr"); });
}

// Other programs may store the lines from bottom to top.
TEST_F(ExrTest, AFileThatIsCutOffIsRefusedWhateverTheOrderOfItsLines) {
  write_exr(folder_ / "a.exr", patterned_layers(8, 64));
  for (const std::string order : {"increasingY", "decreasingY"}) {
    const std::string file = (folder_ / (order + ".exr")).string();
    run_oiiotool(fmt::format("'{}' --attrib openexr:lineOrder {} -o '{}'", (folder_ / "a.exr").string(), order, file));
    EXPECT_EQ(read_exr_header(file).height, 64);
    const std::string whole = read_bytes(file);
    support::write_bytes(file, whole.substr(0, whole.size() - 40));
    expect_error(ExitCode::asset_unreadable, order, [&] { read_exr_header(file); });
  }
}

TEST_F(ExrTest, NothingIsLeftOfWhatCannotBeWritten) {
  Layers layers = patterned_layers(4, 4);
  layers.channels[1].values.pop_back();
  expect_error(ExitCode::output_failed, "a.exr: expected 4x4 values of A, got 15",
               [&] { write_exr(folder_ / "a.exr", layers); });
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

}  // namespace
}  // namespace weft::image
