// Content of USD files and of scripts for Blender, parsed by small readers in this file. tests/export/blender_test.py
// runs a script in Blender itself.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <regex>

#include "export/made_frames.hpp"
#include "film/image/color.hpp"
#include "film/image/picture.hpp"
#include "tools/export/zip.hpp"

namespace weft::exporter {
namespace {

// Two triangular panels, sewn along their common edge, which move between frames 3 and 4; a static bent sheet; a hidden
// surface.
class Staged : public MadeFrames {
 protected:
  void SetUp() override {
    MadeFrames::SetUp();
    frame::Surface dress;
    dress.name = "red-dress";
    dress.crease_angle = 180;
    dress.triangles = {{0, 1, 2}, {0, 2, 3}};
    dress.paint_uv = {{Vec2(0, 0), Vec2(1, 0), Vec2(1, 1)}, {Vec2(5, 5), Vec2(6, 6), Vec2(5, 6)}};
    dress.appearance.color = {0.8, 0.2, 0.1};
    dress.appearance.back_color = {0.1, 0.5, 0.6};
    dress.appearance.roughness = 0.7;
    dress.parts = {{"front", dress.appearance}, {"back", {}}};
    dress.part_of_triangle = {0, 1};
    frame::Surface body;
    body.name = "red_dress";  // becomes the same name in USD
    body.kind = frame::ObjectKind::character;
    body.triangles = {{0, 1, 2}, {0, 2, 3}};
    add_surfaces({dress, body});
    request_.name = "1st film";
    request_.fps = 23.976;
    request_.width = 400;
    request_.height = 200;
    request_.frames = {2, 3, 4};
    request_.views = [](const frame::FrameSnapshot& shown) {
      View view{"eye", Eigen::Matrix4d::Identity(), 90};
      view.world_from_view.col(3).head<3>() = Vec3(shown.frame, 2, 3);
      return std::vector{view};
    };
    request_.lighting.lights.push_back({.name = "sun", .intensity = 2});
  }

  static std::vector<Vec3> points(int k) { return {{1.0 / 3, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, k < 4 ? 0.1 : 0.25}}; }

  std::vector<std::vector<Vec3>> positions(int k) const override {
    return {points(k), {{0, 0, 0}, {1, 0, 1}, {1, 1, 0}, {0, 1, 1}}};
  }

  std::string written(Format format, const std::string& name) {
    request_.format = format;
    EXPECT_TRUE(exporter::write(request_, [&](int k) { return snapshot(k); }));
    return support::read_bytes(request_.folder / name);
  }

