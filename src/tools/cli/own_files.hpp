// Recognises files that Weft has written, mostly by metadata. Other files are never removed or replaced silently.
#pragma once

#include <filesystem>
#include <string>

namespace weft::cli {

/// Whether the metadata of a picture names this scene and frame.
bool is_picture_of(const std::filesystem::path& file, const std::string& scene, int frame);

/// Whether a PLY or OBJ file names Weft as its author.
bool is_own_mesh(const std::filesystem::path& file);

/// Whether a file is an output of a run of this scene, of any kind that `weft run` writes. Empty files, which a killed
/// run leaves, and .toml files count too.
bool is_output_of(const std::filesystem::path& file, const std::string& scene);

}  // namespace weft::cli
