// Caches with truncated files and changed bytes: each file is read unchanged, or refused with its name.
#include <gtest/gtest.h>

#include <random>

#include "cache/sample.hpp"
#include "film/cache/container.hpp"
#include "film/cache/names.hpp"
#include "film/cache/reader.hpp"
#include "film/cache/writer.hpp"
#include "support/test_folder.hpp"

namespace weft::cache {
namespace {

namespace fs = std::filesystem;

class DamagedCache : public support::TestFolder {
 protected:
  void SetUp() override {
    support::TestFolder::SetUp();
    const Lock lock(folder_ / "c");
    Writer writer(lock, sample_.manifest(), "[time]\n");
    for (const int k : {0, 1}) writer.add(*sample_.snapshot(k), sample_.report(k));
    writer.save_state(1, std::string(500, 's'));
  }

  /// Reads everything that a reader offers. Returns true if it read everything, false if it refused with the name of
  /// the broken file.
  bool read(const std::string& broken_file) const {
    try {
      const Reader reader(folder_ / "c");
      bool same = reader.frames().size() == 2 && reader.state() && reader.state()->bytes == std::string(500, 's');
      for (const int k : reader.frames()) {
        reader.verify(k);
        const CachedFrame cached = reader.read(k);
        for (std::size_t s = 0; s < 2; ++s)
          same = same && same_bits(cached.snapshot->states[s].positions, sample_.snapshot(k)->states[s].positions);
      }
      EXPECT_TRUE(same) << broken_file << " was read as something else";
      return true;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::asset_unreadable) << error.what();
      EXPECT_NE(std::string_view(error.what()).find(broken_file), std::string_view::npos) << error.what();
      return false;
    }
  }

  const Sample sample_;
  const std::vector<std::string> binary_files_{kSurfacesFile, frame_file(0), frame_file(1), kStateFile};
};

TEST_F(DamagedCache, CutShortAnywhereIsRefusedByName) {
  ASSERT_TRUE(read(""));
  for (const std::string& name : binary_files_) {
    const std::string whole = support::read_bytes(folder_ / "c" / name);
    for (std::size_t length = 0; length < whole.size(); ++length) {
      support::write_bytes(folder_ / "c" / name, whole.substr(0, length));
      EXPECT_FALSE(read(name)) << name << " cut to " << length;
    }
    support::write_bytes(folder_ / "c" / name, whole);
  }
}

TEST_F(DamagedCache, ManifestCutShortAnywhereIsRefusedByName) {
  const std::string whole = support::read_bytes(folder_ / "c" / kManifestFile);
  for (std::size_t length = 0; length + 2 < whole.size(); ++length) {  // the last two bytes are "}\n"
    support::write_bytes(folder_ / "c" / kManifestFile, whole.substr(0, length));
    EXPECT_FALSE(read(kManifestFile)) << "cut to " << length;
  }
}

/// Changes one to four bytes of a text.
std::string with_bytes_changed(std::string bytes, std::mt19937& random) {
  const std::string before = bytes;
  const std::size_t changes = 1 + random() % 4;
  for (std::size_t done = 0; done < changes || bytes == before; ++done)
    bytes[random() % bytes.size()] ^= static_cast<char>(1 + random() % 255);
  return bytes;
}

TEST_F(DamagedCache, NoneOfAHundredThousandChangesOfBytesIsMissed) {
  std::vector<std::string> whole;
  for (const std::string& name : binary_files_) whole.push_back(support::read_bytes(folder_ / "c" / name));
  std::mt19937 random(20261121);
  for (int trial = 0; trial < 100'000; ++trial) {
    const std::string broken = with_bytes_changed(whole[trial % 4], random);
    ASSERT_THROW(unpack(broken), std::runtime_error) << "trial " << trial;
  }
}

}  // namespace
}  // namespace weft::cache
