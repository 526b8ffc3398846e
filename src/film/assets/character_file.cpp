#include "film/assets/character_file.hpp"

#include <algorithm>
#include <assimp/Importer.hpp>
#include <utility>

#include "film/assets/character_reader.hpp"
#include "film/assets/import.hpp"
#include "film/assets/source.hpp"
#include "film/assets/text_file.hpp"

namespace weft::assets {
namespace {

ReadCharacter read_file(const std::filesystem::path& file, bool with_mesh, const MeshChoice& choice) {
  if (is_bvh(file)) check_bvh(file);
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, !with_mesh);
  const aiScene& scene = import(importer, file, 0);
  ReadCharacter read = to_character(scene, with_mesh ? file : std::filesystem::path(), choice);
  read.up = up_axis(importer, scene);
  return read;
}

/// BVH does not define whether the translations of a joint are positions or must be added to its offset. There are
/// files of both kinds; assimp assumes positions. If the translations of most joints below the root are nearer to zero
/// than to the offset, adds the offsets, so that bones keep their lengths.
void add_bvh_offsets(character::Character& character) {
  int on_top = 0, places = 0;
  for (const character::Clip& clip : character.clips)
    for (const character::Channel& channel : clip.channels) {
      if (character.nodes[channel.node].parent < 0) continue;
      const Vec3 offset = character.nodes[channel.node].local.translation();
      double from_nothing = 0, from_offset = 0;
      for (const Vec3& x : channel.position.values) from_nothing += x.norm(), from_offset += (x - offset).norm();
      on_top += from_nothing < from_offset ? 1 : 0;
      places += from_offset < from_nothing ? 1 : 0;
    }
  if (on_top <= places) return;
  for (character::Clip& clip : character.clips)
    for (character::Channel& channel : clip.channels)
      for (Vec3& x : channel.position.values) x += character.nodes[channel.node].local.translation();
}

/// Adds the file name to warnings, rotates to the scene's axes and scales to metres.
LoadedCharacter finish(const Source& source, ReadCharacter read, const FileAxes& axes) {
  LoadedCharacter loaded{std::move(read.character), {}, axes.scale.value_or(read.metres_per_unit.value_or(1))};
  for (const std::string& warning : read.warnings) loaded.warnings.push_back(source.describe(warning));
  if (is_bvh(source.file)) add_bvh_offsets(loaded.character);
  transform(loaded.character, loaded.scale, axes.rotation(read.up));
  return loaded;
}

ReadCharacter read_isolated(const Source& source, bool with_mesh, const MeshChoice& choice = {}) {
  const std::string bytes = source.read([&] {
    ReadCharacter read = read_file(source.file, with_mesh, choice);
    return to_bytes(read);
  });
  return source.checked([&] { return character_from_bytes(bytes); });
}

template <class Value, class Change>
void change(character::Curve<Value>& curve, const Change& change) {
  for (Value& value : curve.values) value = change(value);
}

}  // namespace

bool is_bvh(const std::filesystem::path& file) {
  return ending_of(file) == ".bvh";
}

Mat3 rotation_to_scene_axes(int up, scene::UpAxis scene_up) {
  const int to = scene_up == scene::UpAxis::z ? 2 : 1;
  // Between y and z, the rotation is a quarter turn about x; otherwise, a cyclic permutation of the axes.
  Mat3 turn = Mat3::Zero();
  if (up == 1 && to == 2) return (turn << 1, 0, 0, 0, 0, -1, 0, 1, 0).finished();
  if (up == 2 && to == 1) return (turn << 1, 0, 0, 0, 0, 1, 0, -1, 0).finished();
  for (int axis = 0; axis < 3; ++axis) turn((axis + to - up + 3) % 3, axis) = 1;
  return turn;
}

Mat3 FileAxes::rotation(std::optional<int> stated_up) const {
  constexpr int kUsualUp = 1;  // y
  return rotation_to_scene_axes(up == scene::FileUp::as_file ? stated_up.value_or(kUsualUp) : static_cast<int>(up) - 1,
                                scene_up);
}

void transform(character::Character& character, double scale, const Mat3& axes) {
  const Quat turn(axes);
  const Mat3 sizes = axes.cwiseAbs();
  const auto move = [&](const Vec3& x) -> Vec3 { return scale * (axes * x); };
  const auto conjugate = [&](character::Affine& map) {
    map.linear() = axes * map.linear() * axes.transpose();
    map.translation() = move(map.translation());
  };
  for (character::Node& node : character.nodes) conjugate(node.local);
  for (character::Bone& bone : character.bones) conjugate(bone.offset);
  for (Vec3& x : character.mesh.positions) x = move(x);
  for (character::MorphTarget& target : character.morphs)
    for (Vec3& x : target.displacements) x = move(x);
  for (character::Clip& clip : character.clips)
    for (character::Channel& channel : clip.channels) {
      change(channel.position, move);
      change(channel.rotation, [&](const Quat& q) { return (turn * q * turn.conjugate()).normalized(); });
      change(channel.scale, [&](const Vec3& s) -> Vec3 { return sizes * s; });
    }
}

LoadedCharacter load_character(const std::filesystem::path& file, const FileAxes& axes, const std::string& where,
                               const MeshChoice& choice) {
  const Source source{file, where, "character"};
  LoadedCharacter loaded = finish(source, read_isolated(source, true, choice), axes);
  if (loaded.character.mesh.topology.triangles.empty())
    source.fail("expected a mesh with faces that have an area, got none");
  for (const Vec3& x : loaded.character.mesh.positions) source.check_coordinates(x);
  return loaded;
}

LoadedCharacter load_motion(const std::filesystem::path& file, const FileAxes& axes, const std::string& where) {
  const Source source{file, where, "motion"};
  LoadedCharacter loaded = finish(source, read_isolated(source, false), axes);
  if (loaded.character.clips.empty()) source.fail("expected a motion, got a file without animation");
  return loaded;
}

}  // namespace weft::assets
