// Loading of scenes with the options of the command line.
#include "tools/cli/scene_input.hpp"

#include <gtest/gtest.h>

#include "film/scene/scene.hpp"

namespace weft::cli {
namespace {

// The field of view of a lens depends on the sides of the picture, so the scene must have the size that --size sets.
TEST(SceneInput, HasTheSizeOfTheCommandLine) {
  SceneOptions options;
  options.scene = WEFT_SOURCE_DIR "/scenes/falling_band.toml";
  const scene::Scene as_given = load_scene(options);
  options.size = PictureSize{180, 320};
  const scene::Scene upright = load_scene(options);
  EXPECT_EQ(upright.render.width, 180);
  EXPECT_EQ(upright.render.height, 320);
  EXPECT_EQ(upright.hash, as_given.hash) << "pictures and caches of any size are of the same scene";
}

}  // namespace
}  // namespace weft::cli
