// Export of frames to files for other programs.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "film/frame/frame_snapshot.hpp"
#include "tools/export/view.hpp"

namespace weft::exporter {

enum class Format {
  ply,      ///< per object and frame: triangles, positions (doubles), weft and warp; two panels share no vertices
  obj,      ///< per object and frame: quads or triangles, weft and warp, normals, materials (MTL), pictures
  pc2,      ///< per object: the OBJ of the first frame, and a point cache that moves its vertices; y is up
  gltf,     ///< one file: all visible objects with colours, pictures and motion, and the cameras
  usd,      ///< as gltf, but as text with the axes of the scene; pictures are files beside it
  usdz,     ///< as usd, but packed in one file
  blender,  ///< the files of pc2, and a script that loads them with cameras and lights
};

struct Request {
  Format format = Format::gltf;
  std::filesystem::path folder;
  std::string name;                ///< of the scene; base name of files that contain all objects
  double fps = 25;                 ///< of the scene
  std::vector<int> frames;         ///< ascending, equally spaced, at least one
  int width = 1280, height = 720;  ///< of the pictures [pixels]; defines the aspect ratio of the cameras
  /// Returns the cameras of a frame; the first is the camera of the pictures. Used by gltf, usd, usdz and blender;
  /// called once per frame, in order. Null: no cameras.
  std::function<std::vector<View>(const frame::FrameSnapshot&)> views = nullptr;
  Lighting lighting = {};  ///< for blender: the lighting of the first frame, used for all frames
};

/// All files that write() will write, except shared_files(). `first`: snapshot of the first
/// requested frame.
std::vector<std::filesystem::path> files(const Request& request, const frame::FrameSnapshot& first);

/// A material file or a picture. All frames of a film have the same material files and pictures, so
/// an earlier export of other frames may have written this file already.
struct SharedFile {
  std::filesystem::path file;
  std::string content;
};
/// The material files and pictures that write() will write beside the other files.
std::vector<SharedFile> shared_files(const Request& request, const frame::FrameSnapshot& first);

/// Reads each frame once, in order, and writes it. Calls `stop` before each frame, and ends early if `stop` returns
/// true. Returns whether all frames were written. Each file gets its final name only when it is complete. Throws
/// Error(output_failed), and what `read` throws.
bool write(
    const Request& request, const std::function<frame::SnapshotPtr(int)>& read,
    const std::function<bool()>& stop = [] { return false; });

}  // namespace weft::exporter
