#include "assets/small_files.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace weft::assets {
namespace {

constexpr std::array<std::array<float, 3>, 4> kCorners{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
constexpr std::array<std::array<std::uint16_t, 3>, 4> kFaces{{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};

template <class T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string base64(const std::string& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {  // the length must be a multiple of three
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | static_cast<std::uint8_t>(bytes[i + k]);
    for (const int shift : {18, 12, 6, 0}) text += kDigits[group >> shift & 63];
  }
  return text;
}

}  // namespace

std::string obj_cube() {
  return "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
         "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
         "vn 0 0 -1\nvn 0 0 1\nvn 0 -1 0\nvn 1 0 0\nvn 0 1 0\nvn -1 0 0\n"
         "f 1/1/1 4/2/1 3/3/1 2/4/1\nf 5/1/2 6/2/2 7/3/2 8/4/2\nf 1/1/3 2/2/3 6/3/3 5/4/3\n"
         "f 2/1/4 3/2/4 7/3/4 6/4/4\nf 3/1/5 4/2/5 8/3/5 7/4/5\nf 4/1/6 1/2/6 5/3/6 8/4/6\n";
}

std::string ply_tetrahedron() {
  return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
         "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
         "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
}

std::string stl_tetrahedron() {
  std::string bytes(80, ' ');
  append(bytes, static_cast<std::uint32_t>(kFaces.size()));
  for (const auto& face : kFaces) {
    bytes.append(12, '\0');  // the normal may be zero
    for (const auto corner : face) append(bytes, kCorners[corner]);
    bytes.append(2, '\0');
  }
  return bytes;
}

namespace {

std::string tetrahedron_buffer() {
  std::string buffer;
  for (const auto& corner : kCorners) append(buffer, corner);
  for (const auto& face : kFaces) append(buffer, face);
  return buffer;
}

/// glTF text of the tetrahedron. `uri`: JSON member that locates the buffer.
std::string tetrahedron_json(const std::string& uri) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"mesh":0,"scale":[1,1,-1],"translation":[0,0,2]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
"buffers":[{"byteLength":72)" +
         uri + R"(}],
"bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":24}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,1]},
{"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}]})";
}

}  // namespace

std::string gltf_tetrahedron() {
  return tetrahedron_json(R"(,"uri":"data:application/octet-stream;base64,)" + base64(tetrahedron_buffer()) + '"');
}

std::string glb_tetrahedron() {
  std::string json = tetrahedron_json("");
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::string buffer = tetrahedron_buffer();
  std::string bytes = "glTF";
  const auto number = [&](std::size_t value) { append(bytes, static_cast<std::uint32_t>(value)); };
  number(2);
  number(28 + json.size() + buffer.size());
  number(json.size());
  bytes += "JSON" + json;
  number(buffer.size());
  return bytes + std::string("BIN\0", 4) + buffer;
}

std::string gltf_tetrahedron_of_integers(const std::string& of_primitive, const std::string& of_file) {
  std::string buffer;
  for (const auto& corner : kCorners) {
    const bool replaced = &corner == &kCorners.back();
    for (const float x : corner) append(buffer, static_cast<std::int16_t>(replaced ? -1 : 32767 * x));
    buffer.append(2, '\0');  // padding to the stride of 8 bytes
  }
  for (const auto& face : kFaces) append(buffer, face);
  for (const auto& corner : kCorners)
    for (const float x : {corner[0], corner[1], 0.0F, 0.0F}) append(buffer, static_cast<std::uint8_t>(255 * x));
  append(buffer, std::uint32_t{3});  // index that the sparse part replaces
  for (const float x : kCorners.back()) append(buffer, static_cast<std::int16_t>(32767 * x));
  buffer.append(2, '\0');  // padding to a multiple of three bytes
  return R"({"asset":{"version":"2.0"},"extensionsRequired":["KHR_mesh_quantization"],"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":2},"indices":1)" +
         of_primitive + R"(}]}],
"buffers":[{"byteLength":84,"uri":"data:application/octet-stream;base64,)" +
         base64(buffer) + R"("}],
"bufferViews":[{"buffer":0,"byteLength":32,"byteStride":8},{"buffer":0,"byteOffset":32,"byteLength":24},
{"buffer":0,"byteOffset":56,"byteLength":16,"byteStride":4},{"buffer":0,"byteOffset":72,"byteLength":4},
{"buffer":0,"byteOffset":76,"byteLength":6}],
"accessors":[{"bufferView":0,"componentType":5122,"normalized":true,"count":4,"type":"VEC3",
"sparse":{"count":1,"indices":{"bufferView":3,"componentType":5125},"values":{"bufferView":4}}},
{"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"},
{"bufferView":2,"componentType":5121,"normalized":true,"count":4,"type":"VEC2"}])" +
         of_file + "}";
}

