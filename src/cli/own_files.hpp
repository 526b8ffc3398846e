// What Weft has written says so itself: files that do not are somebody else's, and are never removed or replaced
// without a word.
#pragma once

#include <filesystem>
#include <string>

namespace weft::cli {

/// Whether a picture says that it shows this frame of this scene.
bool is_picture_of(const std::filesystem::path& file, const std::string& scene, int frame);

/// Whether a PLY or OBJ file says that Weft has written it.
bool is_own_mesh(const std::filesystem::path& file);

/// Whether a file says that it is an output of a run of this scene, of any kind that `weft run` writes. Empty files are
/// those of a killed run, or hold nothing that could be lost.
bool is_output_of(const std::filesystem::path& file, const std::string& scene);

}  // namespace weft::cli
