// A body of bones and skin, and the motions that it knows. From a file or made by us, it is the same.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "mesh/mesh.hpp"

namespace weft::character {

using Affine = Eigen::Affine3d;

/// One node of the hierarchy. Joints are nodes; so is whatever else has a place in a file.
struct Node {
  std::string name;
  Index parent = -1;                  ///< comes before its children; -1 for a root
  Affine local = Affine::Identity();  ///< node to parent, at rest
};

/// What moves vertices: at any pose a vertex is where global(node) · offset takes it.
struct Bone {
  Index node = 0;
  Affine offset = Affine::Identity();  ///< mesh to node, in the pose in which the skin was bound
};

struct Influence {
  Index bone = 0;
  double weight = 0;  ///< those of one vertex add up to 1
};

/// A displaced copy of the mesh that is blended in by a weight.
struct MorphTarget {
  std::string name;
  std::vector<Vec3> displacements;  ///< per vertex of the mesh as bound [m]
  double weight = 0;                ///< at rest
};

/// A value at times [s] that strictly increase; linear between them (rotations along the shortest way), constant
/// outside.
template <typename Value>
struct Curve {
  std::vector<double> times;
  std::vector<Value> values;
};

/// How one node moves against its parent. An empty curve: as at rest.
struct Channel {
  Index node = 0;
  Curve<Vec3> position;
  Curve<Quat> rotation;
  Curve<Vec3> scale;
};

struct MorphChannel {
  Index target = 0;
  Curve<double> weight;
};

struct Clip {
  std::string name;
  double duration = 0;  ///< [s]
  std::vector<Channel> channels;
  std::vector<MorphChannel> morphs;
};

/// How a material of a file looks.
struct Material {
  enum class Wrap : std::uint8_t { repeat, clamp, mirror, once };  ///< once: nothing beyond the edge
  std::string name;
  Vec3 color{0.8, 0.8, 0.8};         ///< linear; what a picture is multiplied by
  std::string picture;               ///< bytes of a PNG, JPEG or TGA file; empty: none
  int width = 0, height = 0;         ///< of `pixels`
  std::vector<std::uint8_t> pixels;  ///< a picture without a file: R G B A, sRGB, rows from the top; empty: none
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  bool cutout = false;  ///< what is transparent in the picture is a hole
};

/// Materials and pictures on the triangles of a mesh.
struct Coloring {
  std::vector<Material> materials;
  std::vector<Index> material_of_triangle;  ///< per triangle; empty where the file has no colours
  std::vector<std::array<Vec2, 3>> uv;      ///< per triangle: (u, v) of its corners, from the lower left of the picture
  bool over_look = false;  ///< pictures lie over the colour that the scene gives, where they are opaque
};

/// Lengths in metres, axes of the scene's up axis.
struct Character {
  std::vector<Node> nodes;
  std::vector<Bone> bones;
  mesh::Mesh mesh;                     ///< as bound; copies of a vertex that always move together are one vertex
  std::vector<Index> first_influence;  ///< per vertex, and the number of all at the end
  std::vector<Influence> influences;
  std::vector<MorphTarget> morphs;
  std::vector<std::string> materials;     ///< names in the file
  std::vector<Index> material_of_vertex;  ///< per vertex; empty where there are none
  Coloring coloring;
  std::vector<Clip> clips;
};

}  // namespace weft::character
