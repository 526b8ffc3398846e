// Universal Scene Description as text (Pixar, "Universal Scene Description", file format usda 1.0).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "export/materials.hpp"
#include "export/normals.hpp"
#include "export/view.hpp"
#include "frame/frame_snapshot.hpp"

namespace weft::exporter {

/// One stage with all visible objects as meshes, whose points [m] and normals have a sample at each frame, and cameras.
/// Time codes are frames of the scene; the stage says how many are in a second, and which axis is up, as in the scene.
/// What never changes has a value and no samples. Primitives of a mesh are the triangles that are drawn.
class UsdFile {
 public:
  /// Of the visible objects of the first frame. `aspect`: width over height of the pictures.
  UsdFile(const frame::FrameSnapshot& first, const std::string& name, double fps, double aspect);

  /// The next frame, the first too.
  void add(const frame::FrameSnapshot& snapshot, const std::vector<View>& views);

  /// As .usda with its pictures beside it, or packed with them as .usdz, by the ending of the name. Throws
  /// Error(output_failed).
  void write(const std::filesystem::path& file) const;

 private:
  /// Values of an attribute over time.
  class Samples {
   public:
    /// Returns whether the value is another one than in the frame before.
    bool add(int frame, std::string value);
    /// As it stands in a file, after `name`, such as `point3f[] points`; `metadata` may be empty.
    void write(std::ostream& out, std::string_view name, std::string_view metadata = "") const;

   private:
    std::string first_, last_, text_;  // text: empty while nothing has changed
    int first_frame_ = 0, last_frame_ = 0;
  };
  struct Object {
    std::size_t surface = 0;
    std::string prim = {};  // its name in the file
    NormalGroups groups = {};
    bool smooth = false;  // a normal for each vertex, else for each corner
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
  std::vector<std::string> prims_;  // taken
  std::vector<Object> objects_;
  std::vector<Camera> cameras_;
};

}  // namespace weft::exporter