  /// The data in the script for Blender.
  nlohmann::json written_film() {
    const std::string text = written(Format::blender, "1st film.py");
    const auto start = text.find("r\"\"\"") + 4;
    return nlohmann::json::parse(text.substr(start, text.find("\"\"\"", start) - start));
  }
};

/// The text between the braces after `head`.
std::string block(const std::string& text, const std::string& head) {
  const auto start = text.find(head);
  if (start == std::string::npos) return "";
  std::size_t at = text.find('{', start), depth = 0;
  const std::size_t open = at;
  for (; at < text.size(); ++at) {
    depth += text[at] == '{' ? 1 : 0;
    if (text[at] == '}' && --depth == 0) break;
  }
  return text.substr(open, at - open);
}

std::vector<double> numbers(const std::string& text) {
  const std::regex number("-?[0-9][0-9.e+-]*");
  std::vector<double> found;
  for (std::sregex_iterator i(text.begin(), text.end(), number), end; i != end; ++i)
    found.push_back(std::stod(i->str()));
  return found;
}

/// The numbers of `name = ...` up to the end of the line.
std::vector<double> value(const std::string& text, const std::string& name) {
  const auto start = text.find(name + " = ");
  EXPECT_NE(start, std::string::npos) << name;
  return numbers(text.substr(start + name.size(), text.find('\n', start) - start - name.size()));
}

TEST_F(Staged, UsdFilesHoldPointsOfEachFrameAtItsTimeCode) {
  const std::string text = written(Format::usd, "1st film.usda");
  EXPECT_TRUE(text.starts_with("#usda 1.0\n"));
  for (const char* line : {"startTimeCode = 2\n", "endTimeCode = 4\n", "timeCodesPerSecond = 23.976\n",
                           "metersPerUnit = 1\n", "upAxis = \"Z\"\n", "defaultPrim = \"_1st_film\"\n"})
    EXPECT_NE(text.find(line), std::string::npos) << line;
  EXPECT_EQ(text.find("hidden"), std::string::npos) << "what is not visible is left out";
  const std::string dress = block(text, "def Mesh \"red_dress\"");
  const std::string samples = block(dress, "points.timeSamples");
  std::smatch sample;
  for (int k : request_.frames) {
    ASSERT_TRUE(std::regex_search(samples, sample, std::regex(fmt::format("\n +{}: (\\[.*\\])", k)))) << k;
    const std::vector<double> came = numbers(sample[1]);
    ASSERT_EQ(came.size(), 12U);
    for (std::size_t i = 0; i < came.size(); ++i)
      EXPECT_NEAR(came[i], points(k)[i / 3][static_cast<Index>(i % 3)], kSingle) << k;
  }
  EXPECT_EQ(block(text, "def Mesh \"red_dress_2\"").find("timeSamples"), std::string::npos) << "it stands still";
}

TEST_F(Staged, UsdFilesHavePanelsNormalsAndMaterials) {
  const std::string text = written(Format::usd, "1st film.usda");
  const std::string dress = block(text, "def Mesh \"red_dress\""), body = block(text, "def Mesh \"red_dress_2\"");
  EXPECT_EQ(value(dress, "faceVertexIndices"), (std::vector<double>{0, 1, 2, 0, 2, 3}));
  const std::vector<double> st = value(dress, "primvars:st"), at = value(dress, "primvars:st:indices");
  ASSERT_EQ(at.size(), 6U);
  for (std::size_t c = 0; c < 6; ++c) {
    const Vec2& uv = surfaces_[0]->paint_uv[c / 3][c % 3];
    const auto place = static_cast<std::size_t>(at[c]);
    EXPECT_EQ(Vec2(st[2 * place], st[2 * place + 1]), uv) << c;
  }
  // Cloth has one normal per vertex. A bent sheet with a sharp crease has one normal per corner: that of its triangle.
  EXPECT_EQ(value(dress, "normal3f[] normals").size(), 12U);
  const std::vector<double> normals = value(body, "normal3f[] normals");
  ASSERT_EQ(normals.size(), 18U);
  const Vec3 first = Vec3(1, 0, 1).cross(Vec3(1, 1, 0)).normalized();
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_LT((Vec3(normals[3 * c], normals[3 * c + 1], normals[3 * c + 2]) - first).norm(), 1e-5);
  const std::string front = block(text, "def Material \"red_dress_0_front\"");
  const std::vector<double> color = value(front, "inputs:diffuseColor");
  const Vec3 expected = image::linear_from_srgb(surfaces_[0]->parts[0].appearance.color);
  EXPECT_LT((Vec3(color[0], color[1], color[2]) - expected).norm(), 1e-6);
  EXPECT_EQ(value(front, "inputs:roughness"), std::vector{0.7});
  EXPECT_EQ(value(block(dress, "def GeomSubset \"red_dress_1_back\""), "indices"), std::vector{1.0});
  EXPECT_NE(block(dress, "def GeomSubset \"red_dress_1_back\"").find("</_1st_film/materials/red_dress_1_back>"),
            std::string::npos);
}

TEST_F(Staged, UsdMaterialsOfPartsHaveNamesThatNoObjectHas) {
  frame::Surface& body = *surfaces_[1];
  body.name = "red_dress_0_front";
  const std::string text = written(Format::usd, "1st film.usda");
  const std::regex material("def Material \"(\\w+)\"");
  std::vector<std::string> names;
  for (std::sregex_iterator i(text.begin(), text.end(), material), end; i != end; ++i) names.push_back((*i)[1]);
  EXPECT_EQ(names,
            (std::vector<std::string>{"red_dress", "red_dress_0_front_2", "red_dress_1_back", "red_dress_0_front"}));
  const std::string dress = block(text, "def Mesh \"red_dress\"");
  EXPECT_NE(block(dress, "def GeomSubset \"red_dress_0_front_2\"").find("</_1st_film/materials/red_dress_0_front_2>"),
            std::string::npos);
}

TEST_F(Staged, UsdMaterialsShowThePictureOfAPart) {
  frame::Surface& dress = *surfaces_[0];
  frame::Paint& paint = dress.parts[1].appearance.paint;
  paint.texture = std::make_shared<frame::Texture>(frame::Texture{1, 1, {10, 20, 30, 255}});
  paint.texture_from_uv << 0, 2, 1, -3, 0, 1;
  paint.alpha = frame::Paint::Alpha::over_color;
  const std::string text = written(Format::usd, "1st film.usda");
  const std::string back = block(text, "def Material \"red_dress_1_back\"");
  EXPECT_NE(back.find("asset inputs:file = @red-dress.png@"), std::string::npos);
  EXPECT_NE(back.find("diffuseColor.connect = </_1st_film/materials/red_dress_1_back/picture.outputs:rgb>"),
            std::string::npos);
  EXPECT_EQ(image::read_picture(request_.folder / "red-dress.png").rgba, (std::vector<std::uint8_t>{10, 20, 30, 255}));
  // The file has the texture coordinates of the picture and, in addition, weft and warp.
  const std::string mesh = block(text, "def Mesh \"red_dress\"");
  const std::vector<double> st = value(mesh, "primvars:st"), at = value(mesh, "primvars:st:indices");
  const std::vector<double> pattern = value(mesh, "primvars:weft_warp");
  for (std::size_t c = 3; c < 6; ++c) {
    const Vec2& uv = dress.paint_uv[1][c % 3];
    const auto place = 2 * static_cast<std::size_t>(at[c]);
    EXPECT_EQ(Vec2(st[place], st[place + 1]), Vec2(2 * uv.y() + 1, 1 - 3 * uv.x())) << c;
    EXPECT_EQ(Vec2(pattern[place], pattern[place + 1]), uv) << c;
  }
  const std::string packed = written(Format::usdz, "1st film.usdz");
  EXPECT_NE(packed.find(support::read_bytes(request_.folder / "red-dress.png")), std::string::npos);
}

TEST_F(Staged, PackedUsdFilesHoldTheTextAsItIsAtAMultipleOf64Bytes) {
  // With names of these lengths, the padding before the text takes every possible length.
  for (request_.name = "a"; request_.name.size() < 68; request_.name += 'a') {
    const std::string inner = request_.name + ".usda", name = request_.name + ".usdz";
    const std::string bytes = written(Format::usdz, name);
    const auto number = [&](std::size_t at, int size) {
      std::uint64_t value = 0;
      for (int i = size; i-- > 0;)
        value = value << 8 | static_cast<unsigned char>(bytes.at(at + static_cast<std::size_t>(i)));
      return value;
    };
    const std::size_t end = bytes.size() - 22, directory = number(end + 16, 4);
    ASSERT_EQ(number(end, 4), 0x06054b50U);
    ASSERT_EQ(number(directory, 4), 0x02014b50U);
    EXPECT_EQ(number(end + 12, 4), end - directory);
    const std::size_t local = number(directory + 42, 4);
    ASSERT_EQ(number(local, 4), 0x04034b50U);
    EXPECT_EQ(number(local + 8, 2), 0U) << "stored";
    EXPECT_EQ(bytes.substr(local + 30, inner.size()), inner);
    const std::size_t extra = number(local + 28, 2), data = local + 30 + inner.size() + extra;
    EXPECT_EQ(data % 64, 0U) << name;
    EXPECT_TRUE(extra == 0 || number(local + 30 + inner.size() + 2, 2) == extra - 4) << extra;
    EXPECT_EQ(data + number(local + 22, 4), directory);
    EXPECT_EQ(bytes.substr(data, directory - data), written(Format::usd, inner));
  }
}

// The check value of CRC-32 (as in Ethernet), for the digits 1 to 9, is 0xcbf43926.
TEST_F(Staged, PackedFilesHaveTheSumThatArchivesCheck) {
  write_stored(folder_ / "a.zip", {{"digits", "123456789"}});
  EXPECT_EQ(support::read_bytes(folder_ / "a.zip").substr(14, 4), "\x26\x39\xf4\xcb");
}

TEST_F(Staged, UsdCamerasStandAndSeeAsTheFramesDo) {
  const std::string camera = block(written(Format::usd, "1st film.usda"), "def Camera \"eye\"");
  const double aperture = value(camera, "verticalAperture")[0], focal = value(camera, "focalLength")[0];
  EXPECT_NEAR(2 * std::atan(aperture / 2 / focal), std::numbers::pi / 2, 1e-8);
  EXPECT_NEAR(value(camera, "horizontalAperture")[0] / aperture, 2, 1e-8);
  const std::vector<double> samples = numbers(block(camera, "transform.timeSamples"));
  ASSERT_EQ(samples.size(), 3U * 17);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(samples[17 * k], 2.0 + static_cast<double>(k));
    // The last row of the matrix contains the position.
    EXPECT_EQ(Vec3(samples[17 * k + 13], samples[17 * k + 14], samples[17 * k + 15]), Vec3(samples[17 * k], 2, 3));
  }
}

TEST_F(Staged, TheScriptForBlenderNamesAllThatItLoads) {
  auto film = written_film();
  EXPECT_EQ(film["fps"], 23.976);
  EXPECT_EQ(film["size"], nlohmann::json({400, 200}));
  EXPECT_EQ(film["frames"], nlohmann::json({2, 3, 4}));
  const auto none = nlohmann::json::object();
  EXPECT_EQ(film["objects"][2],
            nlohmann::json({{"name", "hidden"}, {"visible", false}, {"pictures", none}, {"backs", none}}));
  nlohmann::json& backs = film["objects"][0]["backs"];
  EXPECT_EQ(backs.size(), 1u);  // the back of the other part equals its front
  EXPECT_NEAR(backs["red-dress"][1].get<double>(), std::pow((0.5 + 0.055) / 1.055, 2.4), 1e-9);
  EXPECT_EQ(film["cameras"][0]["frames"][1], nlohmann::json({90, {1, 0, 0, 3}, {0, 1, 0, 2}, {0, 0, 1, 3}}));
  EXPECT_NEAR(film["lights"][0]["strength"].get<double>(), 2 * (1 - request_.lighting.sky_fraction), 1e-12);
  for (const char* file : {"red-dress.obj", "red-dress.pc2", "hidden.pc2"})
    EXPECT_TRUE(std::filesystem::exists(request_.folder / file)) << file;
}

TEST_F(Staged, PanelsThatDifferInTheirBacksAloneHaveBothInTheScriptForBlender) {
  frame::Surface& dress = *surfaces_[0];
  dress.parts[1].appearance = dress.appearance;
  dress.parts[1].appearance.back_color = {0, 0, 1};
  auto film = written_film();
  nlohmann::json& backs = film["objects"][0]["backs"];
  ASSERT_EQ(backs.size(), 2u) << backs;
  EXPECT_NEAR(backs["red-dress"][1].get<double>(), std::pow((0.5 + 0.055) / 1.055, 2.4), 1e-9);
  EXPECT_NEAR(backs["red-dress_1_back"][2].get<double>(), 1, 1e-9);
  EXPECT_NE(support::read_bytes(request_.folder / "red-dress.obj").find("usemtl red-dress_1_back"), std::string::npos);
}

// Blender keeps 63 bytes of the name of a material, with ".001" behind it if the name is in use.
TEST_F(Staged, MaterialsOfLongNamesKeepTheirNumberInTheScriptForBlender) {
  frame::Surface& dress = *surfaces_[0];
  dress.name = std::string(64, 'a');
  dress.parts = {{std::string(40, 'p'), dress.appearance}, {std::string(40, 'p'), dress.appearance}};
  for (std::size_t p = 0; p < 2; ++p) dress.parts[p].appearance.back_color = {0, 0, 0.5 + 0.1 * static_cast<double>(p)};
  const auto film = written_film();
  const nlohmann::json& backs = film["objects"][0]["backs"];
  ASSERT_EQ(backs.size(), 2u) << backs;
  for (std::size_t p = 0; p < 2; ++p) {
    const std::string name = std::string(48, 'a') + fmt::format("_{}_pppppppp", p);
    EXPECT_EQ(name.size(), 59u);
    EXPECT_TRUE(backs.contains(name)) << backs;
    EXPECT_NE(support::read_bytes(request_.folder / (dress.name + ".obj")).find("usemtl " + name + "\n"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace weft::exporter
