// Frames as files for other programs.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "export/view.hpp"
#include "frame/frame_snapshot.hpp"

namespace weft::exporter {

enum class Format {
  ply,      ///< a file for each object and frame: triangles, positions as double, weft and warp; cut where panels meet
  obj,      ///< likewise: faces as simulated, with weft and warp, normals, materials (MTL) and pictures
  pc2,      ///< a point cache for each object, and the object in the first frame as OBJ, which it applies to; y is up
  gltf,     ///< one file with all visible objects, their colours, pictures and motion, and cameras
  usd,      ///< likewise, as text; in the axes of the scene
  usdz,     ///< the same, packed
  blender,  ///< pc2, and a script that loads all of it with cameras and lights
};

struct Request {
  Format format = Format::gltf;
  std::filesystem::path folder;
  std::string name;                ///< of the scene, which names the file of all objects
  double fps = 25;                 ///< of the scene
  std::vector<int> frames;         ///< ascending, at least one, all as far apart
  int width = 1280, height = 720;  ///< of its pictures
  /// Of a frame, the first that which pictures show; of gltf, usd, usdz and blender, and asked once for each frame, in
  /// order.
  std::function<std::vector<View>(const frame::FrameSnapshot&)> views = nullptr;
  Lighting lighting = {};  ///< of blender
};

/// All files that will be written but for shared_files(); `first` is the first frame asked for.
std::vector<std::filesystem::path> files(const Request& request, const frame::FrameSnapshot& first);

/// Materials and pictures beside them, which are the same for all parts of a film.
struct SharedFile {
  std::filesystem::path file;
  std::string content;
};
std::vector<SharedFile> shared_files(const Request& request, const frame::FrameSnapshot& first);

/// Reads each frame once, in order, and asks `stop` before each; returns whether all were written. Each file appears
/// under its name when it is whole. Throws Error(output_failed), and what `read` throws.
bool write(
    const Request& request, const std::function<frame::SnapshotPtr(int)>& read,
    const std::function<bool()>& stop = [] { return false; });

}  // namespace weft::exporter
