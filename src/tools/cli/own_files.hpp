// Recognises files that Weft has written, mostly by metadata. Other files are never removed or replaced silently.
#pragma once

#include <filesystem>
#include <string>

namespace weft::cli {

/// Whether the metadata of a picture names this scene and frame.
bool is_picture_of(const std::filesystem::path& file, const std::string& scene, int frame);

/// Whether a PLY or OBJ file names Weft as its author.
bool is_own_mesh(const std::filesystem::path& file);

/// Whether a file is an output of a run of this scene: a picture, video, mesh, report or log. Empty files, which a
/// killed run leaves, count too, and so do meshes of other scenes, as meshes do not name theirs. Effective scenes have
/// no mark by which Weft recognises them: see Store::holds_scene().
bool is_output_of(const std::filesystem::path& file, const std::string& scene);

}  // namespace weft::cli
