#include <assimp/version.h>
#include <fmt/format.h>
#include <png.h>
#include <tbb/version.h>
#include <unistd.h>

#include <CLI/Version.hpp>
#include <Eigen/Core>
#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <system_error>
#include <thread>

#include "core/parallel.hpp"
#include "core/version.hpp"
#include "film/render/renderer.hpp"
#include "film/video/encoder.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/standard_output.hpp"
#include "tools/cli/system_info.hpp"
#include "tools/cli/table.hpp"
#include "tools/compare/references.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 64, kHeight = 36;  // size of the test picture [pixels]

// A white square in front of the camera.
frame::FrameSnapshot test_scene() {
  auto surface = std::make_shared<frame::Surface>();
  surface->name = "square";
  surface->triangles = {{0, 1, 2}, {0, 2, 3}};
  surface->uv = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  surface->appearance.color = {1, 1, 1};
  frame::FrameSnapshot snapshot;
  snapshot.stage = std::make_shared<frame::Stage>();
  snapshot.surfaces = {surface};
  snapshot.states.resize(1);
  snapshot.states[0].positions = {{-0.5, 0, 0}, {0.5, 0, 0}, {0.5, 0, 1}, {-0.5, 0, 1}};
  snapshot.cameras = {frame::Camera{"front", {0, -3, 0.5}, {0, 0, 0.5}, 35}};
  return snapshot;
}

std::string libraries() {
  return fmt::format(
      "Eigen {}.{}.{}, TBB {}, libpng {}, assimp {}.{}.{}, fmt {}.{}.{}, CLI11 {}, nlohmann-json {}.{}.{}",
      EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION, TBB_runtime_version(), png_get_libpng_ver(nullptr),
      aiGetVersionMajor(), aiGetVersionMinor(), aiGetVersionPatch(), FMT_VERSION / 10000, FMT_VERSION / 100 % 100,
      FMT_VERSION % 100, CLI11_VERSION, NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
      NLOHMANN_JSON_VERSION_PATCH);
}

// The x86-64 psABI levels of the processor and of this build. Tests the main features of each level, since clang before
// 16 does not know the names of the levels.
std::string cpu_level() {
#if defined(__x86_64__)
  const bool v2 = __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt");
  const bool v3 =
      v2 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("fma");
  const bool v4 = v3 && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
  const char* has = v4 ? "x86-64-v4" : v3 ? "x86-64-v3" : v2 ? "x86-64-v2" : "x86-64";
#if defined(__AVX512F__)
  const char* built = "x86-64-v4";
#elif defined(__AVX2__)
  const char* built = "x86-64-v3";
#else
  const char* built = "x86-64";
#endif
  return fmt::format("level {}; this program is built for {}", has, built);
#else
  return "not an x86-64 processor";
#endif
}

// Runs tests, and collects their results for a table.
class Examination {
 public:
  void note(const std::string& what, const std::string& finding) { rows_.push_back({"ok", what, finding}); }

  /// Runs `test`, which returns its result as text. Returns false if `test` throws.
  bool test(const std::string& what, const std::function<std::string()>& test) {
    try {
      note(what, test());
      return true;
    } catch (...) {
      const Failure failure = describe_failure(std::current_exception());
      rows_.push_back({"FAILED", what, failure.text});
      if (code_ == ExitCode::ok) code_ = failure.code;
      return false;
    }
  }

  ExitCode code() const { return code_; }
  std::string text() const { return format_table(rows_); }

 private:
  std::vector<std::vector<std::string>> rows_;
  ExitCode code_ = ExitCode::ok;
};

void draw_test_picture(const DoctorOptions& options, image::Image& image, Examination& examination) {
  std::unique_ptr<render::Renderer> renderer;
  const bool made = examination.test("OpenGL", [&] {
    render::Settings settings;
    settings.width = kWidth;
    settings.height = kHeight;
    settings.quality = render::Quality::draft;
    settings.backend = options.backend;
    renderer = std::make_unique<render::Renderer>(settings);
    return renderer->description();
  });
  if (!made) return;
  examination.note(
      "", fmt::format("its pictures' class among references: {}", compare::machine_class(renderer->description())));
  examination.test("drawing", [&] {
    image = renderer->draw(test_scene());
    const std::uint8_t *middle = image.pixel(kWidth / 2, kHeight / 2), *corner = image.pixel(0, 0);
    if (std::equal(middle, middle + 3, corner)) {
      throw Error(ExitCode::internal, "a white square before the camera cannot be told from the background");
    }
    return fmt::format("a picture of {}x{} in {:.0f} ms", kWidth, kHeight, 1e3 * renderer->last_time().wall_s);
  });
}

std::string encode_test_video(const image::Image& image) {
  std::error_code error;
  const fs::path folder = fs::temp_directory_path(error);
  if (error)
    throw Error(ExitCode::output_failed, "no folder for temporary files: {}; set TMPDIR to one", error.message());
  const fs::path file = folder / fmt::format("weft_doctor_{}.mp4", ::getpid());
  video::Settings settings;
  settings.width = kWidth;
  settings.height = kHeight;
  video::Encoder encoder(file, settings);
  encoder.add(image);
  encoder.add(image);
  encoder.finish();
  const std::uintmax_t bytes = fs::file_size(file);
  fs::remove(file);
  return fmt::format("2 frames, {} bytes", bytes);
}

}  // namespace

ExitCode doctor(const DoctorOptions& options) {
  Examination examination;
  examination.note("weft", kVersion);
  examination.note("processor", cpu_model());
  examination.note("", cpu_level());
  examination.note("threads", fmt::format("{} of {} processors", thread_count(), std::thread::hardware_concurrency()));
  examination.note("libraries", libraries());
  image::Image image(kWidth, kHeight);
  draw_test_picture(options, image, examination);
  examination.test("encoder", [] { return video::encoder_description(); });
  examination.test("encoding", [&] { return encode_test_video(image); });
  print("{}", examination.text());
  return examination.code();
}

}  // namespace weft::cli
