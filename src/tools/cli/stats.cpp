#include "tools/cli/stats.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/version.hpp"
#include "tools/cli/error_report.hpp"
#include "tools/cli/system_info.hpp"

namespace weft::cli {
namespace {

using Json = nlohmann::ordered_json;

const char* kind_name(frame::ObjectKind kind) {
  switch (kind) {
    case frame::ObjectKind::cloth:
      return "cloth";
    case frame::ObjectKind::obstacle:
      return "obstacle";
    case frame::ObjectKind::character:
      return "character";
    case frame::ObjectKind::rope:
      return "rope";
  }
  return "unknown";
}

// Returns null if the value is infinite or NaN, which JSON does not have.
Json finite(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json totals_json(const RunReport& report) {
  const StageTotals totals = total_times(report.frames);
  const StepTotals steps = total_steps(report.frames);
  return {{"simulate", totals.simulate.wall_s},
          {"collide", totals.collide.wall_s},
          {"forces", totals.forces.wall_s},
          {"preconditioner", totals.preconditioner.wall_s},
          {"linear", totals.linear.wall_s},
          {"render", totals.render.wall_s},
          {"encode", totals.encode.wall_s},
          {"meshes", totals.meshes.wall_s},
          {"cache", report.cache.wall_s},
          {"setup", report.setup.wall_s},
          {"wall", report.wall_s},
          {"simulate_cpu", totals.simulate.cpu_s},
          {"collide_cpu", totals.collide.cpu_s},
          {"forces_cpu", totals.forces.cpu_s},
          {"preconditioner_cpu", totals.preconditioner.cpu_s},
          {"linear_cpu", totals.linear.cpu_s},
          {"render_cpu", totals.render.cpu_s},
          {"encode_cpu", totals.encode.cpu_s},
          {"meshes_cpu", totals.meshes.cpu_s},
          {"cache_cpu", report.cache.cpu_s},
          {"setup_cpu", report.setup.cpu_s},
          {"cpu", report.cpu_s},
          {"steps", steps.accepted},
          {"rejected_steps", steps.rejected},
          {"inexact_steps", steps.inexact},
          {"error_estimate_m", steps.error_estimate},
          {"solver_error_m", steps.solver_error}};
}

}  // namespace

std::size_t count_particles(const std::vector<frame::ObjectInfo>& objects) {
  std::size_t particles = 0;
  for (const frame::ObjectInfo& object : objects)
    if (object.kind == frame::ObjectKind::cloth || object.kind == frame::ObjectKind::rope) particles += object.vertices;
  return particles;
}

StageTotals total_times(const std::vector<FrameRecord>& frames) {
  StageTotals totals;
  for (const FrameRecord& record : frames) {
    totals.simulate += record.report.simulate;
    totals.collide += record.report.collide;
    totals.forces += record.report.forces;
    totals.preconditioner += record.report.preconditioner;
    totals.linear += record.report.linear;
    totals.render += record.render;
    totals.encode += record.encode;
    totals.meshes += record.meshes;
  }
  return totals;
}

StepTotals total_steps(const std::vector<FrameRecord>& frames) {
  StepTotals totals;
  for (const FrameRecord& record : frames) {
    totals.accepted += record.report.steps;
    totals.rejected += record.report.rejected_steps;
    totals.inexact += record.report.inexact_steps;
    totals.error_estimate += record.report.error_estimate;
    totals.solver_error += record.report.solver_error;
  }
  return totals;
}

Json frame_json(const FrameRecord& record) {
  const simulation::FrameReport& report = record.report;
  Json enclosed = Json::array();
  for (const simulation::EnclosedAir& air : report.enclosed)
    enclosed.push_back(
        {{"cloth", air.cloth}, {"volume_m3", finite(air.volume)}, {"pressure_pa", finite(air.pressure)}});
  Json attachments = Json::array();
  for (const simulation::AttachmentLoad& one : report.attachments)
    attachments.push_back({{"name", one.name}, {"load_n", finite(one.load)}, {"holds", one.holds}});
  return {{"frame", report.frame},
          {"time_s", report.time},
          {"written", record.written},
          {"simulate_ms", 1e3 * report.simulate.wall_s},
          {"collide_ms", 1e3 * report.collide.wall_s},
          {"render_ms", 1e3 * record.render.wall_s},
          {"encode_ms", 1e3 * record.encode.wall_s},
          {"simulate_cpu_ms", 1e3 * report.simulate.cpu_s},
          {"collide_cpu_ms", 1e3 * report.collide.cpu_s},
          {"render_cpu_ms", 1e3 * record.render.cpu_s},
          {"encode_cpu_ms", 1e3 * record.encode.cpu_s},
          {"steps", report.steps},
          {"rejected_steps", report.rejected_steps},
          {"inexact_steps", report.inexact_steps},
          {"error_estimate_m", finite(report.error_estimate)},
          {"solver_error_m", finite(report.solver_error)},
          {"newton_iterations", report.newton_iterations},
          {"linear_iterations", report.linear_iterations},
          {"proximities", report.proximities},
          {"constraints", report.constraints},
          {"min_distance_m", finite(report.min_distance)},
          {"max_strain", finite(report.max_strain)},
          {"stretch_share", finite(report.stretch_ratio)},
          {"kinetic_energy_j", finite(report.kinetic_energy)},
          {"elastic_energy_j", finite(report.elastic_energy)},
          {"air_energy_j", finite(report.air_energy)},
          {"potential_energy_j", finite(report.potential_energy)},
          {"pin_work_j", finite(report.pin_work)},
          {"solver_work_j", finite(report.solver_work)},
          {"pinched_pairs", report.pinched_pairs},
          {"lagging_particles", report.lagging_particles},
          {"enclosed_air", std::move(enclosed)},
          {"attachments", std::move(attachments)}};
}

Json stats_json(const RunReport& report) {
  Json objects = Json::array();
  for (const frame::ObjectInfo& object : report.objects) {
    objects.push_back({{"name", object.name},
                       {"kind", kind_name(object.kind)},
                       {"vertices", object.vertices},
                       {"faces", object.faces}});
  }
  Json frames = Json::array();
  for (const FrameRecord& record : report.frames) frames.push_back(frame_json(record));
  Json json{{"scene", report.scene},
            {"scene_file", report.scene_file},
            {"scene_hash", fmt::format("{:016x}", report.scene_hash)},
            {"version", kVersion},
            {"threads", report.threads},
            {"cpu", cpu_model()},
            {"gl", report.gl},
            {"exit_code", static_cast<int>(report.exit_code)},
            {"message", report.message},
            {"warnings", report.warnings},
            {"notes", report.notes},
            {"output", report.output},
            {"cache_bytes", report.cache_bytes},
            {"width", report.width},
            {"height", report.height},
            {"fps", report.fps},
            {"objects", std::move(objects)},
            {"particles", report.particles},
            {"totals", totals_json(report)},
            {"peak_memory_bytes", report.peak_memory},
            {"frames", std::move(frames)}};
  if (report.error) json["error"] = error_json(*report.error);
  return json;
}

}  // namespace weft::cli
