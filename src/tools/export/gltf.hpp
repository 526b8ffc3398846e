// Animated glTF 2.0 as one binary file (Khronos Group, "glTF 2.0 Specification", 2021).
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "film/frame/frame_snapshot.hpp"
#include "tools/export/materials.hpp"
#include "tools/export/normals.hpp"
#include "tools/export/seams.hpp"
#include "tools/export/view.hpp"

namespace weft::exporter {

/// Each object is a mesh with the vertices of the first frame, and one morph target per later
/// frame. At the time of a later frame, the weight of its target is 1, and all other weights are 0;
/// between frames, weights and thus positions are interpolated linearly. Morph targets are the only
/// way of the standard to move vertices independently; assimp, Blender and three.js read them.
/// Objects that never move have no targets. Normals have targets as well, since the normals of the
/// first frame would be wrong in later frames.
///
/// glTF has y up: if z is up in the scene, (x, y, z) becomes (x, z, -y); Blender reverses this. v
/// points down in glTF, so texture coordinates are (weft, 1 − warp) [m]. If the pictures
/// of an object need other texture coordinates, the object also has these, as a second set. A vertex on a seam occurs
/// once for each panel; a vertex on a crease, once for each normal. Pictures are embedded. A mesh has one primitive per
/// material; all primitives share its vertices.
class GltfFile {
 public:
  /// Adds the visible objects of the first frame.
  explicit GltfFile(const frame::FrameSnapshot& first);

  /// Adds the next frame, at `time` [s] after the first.
  void add(const frame::FrameSnapshot& snapshot, double time);

  /// Adds the cameras of a frame: of the first frame in the first call, then of each next frame. glTF cameras cannot
  /// change their field of view, so each camera keeps the field of view of its first frame.
  void add_views(const std::vector<View>& views);

  /// `aspect`: width over height of rendered pictures. Throws Error(output_failed), also if the file would exceed 4
  /// GiB, the limit of the format.
  void write(const std::filesystem::path& file, const std::string& animation_name, double aspect);

 private:
  struct Target {
    int positions = -1, normals = -1;  // indices of accessors; −1 if the frame equals the first
  };
  struct Object {
    std::size_t surface = 0;
    NormalGroups groups = {};
    std::vector<float> start = {};  // positions of the first frame, y up
    std::vector<float> start_normals = {};
    std::vector<Index> vertex_of = {};  // index in the surface, per written vertex
    std::vector<Index> group_of = {};   // index of the normal group, per written vertex; −1: none
    std::vector<Target> targets = {};   // one per later frame
  };
  struct CameraTrack {
    std::string name = {};
    double field_of_view = 35;                      // vertical [degrees]
    std::vector<float> positions = {}, turns = {};  // per frame: x, y, z; and quaternion x, y, z, w
  };
  int append(const void* data, std::size_t size, int target);
  int add_vectors(const std::vector<float>& vectors);
  int add_numbers(const void* numbers, std::size_t count, int component_type, const char* type, int target);
  int add_times();
  int add_places(const std::vector<Vec2>& places);
  nlohmann::json texture(const Materials& materials, const Material& material, std::vector<int>& images);
  nlohmann::json primitives(const CutSurface& cut, const Object& object, const frame::Surface& surface,
                            const Materials& materials);
  void add_targets(Object& object, nlohmann::json& mesh);
  nlohmann::json animation(const std::vector<int>& nodes);
  void add_cameras(nlohmann::json& animation, double aspect);
  std::vector<float> normals(const Object& object, const frame::FrameSnapshot& snapshot) const;
  std::vector<float> to_y_up(const std::vector<Vec3>& positions, const std::vector<Index>& vertices) const;

  bool z_up_;
  std::vector<Object> objects_;
  std::vector<CameraTrack> camera_tracks_;
  std::vector<float> times_{0};
  std::vector<int> frames_;
  nlohmann::json document_;
  std::string bytes_;
};

}  // namespace weft::exporter
