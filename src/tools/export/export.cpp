#include "tools/export/export.hpp"

#include <fmt/format.h>

#include <memory>
#include <optional>

#include "core/temporary_file.hpp"
#include "film/frame/cords.hpp"
#include "physics/mesh/ply.hpp"
#include "tools/export/blender.hpp"
#include "tools/export/gltf.hpp"
#include "tools/export/materials.hpp"
#include "tools/export/obj.hpp"
#include "tools/export/pc2.hpp"
#include "tools/export/seams.hpp"
#include "tools/export/usd.hpp"

namespace weft::exporter {
namespace {

using Path = std::filesystem::path;

Path frame_file(const Request& request, const std::string& object, int frame) {
  return request.folder / fmt::format("{}_{:05}.{}", object, frame, request.format == Format::ply ? "ply" : "obj");
}
Path shape_file(const Request& request, const std::string& object) {
  return request.folder / (object + ".obj");
}
Path cache_file(const Request& request, const std::string& object) {
  return request.folder / (object + ".pc2");
}
Path gltf_file(const Request& request) {
  return request.folder / (request.name + ".glb");
}

Path usd_file(const Request& request) {
  return request.folder / (request.name + (request.format == Format::usdz ? ".usdz" : ".usda"));
}
Path script_file(const Request& request) {
  return request.folder / (request.name + ".py");
}

// Positions in the axes that OBJ readers such as Blender assume by default: y up, front towards z.
std::vector<Vec3> with_y_up(const frame::FrameSnapshot& snapshot, std::size_t surface) {
  std::vector<Vec3> positions = snapshot.states[surface].positions;
  if (snapshot.stage->up.z() > 0.5)
    for (Vec3& x : positions) x = Vec3(x.x(), x.z(), -x.y());
  return positions;
}

void write_cut_ply(const Path& file, const frame::FrameSnapshot& snapshot, std::size_t number) {
  const frame::Surface& surface = *snapshot.surfaces[number];
  const std::vector<Vec3>& positions = snapshot.states[number].positions;
  const std::vector<float>& heat = snapshot.states[number].heat;
  const CutSurface cut = cut_at_seams(surface, materials_of(surface), positions.size());
  std::vector<Vec3> places;
  std::vector<float> values;
  for (const Index vertex : cut.vertex_of) {
    places.push_back(positions[static_cast<std::size_t>(vertex)]);
    if (!heat.empty()) values.push_back(heat[static_cast<std::size_t>(vertex)]);
  }
  mesh::write_ply(file, places, cut.triangles,
                  {.uv = cut.uv, .values = values, .values_name = name_of(snapshot.stage->heat)});
}

void write_meshes(const Request& request, const frame::FrameSnapshot& snapshot) {
  for (std::size_t s = 0; s < snapshot.surfaces.size(); ++s) {
    const frame::Surface& surface = *snapshot.surfaces[s];
    const Path file = frame_file(request, surface.name, snapshot.frame);
    if (request.format == Format::ply)
      write_cut_ply(file, snapshot, s);
    else
      write_obj(file, surface, snapshot.states[s].positions);
  }
}

/// Receives the frames in order and writes them in the requested format.
class Sink {
 public:
  explicit Sink(const Request& request) : request_(request) {}

  void add(const frame::FrameSnapshot& snapshot) {
    switch (request_.format) {
      case Format::ply:
      case Format::obj:
        return write_meshes(request_, snapshot);
      case Format::pc2:
        return add_to_caches(snapshot);
      case Format::gltf:
        return add_to_gltf(snapshot);
      case Format::usd:
      case Format::usdz:
        if (!usd_) usd_.emplace(snapshot, request_.name, request_.fps, aspect());
        return usd_->add(snapshot, views(snapshot));
      case Format::blender:
        if (!script_)
          script_.emplace(snapshot, request_.lighting, request_.name, request_.fps, request_.width, request_.height);
        script_->add(snapshot.frame, views(snapshot));
        return add_to_caches(snapshot);
    }
  }

