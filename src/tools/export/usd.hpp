// Universal Scene Description as text (Pixar, "Universal Scene Description", file format usda 1.0).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "film/frame/frame_snapshot.hpp"
#include "tools/export/materials.hpp"
#include "tools/export/normals.hpp"
#include "tools/export/view.hpp"

namespace weft::exporter {

/// A stage with cameras and all visible objects as meshes, whose points [m] and normals are sampled at each frame. Time
/// codes are frames of the scene; the frame rate and the up axis are those of the scene. An attribute that never
/// changes has a value and no samples. The faces are the drawn triangles.
class UsdFile {
 public:
  /// Adds the visible objects of the first frame. `aspect`: width over height of the pictures.
  UsdFile(const frame::FrameSnapshot& first, const std::string& name, double fps, double aspect);

  /// Adds the next frame, starting with the first.
  void add(const frame::FrameSnapshot& snapshot, const std::vector<View>& views);

  /// Writes .usda, which names pictures beside it (shared_files()), or .usdz with its pictures inside, depending on the
  /// extension. Throws Error(output_failed).
  void write(const std::filesystem::path& file) const;

 private:
  /// Values of an attribute over time.
  class Samples {
   public:
    /// Adds the value of a frame. Returns whether the value differs from that of the previous frame; true for the first
    /// frame.
    bool add(int frame, std::string value);
    /// Writes the attribute; `name` includes its type, such as `point3f[] points`; `metadata` may be empty.
    void write(std::ostream& out, std::string_view name, std::string_view metadata = "") const;

   private:
    std::string first_, last_, text_;  // text_ is empty until the value changes
    int first_frame_ = 0, last_frame_ = 0;
  };
  struct Object {
    std::size_t surface = 0;
    std::string prim = {};                // name of the object in the file, and of its material
    std::vector<std::string> parts = {};  // names of the materials of its parts, unique in the file
    NormalGroups groups = {};
    bool smooth = false;  // one normal per vertex, else one per corner
    std::size_t vertices = 0;
    Materials materials = {};
    Samples points = {}, normals = {}, extent = {};
  };
  struct Camera {
    std::string prim = {};
    Samples transform = {}, focal_length = {};
  };
  std::string unique_prim(const std::string& name);
  void write_all(std::ostream& out) const;
  void write_materials(std::ostream& out) const;
  void write_mesh(std::ostream& out, const Object& object) const;
  static void write_places(std::ostream& out, const frame::Surface& surface, const Object& object);
  void write_camera(std::ostream& out, const Camera& camera) const;

  std::string root_;
  double fps_, aspect_;
  bool z_up_;
  int first_frame_, last_frame_;
  std::vector<std::shared_ptr<const frame::Surface>> surfaces_;
  std::vector<std::string> prims_;  // names in use
  std::vector<Object> objects_;
  std::vector<Camera> cameras_;
};

}  // namespace weft::exporter
