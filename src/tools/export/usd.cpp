#include "tools/export/usd.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <ostream>
#include <sstream>

#include "core/error.hpp"
#include "core/temporary_file.hpp"
#include "core/version.hpp"
#include "tools/export/seams.hpp"
#include "tools/export/zip.hpp"

namespace weft::exporter {
namespace {

// Film width of a 35 mm camera: 36 mm. USD states it in tenths of the stage's unit, which is 1 m here, so the value is
// 0.36. Only the ratio of film width to focal length matters.
constexpr double kFilmWidth = 0.36;

// A valid name of a primitive: letters, digits and underscores, no leading digit.
std::string prim_name(const std::string& name) {
  std::string prim;
  for (const char c : name) prim += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  if (prim.empty() || std::isdigit(static_cast<unsigned char>(prim[0])) != 0) prim.insert(0, 1, '_');
  return prim;
}

// Vectors as text, in single precision and in the shortest form that reads back exactly.
template <class Vectors>
std::string tuples(const Vectors& vectors) {
  std::string text = "[";
  const auto out = std::back_inserter(text);
  for (const auto& v : vectors) {
    const char* before = text.size() > 1 ? ", (" : "(";
    for (int axis = 0; axis < v.size(); ++axis)
      fmt::format_to(out, "{}{}", axis == 0 ? before : ", ", static_cast<float>(v[axis]));
    text += ')';
  }
  return text += ']';
}

// Unit vectors as text, exact to a thousandth of a degree.
std::string directions(const std::vector<Vec3>& vectors) {
  std::string text = "[";
  for (const Vec3& v : vectors)
    fmt::format_to(std::back_inserter(text), "{}({:.5f}, {:.5f}, {:.5f})", text.size() > 1 ? ", " : "", v.x(), v.y(),
                   v.z());
  return text += ']';
}

std::string indices(const std::vector<std::array<Index, 3>>& triangles) {
  std::string text = "[";
  for (const auto& t : triangles)
    fmt::format_to(std::back_inserter(text), "{}{}, {}, {}", text.size() > 1 ? ", " : "", t[0], t[1], t[2]);
  return text += ']';
}

std::string box_of(const std::vector<Vec3>& positions) {
  Box3 box;
  for (const Vec3& x : positions) box.extend(x);
  if (box.isEmpty()) box = Box3(Vec3(0, 0, 0), Vec3(0, 0, 0));
  return tuples(std::array{Vec3(box.min()), Vec3(box.max())});
}

// USD multiplies row vectors by the matrix: its rows are the images of the axes, and the position.
std::string matrix_text(const Eigen::Matrix4d& matrix) {
  std::string text = "( ";
  for (int column = 0; column < 4; ++column)
    fmt::format_to(std::back_inserter(text), "{}({}, {}, {}, {})", column == 0 ? "" : ", ", matrix(0, column),
                   matrix(1, column), matrix(2, column), matrix(3, column));
  return text += " )";
}

const char* wrap_name(frame::Paint::Wrap wrap) {
  constexpr const char* kNames[] = {"repeat", "clamp", "mirror"};  // no Material has Wrap::once
  return kNames[static_cast<std::size_t>(wrap)];
}

void write_picture(std::ostream& out, const Material& material, const std::string& file, const std::string& path) {
  fmt::print(out,
             "\n            def Shader \"picture\"\n            {{\n"
             "                uniform token info:id = \"UsdUVTexture\"\n"
             "                asset inputs:file = @{0}@\n"
             "                token inputs:sourceColorSpace = \"sRGB\"\n"
             "                float2 inputs:st.connect = <{1}/places.outputs:result>\n"
             "                token inputs:wrapS = \"{2}\"\n                token inputs:wrapT = \"{3}\"\n"
             "                float outputs:a\n                float3 outputs:rgb\n            }}\n"
             "\n            def Shader \"places\"\n            {{\n"
             "                uniform token info:id = \"UsdPrimvarReader_float2\"\n"
             "                string inputs:varname = \"st\"\n"
             "                float2 outputs:result\n            }}\n",
             file, path, wrap_name(material.wrap_u), wrap_name(material.wrap_v));
}

void write_material(std::ostream& out, const std::string& prim, const std::string& path, const Material& material,
                    const Materials& materials) {
  const Vec3& color = material.color;
  const std::string diffuse = material.has_picture()
                                  ? fmt::format(".connect = <{}/picture.outputs:rgb>", path)
                                  : fmt::format(" = ({:.6g}, {:.6g}, {:.6g})", color.x(), color.y(), color.z());
  fmt::print(out,
             "        def Material \"{0}\"\n        {{\n"
             "            token outputs:surface.connect = <{1}/surface.outputs:surface>\n\n"
             "            def Shader \"surface\"\n            {{\n"
             "                uniform token info:id = \"UsdPreviewSurface\"\n"
             "                color3f inputs:diffuseColor{2}\n"
             "                float inputs:metallic = {3}\n",
             prim, path, diffuse, material.metal);
  if (material.cutout)
    fmt::print(out,
               "                float inputs:opacity.connect = <{}/picture.outputs:a>\n"
               "                float inputs:opacityThreshold = 0.5\n",
               path);
  fmt::print(out,
             "                float inputs:roughness = {}\n"
             "                token outputs:surface\n            }}\n",
             material.roughness);
  if (material.has_picture()) write_picture(out, material, materials.pictures[material.picture].name, path);
  out << "        }\n";
}

}  // namespace

bool UsdFile::Samples::add(int frame, std::string value) {
  if (first_.empty()) {
    first_ = last_ = std::move(value);
    first_frame_ = last_frame_ = frame;
    return true;
  }
  const bool changed = value != last_;
  if (changed && text_.empty()) {
    text_ = fmt::format("            {}: {},\n", first_frame_, first_);
    // The value was constant until the previous frame. Readers interpolate samples linearly, so the
    // previous frame needs a sample too.
    if (last_frame_ != first_frame_) text_ += fmt::format("            {}: {},\n", last_frame_, first_);
  }
  if (!text_.empty()) text_ += fmt::format("            {}: {},\n", frame, value);
  last_ = std::move(value);
  last_frame_ = frame;
  return changed;
}

void UsdFile::Samples::write(std::ostream& out, std::string_view name, std::string_view metadata) const {
  // The value beside the samples is the default for readers that ignore time.
  fmt::print(out, "        {} = {}{}\n", name, first_, metadata);
  if (!text_.empty()) fmt::print(out, "        {}.timeSamples = {{\n{}        }}\n", name, text_);
}

UsdFile::UsdFile(const frame::FrameSnapshot& first, const std::string& name, double fps, double aspect)
    : root_(prim_name(name)),
      fps_(fps),
      aspect_(aspect),
      z_up_(first.stage->up.z() > 0.5),
      first_frame_(first.frame),
      last_frame_(first.frame),
      surfaces_(first.surfaces),
      prims_{"materials"} {
  for (std::size_t s = 0; s < first.surfaces.size(); ++s) {
    if (!surfaces_[s]->visible) continue;
    Object object{.surface = s, .prim = unique_prim(surfaces_[s]->name)};
    object.vertices = first.states[s].positions.size();
    object.materials = materials_of(*surfaces_[s]);
    object.groups = group_normals(*surfaces_[s], first.states[s].positions);
    object.smooth = object.groups.of_corner == surfaces_[s]->triangles;
    objects_.push_back(std::move(object));
  }
  // The materials of objects and of parts are in one scope, so their names must differ. Parts get
  // their names last, so that the names of objects stay unchanged.
  for (Object& object : objects_) {
    const std::vector<frame::SurfacePart>& parts = surfaces_[object.surface]->parts;
    for (std::size_t p = 0; p < parts.size(); ++p)
      object.parts.push_back(unique_prim(fmt::format("{}_{}_{}", object.prim, p, prim_name(parts[p].name))));
  }
}

std::string UsdFile::unique_prim(const std::string& name) {
  const std::string wanted = prim_name(name);
  std::string prim = wanted;
  for (int i = 2; std::ranges::find(prims_, prim) != prims_.end(); ++i) prim = fmt::format("{}_{}", wanted, i);
  prims_.push_back(prim);
  return prim;
}

void UsdFile::add(const frame::FrameSnapshot& snapshot, const std::vector<View>& views) {
  last_frame_ = snapshot.frame;
  for (Object& object : objects_) {
    const frame::Surface& surface = *snapshot.surfaces[object.surface];
    const std::vector<Vec3>& positions = snapshot.states[object.surface].positions;
    object.points.add(snapshot.frame, tuples(positions));
    object.extent.add(snapshot.frame, box_of(positions));
    std::vector<Vec3> normals = normals_of(object.groups, surface, positions);
    if (!object.smooth) {
      std::vector<Vec3> of_corners;
      for (const auto& triangle : object.groups.of_corner)
        for (const Index group : triangle) of_corners.push_back(normals[static_cast<std::size_t>(group)]);
      normals = std::move(of_corners);
    }
    object.normals.add(snapshot.frame, directions(normals));
  }
  for (std::size_t c = 0; c < views.size(); ++c) {
    if (c == cameras_.size()) cameras_.push_back({.prim = unique_prim(views[c].name)});
    const double half = views[c].field_of_view * std::numbers::pi / 360;
    cameras_[c].transform.add(snapshot.frame, matrix_text(views[c].world_from_view));
    cameras_[c].focal_length.add(snapshot.frame, fmt::format("{:.9g}", kFilmWidth / aspect_ / 2 / std::tan(half)));
  }
}

void UsdFile::write_materials(std::ostream& out) const {
  out << "    def Scope \"materials\"\n    {\n";
  for (const Object& object : objects_) {
    const auto write = [&](const std::string& prim, const Material& material) {
      write_material(out, prim, fmt::format("/{}/materials/{}", root_, prim), material, object.materials);
    };
    write(object.prim, object.materials.all[0]);
    for (std::size_t p = 0; p < object.parts.size(); ++p) write(object.parts[p], object.materials.all[p + 1]);
  }
  out << "    }\n";
}

// Writes the texture coordinates that map the pictures as `st`. If `st` differs from weft and warp,
// also writes weft and warp as `weft_warp`.
void UsdFile::write_places(std::ostream& out, const frame::Surface& surface, const Object& object) {
  const CutSurface cut = cut_at_seams(surface, object.materials, object.vertices);
  if (cut.uv.empty()) return;
  const bool by_corner = cut.is_cut(object.vertices);
  const auto write = [&](const char* name, const std::vector<Vec2>& places) {
    fmt::print(out, "        texCoord2f[] primvars:{} = {} (\n            interpolation = \"{}\"\n        )\n", name,
               tuples(places), by_corner ? "faceVarying" : "vertex");
    if (by_corner) fmt::print(out, "        int[] primvars:{}:indices = {}\n", name, indices(cut.triangles));
  };
  write("st", cut.picture_uv.empty() ? cut.uv : cut.picture_uv);
  if (!cut.picture_uv.empty()) write("weft_warp", cut.uv);
}

void UsdFile::write_mesh(std::ostream& out, const Object& object) const {
  const frame::Surface& surface = *surfaces_[object.surface];
  fmt::print(out, "\n    def Mesh \"{}\" (\n        prepend apiSchemas = [\"MaterialBindingAPI\"]\n    )\n    {{\n",
             object.prim);
  std::string counts;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) counts += t == 0 ? "3" : ", 3";
  fmt::print(out,
             "        uniform bool doubleSided = {}\n        uniform token subdivisionScheme = \"none\"\n"
             "        int[] faceVertexCounts = [{}]\n        int[] faceVertexIndices = {}\n",
             surface.kind == frame::ObjectKind::cloth ? 1 : 0, counts, indices(surface.triangles));
  fmt::print(out, "        rel material:binding = </{}/materials/{}>\n", root_, object.prim);
  object.extent.write(out, "float3[] extent");
  object.points.write(out, "point3f[] points");
  object.normals.write(out, "normal3f[] normals",
                       object.smooth ? " (\n            interpolation = \"vertex\"\n        )"
                                     : " (\n            interpolation = \"faceVarying\"\n        )");
  write_places(out, surface, object);
  for (std::size_t p = 0; p < object.parts.size(); ++p) {
    std::string faces;
    for (std::size_t t = 0; t < surface.part_of_triangle.size(); ++t)
      if (surface.part_of_triangle[t] == static_cast<std::int32_t>(p))
        fmt::format_to(std::back_inserter(faces), "{}{}", faces.empty() ? "" : ", ", t);
    fmt::print(
        out,
        "\n        def GeomSubset \"{0}\" (\n            prepend apiSchemas = [\"MaterialBindingAPI\"]\n        )\n"
        "        {{\n            uniform token elementType = \"face\"\n"
        "            uniform token familyName = \"materialBind\"\n            int[] indices = [{1}]\n"
        "            rel material:binding = </{2}/materials/{0}>\n        }}\n",
        object.parts[p], faces, root_);
  }
  out << "    }\n";
}