  void finish() {
    for (const auto& cache : caches_) cache->commit();
    if (gltf_) gltf_->write(gltf_file(request_), request_.name, aspect());
    if (usd_) usd_->write(usd_file(request_));
    if (script_) write_file(script_file(request_), script_->text(), Flush::no);
  }

 private:
  double aspect() const { return static_cast<double>(request_.width) / request_.height; }

  std::vector<View> views(const frame::FrameSnapshot& snapshot) const {
    return request_.views ? request_.views(snapshot) : std::vector<View>{};
  }

  void add_to_caches(const frame::FrameSnapshot& snapshot) {
    const bool first = caches_.empty();
    const int step = request_.frames.size() > 1 ? request_.frames[1] - request_.frames[0] : 1;
    for (std::size_t s = 0; s < snapshot.surfaces.size(); ++s) {
      const frame::Surface& surface = *snapshot.surfaces[s];
      const std::vector<Vec3> positions = with_y_up(snapshot, s);
      if (first) {
        write_obj(shape_file(request_, surface.name), surface, positions);
        caches_.push_back(std::make_unique<PointCache>(cache_file(request_, surface.name), positions.size(),
                                                       snapshot.frame, step, request_.frames.size()));
      }
      caches_[s]->add(positions);
    }
  }

  void add_to_gltf(const frame::FrameSnapshot& snapshot) {
    if (gltf_)
      gltf_->add(snapshot, (snapshot.frame - request_.frames.front()) / request_.fps);
    else
      gltf_.emplace(snapshot);
    gltf_->add_views(views(snapshot));
  }

  const Request& request_;
  std::vector<std::unique_ptr<PointCache>> caches_;  // one per object
  std::optional<GltfFile> gltf_;
  std::optional<UsdFile> usd_;
  std::optional<BlenderScript> script_;
};

}  // namespace

std::vector<Path> files(const Request& request, const frame::FrameSnapshot& first) {
  if (request.format == Format::gltf) return {gltf_file(request)};
  if (request.format == Format::usd || request.format == Format::usdz) return {usd_file(request)};
  std::vector<Path> result;
  if (request.format == Format::blender) result.push_back(script_file(request));
  for (const auto& surface : first.surfaces) {
    if (request.format == Format::pc2 || request.format == Format::blender) {
      result.push_back(shape_file(request, surface->name));
      result.push_back(cache_file(request, surface->name));
      continue;
    }
    for (int frame : request.frames) result.push_back(frame_file(request, surface->name, frame));
  }
  return result;
}

std::vector<SharedFile> shared_files(const Request& request, const frame::FrameSnapshot& first) {
  std::vector<SharedFile> result;
  const bool beside =  // materials and pictures are in files beside the meshes
      request.format == Format::obj || request.format == Format::pc2 || request.format == Format::blender;
  if (!beside && request.format != Format::usd) return result;
  for (const auto& surface : first.surfaces) {
    if (!beside && !surface->visible) continue;
    if (beside) result.push_back({request.folder / (surface->name + ".mtl"), mtl_text(*surface)});
    for (const PictureFile& picture : materials_of(*surface).pictures)
      result.push_back({request.folder / picture.name, picture.png()});
  }
  return result;
}

bool write(const Request& request, const std::function<frame::SnapshotPtr(int)>& read,
           const std::function<bool()>& stop) {
  Sink sink(request);
  frame::Cords cords;
  for (int frame : request.frames) {
    if (stop()) return false;
    const frame::SnapshotPtr snapshot = cords.sweep(read(frame));
    if (frame == request.frames.front())
      for (const auto& [file, content] : shared_files(request, *snapshot)) write_file(file, content, Flush::no);
    sink.add(*snapshot);
  }
  sink.finish();
  return true;
}

}  // namespace weft::exporter
