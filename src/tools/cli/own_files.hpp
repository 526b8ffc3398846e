// Recognises files that Weft has written, by their metadata or their first bytes. Weft never replaces or removes other
// files unasked.
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace weft::cli {

/// Metadata of a picture or video; empty if it has none or cannot be read.
std::map<std::string, std::string> metadata_of(const std::filesystem::path& file);

/// Hash of the scene that the metadata of a picture or video name; empty if there is none.
std::string scene_hash_of(const std::filesystem::path& file);

/// Whether the metadata of a picture names this scene and frame.
bool is_picture_of(const std::filesystem::path& file, const std::string& scene, int frame);

/// Whether a PLY or OBJ file names Weft as its author.
bool is_own_mesh(const std::filesystem::path& file);

/// Whether a file is an output of a run of this scene: a picture, video, mesh, report or log. Empty files count, since
/// a killed run may leave them. Meshes of other scenes count, since a mesh file does not name its scene. Effective
/// scenes do not count: they have no mark; see Store::holds_scene().
bool is_output_of(const std::filesystem::path& file, const std::string& scene);

/// Call it when a video is complete. Removes the file with its frames that an earlier command has left because it could
/// not finish the video (video::partial_name()), if this file is a video of the scene and may_replace() is true for it.
void remove_kept_frames(const std::filesystem::path& video, const std::string& scene);

}  // namespace weft::cli
