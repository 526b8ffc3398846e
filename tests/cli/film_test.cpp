// A film with made-up stages: what the pipeline keeps and stops if a stage fails.
#include "tools/cli/film.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <mutex>
#include <new>
#include <set>
#include <stdexcept>

#include "tools/cli/failure.hpp"

namespace weft::cli {
namespace {

constexpr int kNever = std::numeric_limits<int>::max();

// Defines where the stages of a film fail, and records what they do.
struct Script {
  int simulation_fails_at = kNever, drawing_fails_at = kNever, writing_fails_at = kNever;
  bool painter_missing = false, source_missing = false, finish_fails = false;
  std::atomic<bool>* stop = nullptr;
  int stop_at = kNever;  // the stop is requested while this frame is simulated

  bool motion = false;
  std::vector<int> simulated, drawn, written;
  std::vector<int> before;  // for each drawn frame: the frame before it, -1 if there is none
  int finished = 0, alive = 0, writers_made = 0;
  std::mutex mutex;
};

[[noreturn]] void fail(ExitCode code, const char* text) {
  throw Error(code, "{}", text);
}

class InstanceCount {
 public:
  explicit InstanceCount(Script& script) : script_(script) { count(1); }
  ~InstanceCount() { count(-1); }
  InstanceCount(const InstanceCount&) = delete;
  InstanceCount& operator=(const InstanceCount&) = delete;

 private:
  void count(int change) {
    const std::lock_guard lock(script_.mutex);
    script_.alive += change;
  }
  Script& script_;
};

class Source : public FrameSource {
 public:
  explicit Source(Script& script) : script_(script), instance_count_(script) {}
  MadeFrame next() override {
    if (frame_ == script_.simulation_fails_at) fail(ExitCode::simulation_failed, "no convergence");
    if (frame_ == script_.stop_at) *script_.stop = true;
    script_.simulated.push_back(frame_);
    auto snapshot = std::make_shared<frame::FrameSnapshot>();
    snapshot->frame = frame_;
    simulation::FrameReport report;
    report.frame = frame_;
    report.steps = 10 * frame_;
    ++frame_;
    return {snapshot, std::move(report)};
  }

 private:
  Script& script_;
  InstanceCount instance_count_;
  int frame_ = 0;
};

class Painter : public FramePainter {
 public:
  explicit Painter(Script& script) : script_(script), instance_count_(script) {}
  Picture draw(const frame::FrameSnapshot& snapshot, const frame::FrameSnapshot* before) override {
    script_.before.push_back(before ? before->frame : -1);
    if (snapshot.frame == script_.drawing_fails_at) fail(ExitCode::internal, "context lost");
    script_.drawn.push_back(snapshot.frame);
    image::Image image(1, 1);
    image.rgb[0] = static_cast<std::uint8_t>(snapshot.frame);
    return {image, {}};
  }
  StageTime last_time() const override { return {0.25, 0.5}; }
  std::string description() const override { return "brush"; }

 private:
  Script& script_;
  InstanceCount instance_count_;
};

class Writer : public FrameWriter {
 public:
  explicit Writer(Script& script) : script_(script), instance_count_(script) {}
  void write(const frame::FrameSnapshot& snapshot, const Picture& picture) override {
    if (snapshot.frame == script_.writing_fails_at) fail(ExitCode::output_failed, "disk full");
    EXPECT_EQ(picture.image.rgb[0], snapshot.frame) << "picture and frame got mixed up";
    script_.written.push_back(snapshot.frame);
  }
  void finish() override {
    if (script_.finish_fails) fail(ExitCode::output_failed, "no space for the index");
    ++script_.finished;
  }

