#include "tools/compare/references.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

#include "compare/pictures.hpp"
#include "film/image/png.hpp"
#include "support/test_folder.hpp"
#include "tools/compare/acceptance.hpp"

namespace weft::compare {
namespace {

constexpr const char* kGl =
    "OSMesa (libOSMesa.so.8); Mesa/X.org; llvmpipe (LLVM 15.0.6, 256 bits); OpenGL 4.5 (Core Profile) Mesa 22.3.6";

class References : public support::TestFolder {
 protected:
  void write(const std::string& name, std::uint8_t level, const image::Metadata& metadata = {}) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    image::write_png(folder_ / name, plain(16, 16, level, level, level), metadata);
  }

  int level(const std::string& name) const { return image::read_png(folder_ / name).rgb[0]; }

  std::string found(const std::string& name, const std::string& machine) const {
    const auto file = find_reference(folder_ / "ref", name, machine);
    return file ? file->lexically_relative(folder_ / "ref").string() : "none";
  }

  void accept(const std::string& reference, const std::string& test, const std::string& reason) const {
    Acceptance plan = Acceptance::plan(folder_ / reference, folder_ / test, std::filesystem::path(test).filename());
    plan.reason = reason;
    plan.user = "me";
    changed_ = plan.carry_out();
  }

  std::vector<std::string> log_lines(const std::string& log) const {
    std::istringstream text(support::read_bytes(folder_ / log));
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line);) {
      if (line.starts_with("| 2")) lines.push_back(line.substr(line.find(" | ", 2) + 3));  // without the date
    }
    return lines;
  }

  mutable bool changed_ = false;
};

TEST(MachineClass, IsMesaAndTheWidthOfVectors) {
  EXPECT_EQ(machine_class(kGl), "mesa-22.3-256bit");
  EXPECT_EQ(machine_class("EGL; Mesa; llvmpipe (LLVM 19.1.7, 512 bits); OpenGL 4.5 Mesa 25.0.1"), "mesa-25.0-512bit");
  EXPECT_EQ(machine_class("EGL; AMD; Radeon (navi22, LLVM 15.0.6); OpenGL 4.6 Mesa 23.1.4"), "mesa-23.1");
  EXPECT_EQ(machine_class("something else"), "");
}

TEST_F(References, ClassComesBeforeDefaultBeforeTheFolderItself) {
  write("ref/a.png", 1);
  write("ref/b.png", 1);
  write("ref/c.png", 1);
  write("ref/default/a.png", 2);
  write("ref/default/b.png", 2);
  write("ref/mesa-22.3-256bit/a.png", 3);
  EXPECT_EQ(found("a.png", "mesa-22.3-256bit"), "mesa-22.3-256bit/a.png");
  EXPECT_EQ(found("b.png", "mesa-22.3-256bit"), "default/b.png");
  EXPECT_EQ(found("c.png", "mesa-22.3-256bit"), "c.png");
  EXPECT_EQ(found("a.png", "mesa-9.9"), "default/a.png");
  EXPECT_EQ(found("a.png", ""), "default/a.png");
  EXPECT_EQ(found("d.png", ""), "none");
  EXPECT_EQ(reference_names(folder_ / "ref", ""), (std::vector<std::string>{"a.png", "b.png", "c.png"}));
}

TEST_F(References, PicturesTellTheClassOfTheirMachine) {
  write("a.png", 1, {{"gl", kGl}});
  write("b.png", 1);
  EXPECT_EQ(machine_class_of(folder_ / "a.png"), "mesa-22.3-256bit");
  EXPECT_EQ(machine_class_of(folder_ / "b.png"), "");
  EXPECT_EQ(machine_class_of(folder_ / "none.png"), "");
  EXPECT_EQ(machine_class_of(folder_, {"b.png", "none.png", "a.png"}), "mesa-22.3-256bit") << "b.png is of others";
  EXPECT_EQ(machine_class_of(folder_, {"b.png"}), "");
  EXPECT_EQ(machine_class_of(folder_, {}), "");
}

TEST_F(References, AllPicturesAndVideosBelowAFolderCountButHiddenOnes) {
  write("out/b.png", 1);
  write("out/a.png", 1);
  write("out/folder/c.png", 1);
  write("out/.being_written/d.png", 1);
  support::write_bytes(folder_ / "out/accepted.md", "");
  support::write_bytes(folder_ / "out/.a.png.123.tmp", "");
  support::write_bytes(folder_ / "out/.hidden.png", "");
  support::write_bytes(folder_ / "out/v.mp4", "");
  EXPECT_EQ(comparable_names(folder_ / "out"), (std::vector<std::string>{"a.png", "b.png", "folder/c.png", "v.mp4"}));
}

TEST_F(References, HaveFoldersOfTheirOwnBelowThoseOfTheClasses) {
  write("ref/mesa-22.3-256bit/front/a.png", 1);
  write("ref/default/front/a.png", 2);
  write("ref/default/front/b.png", 2);
  write("ref/mesa-lab/c.png", 3);
  write("ref/mesa-1.2/d.png", 4);
  EXPECT_EQ(reference_names(folder_ / "ref", machine_class(kGl)),
            (std::vector<std::string>{"front/a.png", "front/b.png", "mesa-lab/c.png"}));
  EXPECT_EQ(found("front/a.png", machine_class(kGl)), "mesa-22.3-256bit/front/a.png");
  EXPECT_EQ(found("front/a.png", ""), "default/front/a.png");
}

