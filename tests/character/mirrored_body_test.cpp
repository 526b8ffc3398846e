// Motions for bodies whose file mirrors the nodes of the skeleton, as programs with left-handed axes write.
#include <gtest/gtest.h>

#include <vector>

#include "film/character/gait.hpp"
#include "film/character/joints.hpp"
#include "film/character/mannequin.hpp"
#include "film/character/retarget.hpp"
#include "posed_mannequin.hpp"

namespace weft::character {
namespace {

/// The same body in the world, but a node above all others mirrors their axes at x = 0.
Character with_mirrored_nodes(const Character& body) {
  Affine mirror = Affine::Identity();
  mirror.linear() = Vec3(-1, 1, 1).asDiagonal();
  Character mirrored = body;
  mirrored.nodes = {{"scene", -1, mirror}};
  for (const Node& node : body.nodes)
    mirrored.nodes.push_back({node.name, node.parent + 1, mirror * node.local * mirror});
  for (Bone& bone : mirrored.bones) {
    ++bone.node;
    bone.offset = mirror * bone.offset;
  }
  return mirrored;
}

TEST(MirroredBody, MovesAsABodyThatIsNotMirrored) {
  const Character walker = make_mannequin({.edge_length = 0.1});
  const Clip walk = make_walk(walker, {.distance = 2});
  const Character plain = make_mannequin({.masculinity = 1, .edge_length = 0.1}), mirrored = with_mirrored_nodes(plain);
  const std::vector<Index> theirs = find_joints(walker), ours = find_joints(plain), of_mirrored = find_joints(mirrored);
  for (std::size_t j = 0; j < kJointCount; ++j) ASSERT_EQ(of_mirrored[j], ours[j] + 1) << j;
  const Clip expected = retarget({plain, ours}, {walker, theirs}, walk, kUp).clip,
             found = retarget({mirrored, of_mirrored}, {walker, theirs}, walk, kUp).clip;
  for (const double t : {0.0, 0.7, 1.1, 1.6}) {
    const auto places = global_transforms(plain, pose_at(plain, expected, t)),
               mirrored_places = global_transforms(mirrored, pose_at(mirrored, found, t));
    for (std::size_t n = 0; n < places.size(); ++n)
      EXPECT_LT((mirrored_places[n + 1].translation() - places[n].translation()).norm(), 1e-6) << n << " at " << t;
  }
}

}  // namespace
}  // namespace weft::character