std::string gltf_of_two_skeletons() {
  std::string buffer;
  for (std::size_t v = 0; v < 3; ++v) append(buffer, kCorners[v]);
  for (std::size_t v = 0; v < 3; ++v) append(buffer, std::array<float, 4>{1, 0, 0, 0});  // weights
  for (std::size_t i = 0; i < 16; ++i) append(buffer, i % 5 == 0 ? 1.0F : 0.0F);         // matrix from mesh to joint
  buffer.append(12, '\0');                                                               // joints
  buffer.append(2, '\0');                                                                // padding
  const std::string primitives = R"({"primitives":[{"attributes":{"POSITION":0,"WEIGHTS_0":1,"JOINTS_0":3}}]})";
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1,2,3]}],
"nodes":[{"name":"Hips"},{"name":"Hips","translation":[5,0,0]},{"name":"a","mesh":0,"skin":0},
{"name":"b","mesh":1,"skin":1}],
"skins":[{"joints":[0],"inverseBindMatrices":2},{"joints":[1],"inverseBindMatrices":2}],
"meshes":[)" +
         primitives + "," + primitives +
         R"(],"buffers":[{"byteLength":162,"uri":"data:application/octet-stream;base64,)" + base64(buffer) + R"("}],
"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":48},
{"buffer":0,"byteOffset":84,"byteLength":64},{"buffer":0,"byteOffset":148,"byteLength":12}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
{"bufferView":1,"componentType":5126,"count":3,"type":"VEC4"},
{"bufferView":2,"componentType":5126,"count":1,"type":"MAT4"},
{"bufferView":3,"componentType":5121,"count":3,"type":"VEC4"}]})";
}

std::string gltf_camera(bool integers) {
  std::string keys;
  for (const float time : {0.0F, 2.0F}) append(keys, time);
  for (const float part : {0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.70710678F, 0.0F, 0.70710678F})
    integers ? append(keys, static_cast<std::int16_t>(32767 * part)) : append(keys, part);
  keys.resize(42, '\0');  // padding to a multiple of three bytes
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"name":"rig","children":[1]},{"name":"eye","camera":0,"translation":[0,1,3]}],
"cameras":[{"name":"lens","type":"perspective","perspective":{"yfov":0.5,"aspectRatio":1.6,"znear":0.1,"zfar":100}}],
"animations":[{"samplers":[{"input":0,"output":1}],"channels":[{"sampler":0,"target":{"node":0,"path":"rotation"}}]}],
"buffers":[{"byteLength":42,"uri":"data:application/octet-stream;base64,)" +
         base64(keys) + R"("}],"bufferViews":[{"buffer":0,"byteLength":8},{"buffer":0,"byteOffset":8,"byteLength":32}],
"accessors":[{"bufferView":0,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[2]},
{"bufferView":1,"componentType":)" +
         (integers ? R"(5122,"normalized":true)" : "5126") + R"(,"count":2,"type":"VEC4"}]})";
}

std::string fbx_square() {
  return R"(; FBX 7.3.0 project file
FBXHeaderExtension:  {
	FBXVersion: 7300
}
GlobalSettings:  {
	Version: 1000
	Properties70:  {
		P: "UnitScaleFactor", "double", "Number", "",1
	}
}
Objects:  {
	Geometry: 100, "Geometry::cloth", "Mesh" {
		Vertices: *12 {
			a: 0,0,0,100,0,0,100,100,0,0,100,0
		}
		PolygonVertexIndex: *4 {
			a: 0,1,2,-4
		}
		GeometryVersion: 124
		LayerElementUV: 0 {
			Version: 101
			Name: "map"
			MappingInformationType: "ByPolygonVertex"
			ReferenceInformationType: "Direct"
			UV: *8 {
				a: 0,0,1,0,1,1,0,1
			}
		}
		Layer: 0 {
			Version: 100
			LayerElement:  {
				Type: "LayerElementUV"
				TypedIndex: 0
			}
		}
	}
	Model: 200, "Model::cloth", "Mesh" {
		Version: 232
	}
}
Connections:  {
	C: "OO",200,0
	C: "OO",100,200
}
)";
}

std::string collada_square() {
  return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="inch" meter="0.0254"/><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 39.3701 0 0 39.3701 39.3701 0 0 39.3701 0</float_array>
<technique_common><accessor source="#pa" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<source id="t"><float_array id="ta" count="8">0 0 1 0 1 1 0 1</float_array>
<technique_common><accessor source="#ta" count="4" stride="2"><param name="S" type="float"/><param name="T" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist count="1"><input semantic="VERTEX" source="#v" offset="0"/><input semantic="TEXCOORD" source="#t" offset="1" set="0"/>
<vcount>4</vcount><p>0 0 1 1 2 2 3 3</p></polylist>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
)";
}

}  // namespace weft::assets
