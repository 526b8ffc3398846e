// A body of bones and skin, and its motions. Characters from files and the built-in mannequin share this type.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "physics/mesh/mesh.hpp"

namespace weft::character {

using Affine = Eigen::Affine3d;

/// One node of the hierarchy. Joints are nodes, as is any other object of a file that has a transform.
struct Node {
  std::string name;
  Index parent = -1;                  ///< -1: a root; parents precede their children
  Affine local = Affine::Identity();  ///< node to parent, at rest
};

/// Moves vertices. In any pose, a bone takes a vertex x to G · offset · x, where G is the global transform of its node.
struct Bone {
  Index node = 0;
  Affine offset = Affine::Identity();  ///< mesh to node, in the pose in which the skin is bound
};

struct Influence {
  Index bone = 0;
  double weight = 0;  ///< weights of one vertex sum to 1
};

/// A blend shape: displacements of the vertices, which a pose adds times a weight.
struct MorphTarget {
  std::string name;
  std::vector<Vec3> displacements;  ///< per vertex of the mesh as bound [m]
  double weight = 0;                ///< at rest
};

/// A value given at strictly increasing times [s]. It is interpolated linearly (rotations along the shortest arc), and
/// constant before the first and after the last time.
template <typename Value>
struct Curve {
  std::vector<double> times;
  std::vector<Value> values;
};

/// Motion of one node relative to its parent. An empty curve means the value at rest.
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

/// Appearance of a material of a file.
struct Material {
  enum class Wrap : std::uint8_t { repeat, clamp, mirror, once };  ///< once: transparent beyond the edge
  std::string name;
  Vec3 color{0.8, 0.8, 0.8};         ///< linear; multiplies the picture
  std::string picture;               ///< content of a PNG, JPEG or TGA file; empty: none
  int width = 0, height = 0;         ///< size of `pixels`
  std::vector<std::uint8_t> pixels;  ///< used if `picture` is empty: R G B A, sRGB, top row first; empty: none
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  bool cutout = false;  ///< transparent parts of the picture are holes
};

/// Materials and pictures of the triangles of a mesh.
struct Coloring {
  std::vector<Material> materials;
  std::vector<Index> material_of_triangle;  ///< per triangle; empty if the file has no colours
  std::vector<std::array<Vec2, 3>> uv;      ///< per triangle: (u, v) of its corners, from the lower left of the picture
  bool covers_look = false;                 ///< the scene's colour stays visible where pictures are transparent
};

/// Lengths in metres; up axis as in the scene.
struct Character {
  std::vector<Node> nodes;
  std::vector<Bone> bones;
  mesh::Mesh mesh;                     ///< as bound; copies of a vertex that always move together are merged
  std::vector<Index> first_influence;  ///< first index into `influences` per vertex, then the total count
  std::vector<Influence> influences;
  std::vector<MorphTarget> morphs;
  std::vector<std::string> materials;     ///< names in the file
  std::vector<Index> material_of_vertex;  ///< per vertex; empty if there are no materials
  Coloring coloring;
  std::vector<Clip> clips;
};

}  // namespace weft::character