void UsdFile::write_camera(std::ostream& out, const Camera& camera) const {
  fmt::print(out,
             "\n    def Camera \"{}\"\n    {{\n        float2 clippingRange = ({}, {})\n"
             "        float horizontalAperture = {}\n        float verticalAperture = {:.9g}\n"
             "        token projection = \"perspective\"\n",
             camera.prim, kNearPlane, kFarPlane, kFilmWidth, kFilmWidth / aspect_);
  camera.focal_length.write(out, "float focalLength");
  camera.transform.write(out, "matrix4d xformOp:transform");
  out << "        uniform token[] xformOpOrder = [\"xformOp:transform\"]\n    }\n";
}

void UsdFile::write_all(std::ostream& out) const {
  fmt::print(out,
             "#usda 1.0\n(\n    defaultPrim = \"{0}\"\n    doc = \"Weft {1}\"\n    startTimeCode = {2}\n"
             "    endTimeCode = {3}\n    framesPerSecond = {4}\n    timeCodesPerSecond = {4}\n"
             "    metersPerUnit = 1\n    upAxis = \"{5}\"\n)\n\n"
             "def Xform \"{0}\" (\n    kind = \"component\"\n)\n{{\n",
             root_, kVersion, first_frame_, last_frame_, fps_, z_up_ ? 'Z' : 'Y');
  write_materials(out);
  for (const Object& object : objects_) write_mesh(out, object);
  for (const Camera& camera : cameras_) write_camera(out, camera);
  out << "}\n";
}

void UsdFile::write(const std::filesystem::path& file) const {
  if (file.extension() == ".usdz") {
    std::ostringstream out;
    write_all(out);
    std::vector<StoredFile> files{{file.stem().string() + ".usda", out.str()}};
    for (const Object& object : objects_)
      for (const PictureFile& picture : object.materials.pictures) files.push_back({picture.name, picture.png()});
    return write_stored(file, files);
  }
  TemporaryFile temporary(file);
  std::ofstream out(temporary.path(), std::ios::binary);
  write_all(out);
  out.close();
  if (!out) throw Error(ExitCode::output_failed, "{}: cannot be written to its end", file.string());
  temporary.commit(Flush::no);
}

}  // namespace weft::exporter