TEST_F(References, AcceptedPictureReplacesTheOneThatDiffWouldTake) {
  write("ref/default/a.png", 10);
  write("ref/mesa-22.3-256bit/a.png", 20);
  write("out/a.png", 30, {{"gl", kGl}});
  accept("ref", "out/a.png", "brighter");
  EXPECT_TRUE(changed_);
  EXPECT_EQ(level("ref/mesa-22.3-256bit/a.png"), 30);
  EXPECT_EQ(level("ref/default/a.png"), 10);
  EXPECT_EQ(support::read_bytes(folder_ / "out/a.png"), support::read_bytes(folder_ / "ref/mesa-22.3-256bit/a.png"));
}

TEST_F(References, NewPictureGoesToDefaultWhereThatIsUsedElseIntoTheFolder) {
  write("ref/default/a.png", 10);
  write("out/b.png", 30);
  accept("ref", "out/b.png", "new");
  EXPECT_EQ(level("ref/default/b.png"), 30);
  accept("fresh", "out/b.png", "new");
  EXPECT_EQ(level("fresh/b.png"), 30);
  accept("ref/mesa-22.3-256bit", "out/b.png", "this class only");
  EXPECT_EQ(level("ref/mesa-22.3-256bit/b.png"), 30);
  accept("other/name.png", "out/b.png", "one file");
  EXPECT_EQ(level("other/name.png"), 30);
}

// All 256 pixels differ by 10 levels. The log states this in the same words as `weft diff`.
TEST_F(References, EachChangeIsALineOfTheLogWithHashesDifferenceAndReason) {
  write("ref/a.png", 10);
  write("out/a.png", 20);
  const std::string old_hash = short_hash(folder_ / "ref/a.png"), new_hash = short_hash(folder_ / "out/a.png");
  accept("ref", "out/a.png", "darker | by\ndesign");
  write("out/b.png", 20);
  accept("ref", "out/b.png", "second");
  const auto lines = log_lines("ref/accepted.md");
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_TRUE(
      lines[0].starts_with("a.png | " + old_hash + " | " + new_hash + " | 256 pixels by up to 10 levels, SSIM "))
      << lines[0];
  EXPECT_TRUE(lines[0].ends_with(" | darker \\| by design | me |")) << lines[0];
  EXPECT_EQ(lines[1], "b.png | none | " + short_hash(folder_ / "out/b.png") + " | new | second | me |");
}

TEST_F(References, EachOfManyThatAreAcceptedAtOnceHasItsLine) {
  constexpr int kProcesses = 4, kPictures = 6;
  for (int i = 0; i < kProcesses * kPictures; ++i) write(fmt::format("out/{}.png", i), 20);
  std::vector<pid_t> children;
  for (int p = 0; p < kProcesses; ++p) {
    children.push_back(::fork());
    if (children.back() != 0) continue;
    for (int i = 0; i < kPictures; ++i) accept("ref", fmt::format("out/{}.png", p * kPictures + i), "at once");
    ::_exit(0);
  }
  for (const pid_t child : children) ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  EXPECT_EQ(log_lines("ref/accepted.md").size(), std::size_t{kProcesses * kPictures});
}

TEST_F(References, HashIsThatOfSha256sum) {
  support::write_bytes(folder_ / "abc", "abc");  // FIPS 180-4, first example
  EXPECT_EQ(short_hash(folder_ / "abc"), "ba7816bf8f01cfea");
}

TEST_F(References, EqualPicturesChangeNeitherReferenceNorLog) {
  write("ref/a.png", 10);
  write("out/a.png", 10, {{"gl", kGl}});
  const std::string before = support::read_bytes(folder_ / "ref/a.png");
  accept("ref", "out/a.png", "nothing");
  EXPECT_FALSE(changed_);
  EXPECT_EQ(support::read_bytes(folder_ / "ref/a.png"), before);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "ref/accepted.md"));
}

TEST_F(References, WhatIsNoWholePictureIsNotAccepted) {
  write("ref/a.png", 10);
  write("out/a.png", 20);
  const std::string bytes = support::read_bytes(folder_ / "out/a.png");
  support::write_bytes(folder_ / "out/a.png", bytes.substr(0, bytes.size() - 5));
  support::write_bytes(folder_ / "out/a.txt", "text");
  const auto plan = [&](const char* test) { Acceptance::plan(folder_ / "ref", folder_ / test, test); };
  support::expect_error(ExitCode::asset_unreadable, "ends too early", [&] { plan("out/a.png"); });
  support::expect_error(ExitCode::asset_unreadable, "does not exist", [&] { plan("out/b.png"); });
  support::expect_error(ExitCode::usage, "expected a picture", [&] { plan("out/a.txt"); });
  support::expect_error(ExitCode::usage, "expected a picture", [&] { plan("out"); });
  EXPECT_EQ(level("ref/a.png"), 10);
}

}  // namespace
}  // namespace weft::compare