 private:
  Script& script_;
  InstanceCount instance_count_;
};

FilmResult play(Script& script, const FrameRange& wanted) {
  static std::atomic<bool> never{false};
  FilmParts parts{[&]() -> std::unique_ptr<FrameSource> {
                    if (script.source_missing) fail(ExitCode::asset_unreadable, "no mesh");
                    return std::make_unique<Source>(script);
                  },
                  [&]() -> std::unique_ptr<FramePainter> {
                    if (script.painter_missing) fail(ExitCode::internal, "no OpenGL");
                    return std::make_unique<Painter>(script);
                  },
                  [&](const std::string& description) -> std::unique_ptr<FrameWriter> {
                    EXPECT_EQ(description, "brush");
                    ++script.writers_made;
                    return std::make_unique<Writer>(script);
                  },
                  nullptr,
                  {},
                  {}};
  parts.motion = script.motion;
  Progress progress(Progress::Style::none, {});
  EventLog log("");
  FilmResult result =
      make_film(parts, {0, wanted.last() + 1, 1}, wanted, script.stop ? *script.stop : never, progress, log);
  EXPECT_EQ(script.alive, 0) << "a stage was left behind";
  EXPECT_EQ(result.frames.size(), script.simulated.size());
  EXPECT_EQ(static_cast<std::size_t>(result.written), script.written.size());
  return result;
}

std::vector<int> up_to(int end) {
  std::vector<int> frames;
  for (int frame = 0; frame < end; ++frame) frames.push_back(frame);
  return frames;
}

TEST(Film, TakesEveryFrameThroughAllStagesInOrder) {
  Script script;
  const FilmResult result = play(script, {0, 50, 1});
  EXPECT_EQ(script.simulated, up_to(50));
  EXPECT_EQ(script.drawn, up_to(50));
  EXPECT_EQ(script.written, up_to(50));
  EXPECT_EQ(script.finished, 1);
  EXPECT_TRUE(result.finished_output);
  EXPECT_FALSE(result.failure || result.interrupted);
  EXPECT_EQ(result.painter, "brush");
  for (int frame = 0; frame < 50; ++frame) {
    const FrameRecord& record = result.frames[frame];
    EXPECT_EQ(record.report.steps, 10 * frame);
    EXPECT_TRUE(record.written);
    EXPECT_EQ(record.render.wall_s, 0.25);
    EXPECT_EQ(record.render.cpu_s, 0.5);
  }
}

TEST(Film, SimulatesFramesThatAreNotWantedButDoesNotDrawThem) {
  Script script;
  const FilmResult result = play(script, {3, 10, 3});
  EXPECT_EQ(script.simulated, up_to(10));
  EXPECT_EQ(script.drawn, (std::vector<int>{3, 6, 9}));
  EXPECT_EQ(script.written, (std::vector<int>{3, 6, 9}));
  EXPECT_FALSE(result.frames[4].written);
  EXPECT_TRUE(result.frames[6].written);
}

TEST(Film, GivesThePainterTheFrameBeforeWhereMotionIsAskedFor) {
  const auto frames_before = [](bool motion, const FrameRange& wanted) {
    Script script;
    script.motion = motion;
    play(script, wanted);
    return script.before;
  };
  EXPECT_EQ(frames_before(false, {3, 10, 3}), (std::vector<int>{-1, -1, -1}));
  EXPECT_EQ(frames_before(true, {3, 10, 3}), (std::vector<int>{0, 3, 6})) << "also before the first that is wanted";
  EXPECT_EQ(frames_before(true, {0, 3, 1}), (std::vector<int>{-1, 0, 1}));
}

TEST(Film, EndsWithTheLastWantedFrame) {
  Script whole, shorter;
  play(whole, {0, 9, 4});
  EXPECT_EQ(whole.simulated, up_to(9));
  play(shorter, {0, 8, 4});  // stop after frame 4, the last requested one
  EXPECT_EQ(shorter.simulated, up_to(5));
}

TEST(Film, KeepsAllGoodFramesWhenTheSimulationFails) {
  Script script;
  script.simulation_fails_at = 17;
  const FilmResult result = play(script, {0, 50, 1});
  EXPECT_EQ(script.written, up_to(17));
  EXPECT_EQ(script.finished, 1);
  EXPECT_TRUE(result.finished_output);
  ASSERT_TRUE(result.failure);
  EXPECT_EQ(describe_failure(result.failure).code, ExitCode::simulation_failed);
  EXPECT_EQ(describe_failure(result.failure).text, "no convergence");
}

TEST(Film, FinishesWhatWasDrawnWhenDrawingFails) {
  Script script;
  script.drawing_fails_at = 5;
  const FilmResult result = play(script, {0, 1000, 1});
  EXPECT_EQ(script.written, up_to(5));
  EXPECT_EQ(script.finished, 1);
  EXPECT_LT(script.simulated.size(), 1000u) << "the simulation went on for nobody";
  EXPECT_EQ(describe_failure(result.failure).text, "context lost");
}

TEST(Film, StopsAllStagesWhenTheOutputFails) {
  Script script;
  script.writing_fails_at = 5;
  const FilmResult result = play(script, {0, 1000, 1});
  EXPECT_EQ(script.written, up_to(5));
  EXPECT_EQ(script.finished, 0) << "finished a file that could not be written";
  EXPECT_FALSE(result.finished_output);
  EXPECT_LT(script.simulated.size(), 1000u);
  EXPECT_EQ(describe_failure(result.failure).code, ExitCode::output_failed);
}

TEST(Film, TellsThatTheOutputCouldNotBeFinished) {
  Script script;
  script.finish_fails = true;
  script.simulation_fails_at = 3;  // the reported failure is that of the output stage
  const FilmResult result = play(script, {0, 10, 1});
  EXPECT_FALSE(result.finished_output);
  EXPECT_EQ(describe_failure(result.failure).text, "no space for the index");
}

TEST(Film, MakesNoOutputWithoutAPicture) {
  for (const bool source : {false, true}) {
    Script script;
    script.source_missing = source;
    script.painter_missing = !source;
    const FilmResult result = play(script, {0, 10, 1});
    EXPECT_EQ(script.writers_made, 0);
    EXPECT_FALSE(result.finished_output);
    EXPECT_EQ(describe_failure(result.failure).text, source ? "no mesh" : "no OpenGL");
  }
}

TEST(Film, StopFinishesTheFrameInHandAndEverythingBefore) {
  std::atomic<bool> stop{false};
  Script script;
  script.stop = &stop;
  script.stop_at = 12;
  const FilmResult result = play(script, {0, 1000, 1});
  EXPECT_EQ(script.written, up_to(13));
  EXPECT_EQ(script.finished, 1);
  EXPECT_TRUE(result.interrupted);
  EXPECT_FALSE(result.failure);
}

TEST(Film, StopBeforeTheStartStillGivesTheFirstFrame) {
  std::atomic<bool> stop{true};
  Script script;
  script.stop = &stop;
  const FilmResult result = play(script, {0, 10, 1});
  EXPECT_EQ(script.written, up_to(1));
  EXPECT_TRUE(result.interrupted);
}

TEST(Film, StopDuringTheLastFrameIsNoInterruption) {
  std::atomic<bool> stop{false};
  Script script;
  script.stop = &stop;
  script.stop_at = 9;
  EXPECT_FALSE(play(script, {0, 10, 1}).interrupted);
}

TEST(ReplayFailure, IsThatOfTheCacheUnlessMemoryRunsOut) {
  const auto failure = [](auto exception) { return describe_replay_failure(std::make_exception_ptr(exception), "c"); };
  EXPECT_EQ(failure(std::logic_error("no such vertex")).code, ExitCode::asset_unreadable);
  EXPECT_EQ(failure(std::logic_error("no such vertex")).text, "c: broken: unexpected: no such vertex");
  EXPECT_EQ(failure(std::bad_alloc()).code, ExitCode::internal);
  EXPECT_EQ(failure(std::bad_alloc()).text, "out of memory; a smaller scene or picture may fit");
  EXPECT_EQ(failure(Error(ExitCode::output_failed, "disk full")).code, ExitCode::output_failed);
}

}  // namespace
}  // namespace weft::cli
