#include "film/render/ray_scene.hpp"

#include <embree3/rtcore.h>
#include <tbb/task_arena.h>

#include <deque>
#include <new>

#include "core/error.hpp"
#include "film/render/painted_mesh.hpp"

namespace weft::render {
namespace {

/// A pseudorandom number in [0, 1) for a ray and a triangle (the hash PCG of Jarzynski and Olano, "Hash Functions for
/// GPU Rendering", 2020).
float random_fraction(unsigned ray, unsigned triangle) {
  unsigned state = (ray * 747796405u + triangle * 2891336453u + 2891336453u);
  state = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return static_cast<float>(((state >> 22u) ^ state) >> 8) / 16777216.0f;
}

/// Opacity of a triangle at barycentric coordinates u, v: that of the mesh, times that of the
/// picture if the picture cuts holes.
float opacity_at(const DrawnMesh& mesh, std::size_t triangle, float u, float v) {
  if (mesh.holes == nullptr) return mesh.opacity;
  const auto ranges = mesh.holes->ranges();
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    if (triangle < ranges[i].first || triangle >= ranges[i].first + ranges[i].count) continue;
    const Opacity* opacity = mesh.holes->opacity(i);
    if (opacity == nullptr) break;
    const auto& [a, b, c] = mesh.triangles[triangle];
    const Eigen::Vector2f place =
        (1 - u - v) * mesh.holes->place(i, a) + u * mesh.holes->place(i, b) + v * mesh.holes->place(i, c);
    return mesh.opacity * opacity->at(place, 1);
  }
  return mesh.opacity;
}

/// Filter that Embree calls for hits on surfaces that do not stop all light. It rejects the hits of random rays, which
/// then pass through the surface.
void reject_random_hits(const RTCFilterFunctionNArguments* args) {
  const auto& mesh = *static_cast<const DrawnMesh*>(args->geometryUserPtr);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] != -1) continue;
    const unsigned triangle = RTCHitN_primID(args->hit, args->N, i);
    const float opacity =
        opacity_at(mesh, triangle, RTCHitN_u(args->hit, args->N, i), RTCHitN_v(args->hit, args->N, i));
    if (random_fraction(RTCRayN_id(args->ray, args->N, i), triangle) >= opacity) args->valid[i] = 0;
  }
}

void put(const Lanes& from, float* to) {
  Eigen::Map<Lanes, Eigen::Aligned32>{to} = from;
}

void put(const Rays& rays, RTCRay8& to) {
  put(rays.origin.x, to.org_x), put(rays.origin.y, to.org_y), put(rays.origin.z, to.org_z);
  put(rays.direction.x, to.dir_x), put(rays.direction.y, to.dir_y), put(rays.direction.z, to.dir_z);
  put(Lanes::Zero(), to.tnear), put(rays.end, to.tfar), put(Lanes::Zero(), to.time);
  for (unsigned lane = 0; lane < kLanes; ++lane) to.mask[lane] = ~0u;
  for (unsigned lane = 0; lane < kLanes; ++lane) to.id[lane] = rays.seed * kLanes + lane;
  for (unsigned lane = 0; lane < kLanes; ++lane) to.flags[lane] = 0;
}

}  // namespace

// Selects the Embree kernels when the program is compiled, so that hits do not depend on the processor that runs it.
#ifdef __AVX2__
constexpr const char* kKernels = "isa=avx2";
#else
constexpr const char* kKernels = "isa=sse2";
#endif

struct RayScene::Tree {
  RTCDevice device = rtcNewDevice(kKernels);
  RTCScene scene = nullptr;
  std::deque<DrawnMesh> filtered;  // meshes with holes or an opacity below 1, for reject_random_hits()

  ~Tree() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }

  void check() const {
    switch (const RTCError error = rtcGetDeviceError(device)) {
      case RTC_ERROR_NONE:
        return;
      case RTC_ERROR_OUT_OF_MEMORY:
        throw std::bad_alloc();
      default:
        throw Error(ExitCode::internal, "Embree: error {}", static_cast<int>(error));
    }
  }

  template <class Number>
  Number* allocate(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t count) const {
    void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, 3 * sizeof(Number), count);
    if (buffer == nullptr) throw std::bad_alloc();
    return static_cast<Number*>(buffer);
  }

  void add(const DrawnMesh& mesh, unsigned number) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* point = allocate<float>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.positions.size());
    for (const Vec3& position : mesh.positions)
      for (const double coordinate : position) *point++ = static_cast<float>(coordinate);
    auto* corner = allocate<unsigned>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.triangles.size());
    for (const Triangle& triangle : mesh.triangles)
      for (const Index vertex : triangle) *corner++ = static_cast<unsigned>(vertex);
    if (mesh.opacity < 1 || mesh.holes != nullptr) {
      rtcSetGeometryUserData(geometry, &filtered.emplace_back(mesh));
      rtcSetGeometryOccludedFilterFunction(geometry, reject_random_hits);
      rtcSetGeometryIntersectFilterFunction(geometry, reject_random_hits);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, number);
    rtcReleaseGeometry(geometry);
  }
};

RayScene::RayScene() : tree_(std::make_unique<Tree>()) {
  if (tree_->device == nullptr)
    throw Error(ExitCode::internal, "Embree: no device, error {}", static_cast<int>(rtcGetDeviceError(nullptr)));
}
RayScene::~RayScene() = default;

void RayScene::build(std::span<const DrawnMesh> meshes) {
  if (tree_->scene != nullptr) rtcReleaseScene(tree_->scene);
  tree_->filtered.clear();
  tree_->scene = rtcNewScene(tree_->device);
  for (std::size_t i = 0; i < meshes.size(); ++i)
    if (!meshes[i].triangles.empty()) tree_->add(meshes[i], static_cast<unsigned>(i));
  // Builds with one thread, so that the hierarchy does not depend on the number of threads. (Embree's own setting of
  // the number of threads would limit all parallel loops of the process.)
  tbb::task_arena one(1);
  one.execute([&] { rtcCommitScene(tree_->scene); });
  tree_->check();
}

Lanes RayScene::blocked(const Rays& rays) const {
  RTCRay8 query;
  put(rays, query);
  alignas(32) Mask wanted = rays.wanted;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcOccluded8(wanted.data(), tree_->scene, &context, &query);
  // Embree sets `tfar` of blocked rays to minus infinity.
  return (Eigen::Map<const Lanes, Eigen::Aligned32>(query.tfar) < 0).select(Lanes::Ones(), Lanes::Zero());
}

Hits RayScene::nearest(const Rays& rays) const {
  RTCRayHit8 query;
  put(rays, query.ray);
  for (int lane = 0; lane < kLanes; ++lane)
    query.hit.geomID[lane] = query.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
  alignas(32) Mask wanted = rays.wanted;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect8(wanted.data(), tree_->scene, &context, &query);
  Hits hits;
  for (int lane = 0; lane < kLanes; ++lane) {
    const bool met = query.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID;
    hits.mesh[lane] = met ? static_cast<int>(query.hit.geomID[lane]) : Hits::kNone;
    hits.triangle[lane] = met ? query.hit.primID[lane] : 0;
    hits.distance[lane] = met ? query.ray.tfar[lane] : 0;
    const Eigen::Vector3f normal(query.hit.Ng_x[lane], query.hit.Ng_y[lane], query.hit.Ng_z[lane]);
    hits.normal.set(lane, met ? Eigen::Vector3f(normal.normalized()) : Eigen::Vector3f::UnitZ());
  }
  return hits;
}

}  // namespace weft::render
