// The folder of a cache, with the files that writers leave in it.
#include <gtest/gtest.h>

#include "cache/sample.hpp"
#include "film/cache/names.hpp"
#include "film/cache/reader.hpp"
#include "film/cache/writer.hpp"
#include "support/test_folder.hpp"

namespace weft::cache {
namespace {

namespace fs = std::filesystem;
using support::expect_error;

class CacheFolder : public support::TestFolder {
 protected:
  void fill(int frames) const {
    const Lock lock(cache());
    Writer writer(lock, sample_.manifest(), "[time]\n");
    for (int k = 0; k < frames; ++k) writer.add(*sample_.snapshot(k), sample_.report(k));
    writer.save_state(frames - 1, "exact");
  }
  void expect_unreadable(std::string_view words) const {
    expect_error(ExitCode::asset_unreadable, words, [&] {
      const Reader reader(cache());
      for (const int k : reader.frames()) reader.read(k);
      (void)reader.state();
    });
  }
  fs::path cache() const { return folder_ / "c"; }

  const Sample sample_;
};

TEST_F(CacheFolder, GivesBackWhatWasPutIn) {
  fill(3);
  const Reader reader(cache());
  EXPECT_EQ(reader.frames(), (std::vector<int>{0, 1, 2}));
  for (const int k : {2, 0, 1}) {
    const CachedFrame cached = reader.read(k);
    for (std::size_t s = 0; s < 2; ++s)
      EXPECT_TRUE(same_bits(cached.snapshot->states[s].positions, sample_.snapshot(k)->states[s].positions));
    EXPECT_EQ(cached.report.steps, 10 + k);
    EXPECT_EQ(cached.snapshot->surfaces[0], reader.snapshot(0)->surfaces[0]) << "frames do not share their surfaces";
  }
  ASSERT_TRUE(reader.state());
  EXPECT_EQ(reader.state()->frame, 2);
  EXPECT_EQ(reader.state()->bytes, "exact");
  EXPECT_EQ(reader.scene_text(), "[time]\n");
  EXPECT_TRUE(reader.has(2));
  EXPECT_FALSE(reader.has(3) || reader.has(-1));
  EXPECT_EQ(manifest_text(reader.manifest()), manifest_text(sample_.manifest()));
  EXPECT_EQ(reader.manifest().title, sample_.manifest().title);
  EXPECT_EQ(reader.manifest().cameras, sample_.manifest().cameras);
  EXPECT_EQ(reader.manifest().scene_hash, kSampleHash);
}

TEST_F(CacheFolder, ASceneThatIsALinkElsewhereIsNotRead) {
  fill(1);
  support::write_bytes(folder_ / "secret", "secret");
  fs::remove(cache() / kSceneFile);
  fs::create_symlink("../secret", cache() / kSceneFile);
  expect_error(ExitCode::asset_unreadable, "scene.effective.toml: broken: expected a file of the cache, got a link",
               [&] { (void)Reader(cache()).scene_text(); });
}

TEST_F(CacheFolder, IsGoneOnWithByAnotherWriter) {
  fill(2);
  {
    const Lock lock(cache());
    Writer writer(lock, sample_.manifest(), "");
    writer.add(*sample_.snapshot(2), sample_.report(2));
  }
  const Reader reader(cache());
  EXPECT_EQ(reader.frames(), (std::vector<int>{0, 1, 2}));
  EXPECT_TRUE(same_bits(reader.snapshot(2)->states[0].positions, sample_.snapshot(2)->states[0].positions));
  EXPECT_TRUE(same_bits(reader.snapshot(2)->states[1].positions, sample_.snapshot(0)->states[1].positions));
}

TEST_F(CacheFolder, OpenedBeforeFrame0GivesTheFramesThatFollow) {
  const Lock lock(cache());
  Writer writer(lock, sample_.manifest(), "");
  const Reader reader(cache());
  expect_error(ExitCode::asset_unreadable, "c: holds no frame yet", [&] { reader.read(0); });
  for (int k = 0; k < 2; ++k) writer.add(*sample_.snapshot(k), sample_.report(k));
  EXPECT_TRUE(same_bits(reader.snapshot(1)->states[0].positions, sample_.snapshot(1)->states[0].positions));
}

TEST_F(CacheFolder, FramesAreReadWhileOthersAreMissing) {
  fill(5);
  fs::remove(cache() / frame_file(1));
  support::write_bytes(cache() / "frame_1.weft", "");
  support::write_bytes(cache() / "frame_00099.weft", "beyond the scene");
  fs::create_symlink("nowhere", cache() / frame_file(1));
  const Reader reader(cache());
  EXPECT_EQ(reader.frames(), (std::vector<int>{0, 2, 3, 4}));
  EXPECT_EQ(reader.snapshot(3)->frame, 3);
  expect_error(ExitCode::asset_unreadable, "frame_00001.weft: cannot be read", [&] { reader.snapshot(1); });
}

TEST_F(CacheFolder, BrokenFilesAreNamed) {
  fill(2);
  const auto spoil = [&](const char* name, const std::string& content, const char* words) {
    const std::string good = support::read_bytes(cache() / name);
    support::write_bytes(cache() / name, content);
    expect_unreadable(words);
    support::write_bytes(cache() / name, good);
  };
  spoil("frame_00001.weft", "", "frame_00001.weft: broken: it was cut short");
  spoil("frame_00001.weft", std::string(100, 'x'), "frame_00001.weft: broken: it is no file of a frame cache");
  spoil("frame_00001.weft", support::read_bytes(cache() / "frame_00000.weft"),
        "frame_00001.weft: broken: it is another");
  spoil("frame_00001.weft", support::read_bytes(cache() / "surfaces.weft"), "frame_00001.weft: broken: it is another");
  spoil("frame_00001.weft", pack({Kind::frame, 1, kSampleHash}, "?"), "frame_00001.weft: broken: the data was cut");
  spoil("frame_00001.weft", pack({Kind::frame, 1, 5}, "?"), "got one of 0000000000000005");
  spoil("surfaces.weft", "x", "surfaces.weft: broken: it was cut short");
  spoil("state.weft", pack({Kind::frame, 1, kSampleHash}, "?"), "state.weft: broken: it is another");
  spoil("manifest.json", "{", "manifest.json: broken");
  spoil("manifest.json", "[]", "manifest.json: broken: it is no manifest");
  Manifest other = sample_.manifest();
  other.objects[0].vertices = 5;
  spoil("manifest.json", manifest_text(other), "expected 5 vertices of 'cloth' as in the manifest, got 4");
  other.objects.pop_back();
  spoil("manifest.json", manifest_text(other), "its objects are not those of the manifest");
  std::string newer = manifest_text(sample_.manifest());
  newer.replace(newer.find("\"format_version\": 19"), 20, "\"format_version\": 20");
  spoil("manifest.json", newer,
        "manifest.json: made by another version of Weft (format 20; this one reads 19); simulate the scene again");
  expect_error(ExitCode::asset_unreadable, "expected a frame cache, a folder with a manifest.json",
               [&] { Reader reader(folder_); });
}

TEST_F(CacheFolder, NoChangeOfTheManifestCrashesTheReader) {
  const std::string good = manifest_text(sample_.manifest());
  std::mt19937 random(6);
  for (int round = 0; round < 5000; ++round) {
    std::string bad = good;
    bad[random() % bad.size()] = static_cast<char>(random());
    try {
      parse_manifest(bad);
    } catch (const std::runtime_error&) {  // refused
    }
  }
}

TEST_F(CacheFolder, VerifyFindsWhatReadingFinds) {
  fill(3);
  const Reader reader(cache());
  reader.verify(2);
  std::string bytes = support::read_bytes(cache() / frame_file(2));
  bytes.back() = static_cast<char>(bytes.back() ^ 1);
  support::write_bytes(cache() / frame_file(2), bytes);
  expect_error(ExitCode::asset_unreadable, "frame_00002.weft: broken: its checksum", [&] { reader.verify(2); });
  support::write_bytes(cache() / frame_file(2), support::read_bytes(cache() / frame_file(1)));
  expect_error(ExitCode::asset_unreadable, "frame_00002.weft: broken", [&] { reader.verify(2); });
}

TEST_F(CacheFolder, HasOneWriterAtATime) {
  const auto first = std::make_unique<Lock>(cache());
  expect_error(ExitCode::output_failed, "another process writes it", [&] { Lock second(cache()); });
}

TEST_F(CacheFolder, IsFreeAgainOnceItsWriterIsGone) {
  { const Lock first(cache()); }
  const Lock second(cache());
  second.remove();
  EXPECT_FALSE(fs::exists(cache()));
  const Lock third(cache());
  EXPECT_TRUE(fs::exists(cache() / kLockFile)) << "a lock in a folder that is gone";
}

TEST_F(CacheFolder, ForeignFilesAreNeverTouched) {
  fs::create_directories(cache());
  support::write_bytes(cache() / "thesis.tex", "precious");
  expect_error(ExitCode::output_failed, "holds thesis.tex, which is no part of a frame cache",
               [&] { Lock lock(cache()); });
  EXPECT_EQ(support::read_bytes(cache() / "thesis.tex"), "precious");
  fs::remove(cache() / "thesis.tex");
  // Files with names of a cache are kept too, unless their content marks them as parts of a cache.
  for (const char* name : {".notes.tmp", ".notes.weft-12.tmp", "outputs.txt", "lock", "manifest.json", "state.weft",
                           "frame_00007.weft", "scene.effective.toml"}) {
    support::write_bytes(cache() / name, "precious");
    expect_error(ExitCode::output_failed, std::string("holds ") + name, [&] { Lock(cache()).clear(); });
    EXPECT_EQ(support::read_bytes(cache() / name), "precious");
    fs::remove(cache() / name);
  }
  support::write_bytes(folder_ / "file", "precious");
  expect_error(ExitCode::output_failed, "cannot make the folder", [&] { Lock lock(folder_ / "file"); });
}

TEST_F(CacheFolder, ForeignFilesWithNamesOfFramesAreKept) {
  fill(3);
  const std::string frame = support::read_bytes(cache() / "frame_00001.weft");
  {
    const Lock lock(cache());
    Writer writer(lock, sample_.manifest(), "");
    support::write_bytes(cache() / "frame_00007.weft", "precious");
    expect_error(ExitCode::output_failed, "frame_00007.weft: was made by somebody else",
                 [&] { writer.add(*sample_.snapshot(7), {}); });
    writer.add(*sample_.snapshot(1), {});  // this frame was added before
  }
  EXPECT_NE(support::read_bytes(cache() / "frame_00001.weft"), frame);
  // frame_00007.weft is foreign, because the valid manifest beside it does not mention it.
  expect_error(ExitCode::output_failed, "holds frame_00007.weft", [&] { Lock(cache()).clear(); });
  EXPECT_EQ(support::read_bytes(cache() / "frame_00007.weft"), "precious");
  support::write_bytes(cache() / "frame_00007.weft", std::string(100, '\0'));  // as after a crash of the machine
  Lock(cache()).remove();
  EXPECT_FALSE(fs::exists(cache()));
}

TEST_F(CacheFolder, ClearingLeavesNothingOfIt) {
  fill(3);
  support::write_bytes(cache() / ".frame_00003.weft.weft-1234.tmp", "half a frame of a process that was killed");
  const Lock lock(cache());
  EXPECT_FALSE(lock.empty());
  lock.clear();
  EXPECT_TRUE(lock.empty());
  EXPECT_FALSE(is_cache(cache()));
  EXPECT_FALSE(fs::exists(cache() / ".frame_00003.weft.weft-1234.tmp"));
}

// State after a kill during clearing: the manifest is removed, and there is no foreign file.
TEST_F(CacheFolder, ThatWasClearedInPartIsClearedToTheEnd) {
  fill(3);
  fs::remove(cache() / kSceneFile);
  fs::remove(cache() / kManifestFile);
  support::write_bytes(cache() / "frame_00009.weft", "");
  Lock(cache()).remove();
  EXPECT_FALSE(fs::exists(cache()));
}

TEST_F(CacheFolder, FullDiskIsAnErrorAndLeavesNoHalfFile) {
  const Lock lock(cache());
  fs::create_directories(cache() / "surfaces.weft");  // cannot be replaced by a file
  Writer writer(lock, sample_.manifest(), "");
  expect_error(ExitCode::output_failed, "surfaces.weft", [&] { writer.add(*sample_.snapshot(0), {}); });
  EXPECT_FALSE(fs::exists(cache() / frame_file(0)));
}

}  // namespace
}  // namespace weft::cache
