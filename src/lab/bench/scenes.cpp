// The scenes that are measured if the user names none: files of scenes/, which the program contains.
#include <algorithm>

#include "embedded_scenes.hpp"
#include "lab/bench/accuracy.hpp"
#include "lab/bench/speed.hpp"

namespace weft::bench {
namespace {

constexpr const char* embedded_scene(std::string_view name) {
  return std::ranges::find(kEmbeddedScenes, name, &EmbeddedFile::name)->text.data();
}

}  // namespace

constinit const char* const kSphereDrape = embedded_scene("sphere_drape.toml");
constinit const char* const kSwingingSheet = embedded_scene("swinging_sheet.toml");

}  // namespace weft::bench
