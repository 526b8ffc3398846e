// A body: a skeleton of bones, the skin (a mesh that the skeleton moves), and motion clips. Characters from files and
// the built-in mannequin share these types.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "physics/mesh/mesh.hpp"

namespace weft::character {

using Affine = Eigen::Affine3d;

/// A node of the transform hierarchy: a joint, or any other object of a file that has a transform.
struct Node {
  std::string name;
  Index parent = -1;                  ///< -1 for a root; parents precede their children
  Affine local = Affine::Identity();  ///< transform from node to parent in the rest pose
};

/// A bone of linear blend skinning. In a pose, the bone maps a vertex x to G · offset · x, where G is the global
/// transform of its node.
struct Bone {
  Index node = 0;
  Affine offset = Affine::Identity();  ///< transform from mesh to node in the bind pose
};

/// The influence of a bone on a vertex.
struct Influence {
  Index bone = 0;
  double weight = 0;  ///< the weights of a vertex sum to 1
};

/// A blend shape. A pose adds its displacements, times a weight, to the vertices before skinning.
struct MorphTarget {
  std::string name;
  std::vector<Vec3> displacements;  ///< per vertex, in the bind pose [m]
  double weight = 0;                ///< in the rest pose
};

/// Keys of a value at strictly increasing times [s]. Between keys, the value is interpolated linearly (a rotation along
/// the shortest arc); before the first and after the last key, it is constant.
template <typename Value>
struct Curve {
  std::vector<double> times;
  std::vector<Value> values;
};

/// Motion of one node relative to its parent. If a curve is empty, the value of the rest pose applies.
struct Channel {
  Index node = 0;
  Curve<Vec3> position;
  Curve<Quat> rotation;
  Curve<Vec3> scale;
};

/// Weight of one morph target over time.
struct MorphChannel {
  Index target = 0;
  Curve<double> weight;
};

/// A motion.
struct Clip {
  std::string name;
  double duration = 0;  ///< [s]
  std::vector<Channel> channels;
  std::vector<MorphChannel> morphs;
};

/// A surface material: its colour and its picture (texture).
struct Material {
  /// What is drawn beyond the edge of the picture: the picture again, its border pixels, its mirror image, or nothing.
  enum class Wrap : std::uint8_t { repeat, clamp, mirror, once };
  std::string name;
  Vec3 color{0.8, 0.8, 0.8};         ///< linear RGB; multiplied with the picture
  std::string picture;               ///< content of a PNG, JPEG or TGA file; empty: none
  int width = 0, height = 0;         ///< size of the picture in `pixels` [pixels]
  std::vector<std::uint8_t> pixels;  ///< used if `picture` is empty: R G B A, sRGB, top row first; empty: none
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  bool cutout = false;  ///< whether transparent parts of the picture are holes in the surface
};

/// Materials and pictures of the triangles of a mesh.
struct Coloring {
  std::vector<Material> materials;
  std::vector<Index> material_of_triangle;  ///< per triangle: index into `materials`; empty: no colours
  std::vector<std::array<Vec2, 3>> uv;      ///< per triangle: (u, v) of its corners, from the lower left of the picture
  bool covers_look = false;                 ///< whether the colour from the scene shows where pictures are transparent
};

/// A body of bones and skin, with its clips. load_character() returns it in metres and the axes of the scene,
/// make_mannequin() in metres with z up.
struct Character {
  std::vector<Node> nodes;
  std::vector<Bone> bones;
  /// In the bind pose. Vertices of the file with equal position, weights and displacements are merged.
  mesh::Mesh mesh;
  std::vector<Index> first_influence;  ///< per vertex, its first index in `influences`; last entry: their total number
  std::vector<Influence> influences;
  std::vector<MorphTarget> morphs;
  std::vector<std::string> materials;     ///< names of all materials in the file
  std::vector<Index> material_of_vertex;  ///< index into `materials`; -1: none; empty for the mannequin
  Coloring coloring;
  std::vector<Clip> clips;
};

}  // namespace weft::character
