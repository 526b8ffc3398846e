// The hash of a scene must cover every file on which the result depends.
#include "film/scene/dependencies.hpp"

#include <gtest/gtest.h>

#include "film/image/png.hpp"
#include "film/scene/loader.hpp"
#include "support/test_folder.hpp"

namespace weft::scene {
namespace {

class Dependencies : public support::TestFolder {
 protected:
  void put(const std::string& file, const std::string& content) {
    std::filesystem::create_directories((folder_ / file).parent_path());
    support::write_bytes(folder_ / file, content);
  }
  void put_picture(const std::string& file) {
    put(file, "");
    image::write_png(folder_ / file, image::Image(4, 4));
  }
  std::uint64_t hash_of(const std::string& scene) {
    const LoadResult result = load_text(scene, folder_ / "s.toml");
    EXPECT_EQ(result.describe(), "");
    return result.scene.hash;
  }
  /// Expects that a changed byte of this file changes the hash, and that a changed file beside it, to which nothing
  /// refers, does not.
  void expect_counts(const std::string& scene, const std::string& file) {
    const auto before = hash_of(scene);
    const std::string content = support::read_bytes(folder_ / file);
    put("bystander.bin", content);
    EXPECT_EQ(hash_of(scene), before) << scene;
    put("bystander.bin", content + "x");
    EXPECT_EQ(hash_of(scene), before) << scene;
    put(file, content + "\n");
    EXPECT_NE(hash_of(scene), before) << file << " of " << scene;
    put(file, content);
    EXPECT_EQ(hash_of(scene), before) << scene;
  }
};

TEST_F(Dependencies, MeshesOfObstaclesAndCloths) {
  put("m.obj", "v 0 0 0\n");
  expect_counts("obstacle = [{ name = 'm', shape = 'mesh', file = 'm.obj' }]\n", "m.obj");
  expect_counts("cloth = [{ name = 'm', shape = 'mesh', file = 'm.obj' }]\n", "m.obj");
}

TEST_F(Dependencies, PatternsAndTheirDrawings) {
  put("p/skirt.toml",
      "[[panel]]\nname = 'front'\nfile = 'drawn/my front.svg'\nid = 'front'\n"
      "[[panel]]\nname = 'back'\nfile = 'drawn/back (1), old.svg'\nid = 'back'\n");
  put("p/drawn/my front.svg", "<svg/>");
  put("p/drawn/back (1), old.svg", "<svg/>");
  const std::string scene = "cloth = [{ name = 'c', shape = 'pattern', file = 'p/skirt.toml' }]\n";
  expect_counts(scene, "p/skirt.toml");
  expect_counts(scene, "p/drawn/my front.svg");
  expect_counts(scene, "p/drawn/back (1), old.svg");
}

TEST_F(Dependencies, CharactersMotionsAndWhatTheyName) {
  put("man.gltf", R"({ "buffers": [{ "uri": "data/man%20mesh.bin", "byteLength": 4 }] })");
  put("data/man mesh.bin", "1234");
  put("guard.md5mesh", "MD5Version 10");
  put("guard.md5anim", "MD5Version 10");
  put("walk.bvh", "HIERARCHY");
  const std::string man = "character = [{ name = 'm', source = 'file', file = 'man.gltf', motion = 'walk.bvh' }]\n";
  for (const char* file : {"man.gltf", "data/man mesh.bin", "walk.bvh"}) expect_counts(man, file);
  expect_counts("character = [{ name = 'g', source = 'file', file = 'guard.md5mesh' }]\n", "guard.md5anim");
  expect_counts("character = [{ name = 'm', source = 'mannequin', motion = 'walk.bvh' }]\n", "walk.bvh");
}

TEST_F(Dependencies, FilesOfASequence) {
  for (const char* file : {"run/a_1.obj", "run/a_2.obj", "run/a_3.obj"}) put(file, "v 0 0 0\n");
  const std::string scene = "character = [{ name = 'r', source = 'sequence', files = 'run' }]\n";
  expect_counts(scene, "run/a_1.obj");
  expect_counts(scene, "run/a_3.obj");
}

TEST_F(Dependencies, FolderOfASequenceHasTheSameHashByEachOfItsNames) {
  for (const char* file : {"run/a_1.obj", "run/a_2.obj"}) put(file, "v 0 0 0\n");
  const auto hash = [&](const std::string& files) {
    return hash_of("character = [{ name = 'r', source = 'sequence', files = '" + files + "' }]\n");
  };
  for (const char* files : {"run/", "./run", "run/.", "run/*.obj"}) EXPECT_EQ(hash(files), hash("run")) << files;
}

// The effective scene contains absolute paths, and TOML is UTF-8.
TEST_F(Dependencies, InAFolderWhoseNameIsNotUtf8AreRefused) {
  for (const char* file : {"\xe9/m.obj", "\xe9/run/1.obj", "\xe9/run/2.obj"}) put(file, "v 0 0 0\n");
  const auto messages = [&](const std::string& scene) { return load_text(scene, folder_ / "\xe9/s.toml").describe(); };
  EXPECT_NE(messages("obstacle = [{ name = 'm', shape = 'mesh', file = 'm.obj' }]\n")
                .find("obstacle.m.file: expected a readable file, got \"m.obj\": the path of the scene's folder is not "
                      "UTF-8"),
            std::string::npos);
  EXPECT_NE(messages("character = [{ name = 'r', source = 'sequence', files = 'run' }]\n")
                .find("character.r.files: expected files in a folder whose path is UTF-8"),
            std::string::npos);
  EXPECT_EQ(messages("obstacle = [{ name = 'ball', shape = 'sphere' }]\n"), "");
}

TEST_F(Dependencies, PicturesAndCameraFilesCountButAreNotSimulated) {
  for (const char* file : {"print.png", "panel.png", "globe.png"}) put_picture(file);
  put("shot.gltf", R"({ "uri": "shot.bin" })"), put("shot.bin", "1234"), put("p/skirt.toml", "");
  const std::string scene =
      "cloth = [{ name = 'c', look = { image = 'print.png' } },\n"
      "  { name = 'd', shape = 'pattern', file = 'p/skirt.toml', look = { panel = [{ name = 'front', image = "
      "'panel.png' }] } }]\n"
      "obstacle = [{ name = 'o', shape = 'sphere', look = { image = 'globe.png' } }]\n"
      "camera = [{ name = 'shot', kind = 'file', file = 'shot.gltf' }]\n";
  const auto simulated = [&] { return load_text(scene, folder_ / "s.toml").scene.simulation_hash; };
  const auto before = simulated();
  for (const char* file : {"print.png", "panel.png", "globe.png", "shot.gltf", "shot.bin"}) {
    expect_counts(scene, file);
    const std::string content = support::read_bytes(folder_ / file);
    put(file, content + "\n");
    EXPECT_EQ(simulated(), before) << file;
    put(file, content);
  }
}

TEST_F(Dependencies, MasksOfPinsWeightsAndAttachments) {
  for (const char* file : {"pin.png", "weight.png", "attach.png"}) put_picture(file);
  const std::string scene =
      "cloth = [{ name = 'c', pin = [{ mask = 'pin.png' }], weight = [{ mask = 'weight.png', mass = 0.1 }] }]\n"
      "obstacle = [{ name = 'o', shape = 'sphere' }]\n"
      "attach = [{ name = 'a', cloth = 'c', to = 'o', mask = 'attach.png' }]\n";
  for (const char* file : {"pin.png", "weight.png", "attach.png"}) expect_counts(scene, file);
}

TEST_F(Dependencies, FoldersDoNotCount) {
  const std::string scene =
      "cloth = [{ name = 'c', look = { image = 'print.png' }, pin = [{ mask = 'mask.png' }] }]\n"
      "obstacle = [{ name = 'o', shape = 'sphere' }]\nattach = [{ name = 'a', cloth = 'c', to = 'o', mask = 'mask.png' "
      "}]\n"
      "camera = [{ name = 'shot', kind = 'file', file = 'shot.gltf' }]\n";
  std::vector<std::uint64_t> hashes;
  for (const std::string folder : {"here", "there"}) {
    put(folder + "/shot.gltf", "{}");
    for (const char* file : {"/print.png", "/mask.png"}) put_picture(folder + file);
    const LoadResult result = load_text(scene, folder_ / folder / "s.toml");
    EXPECT_EQ(result.describe(), "");
    hashes.push_back(result.scene.hash);
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

// If a byte moves from the end of one file to the start of the next, the hash must change.
TEST_F(Dependencies, WhereOneFileEndsCounts) {
  const std::string scene =
      "obstacle = [{ name = 'a', shape = 'mesh', file = 'a.obj' }, { name = 'b', shape = 'mesh', file = 'b.obj' }]\n";
  put("a.obj", "v 0 0 0\n"), put("b.obj", "\nv 1 0 0\n");
  const auto before = hash_of(scene);
  put("a.obj", "v 0 0 0\n\n"), put("b.obj", "v 1 0 0\n");
  EXPECT_NE(hash_of(scene), before);
}

// Files that refer to each other, or to themselves, are read only once.
TEST_F(Dependencies, EachFileIsReadOnce) {
  put("a.obj", "mtllib a.obj b.mtl\n");
  put("b.mtl", "map_Kd a.obj\n");
  const LoadResult result =
      load_text("obstacle = [{ name = 'a', shape = 'mesh', file = 'a.obj' }]\n", folder_ / "s.toml");
  int count = 0;
  for_each_dependency(result.scene, [&](const auto&, std::string_view, FileUse) { ++count; });
  EXPECT_EQ(count, 2);
}

}  // namespace
}  // namespace weft::scene
