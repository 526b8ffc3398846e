// Animated glTF 2.0 in one binary file (Khronos Group, "glTF 2.0 Specification", 2021).
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "export/materials.hpp"
#include "export/normals.hpp"
#include "export/seams.hpp"
#include "export/view.hpp"
#include "frame/frame_snapshot.hpp"

namespace weft::exporter {

/// Every object is a mesh whose vertices are those of the first frame, with one morph target for each later frame. At
/// the time of frame k the weight of its target is 1 and all others are 0, and between frames they go over linearly:
/// positions do then too. That is the one way of moving vertices at will that the standard has, and readers know it
/// (assimp, Blender, three.js). Objects that never move have no targets.
///
/// y is up in glTF: where z is up in the scene, (x, y, z) becomes (x, z, -y), which Blender turns back. Normals have
/// targets as positions have: those of the first frame would be wrong in all others. Texture coordinates are weft and
/// warp [m]; where panels meet at a seam each has vertices of its own. A second pair lays pictures, which are inside of
/// the file; parts that look otherwise are primitives of their own over the same vertices.
class GltfFile {
 public:
  /// Of the visible objects of the first frame.
  explicit GltfFile(const frame::FrameSnapshot& first);

  /// The next frame, at `time` [s] from the first.
  void add(const frame::FrameSnapshot& snapshot, double time);

  /// Cameras of the next frame, the first too. The standard's cameras keep their angle: that of the first frame.
  void see(const std::vector<View>& views);

  /// `aspect`: width over height of the pictures. Throws Error(output_failed), also where it would be more than the
  /// format can hold.
  void write(const std::filesystem::path& file, const std::string& animation_name, double aspect);

 private:
  struct Target {
    int positions = -1, normals = -1;  // accessors; −1 where all is as in the first frame
  };
  struct Object {
    std::size_t surface = 0;
    NormalGroups groups = {};
    std::vector<float> start = {};  // as written
    std::vector<float> start_normals = {};
    std::vector<Index> vertex_of = {};  // of the surface, for each that is written
    std::vector<Index> group_of = {};   // of normals, likewise; −1: of none
    std::vector<Target> targets = {};   // one per later frame
  };
  struct Eye {
    std::string name = {};
    double field_of_view = 35;                      // vertical [degrees]
    std::vector<float> positions = {}, turns = {};  // of each frame: x, y, z; and w after them
  };
  int append(const void* data, std::size_t size, int target);
  int add_vectors(const std::vector<float>& vectors);
  int add_values(const std::vector<float>& values, const char* type, bool with_bounds = false);
  int add_places(const std::vector<Vec2>& places);
  nlohmann::json texture(const Materials& materials, const Material& material, std::vector<int>& images);
  nlohmann::json primitives(const CutSurface& cut, const Object& object, const frame::Surface& surface,
                            const Materials& materials);
  void add_targets(Object& object, nlohmann::json& mesh);
  nlohmann::json animation(const std::vector<int>& nodes);
  void add_cameras(nlohmann::json& animation, double aspect);
  std::vector<float> normals(const Object& object, const frame::FrameSnapshot& snapshot) const;
  std::vector<float> turned(const std::vector<Vec3>& positions, const std::vector<Index>& vertices) const;

  bool z_up_;
  std::vector<Object> objects_;
  std::vector<Eye> eyes_;
  std::vector<float> times_{0};
  std::vector<int> frames_;
  nlohmann::json document_;
  std::string bytes_;
};

}  // namespace weft::exporter
