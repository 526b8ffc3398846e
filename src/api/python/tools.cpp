#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "api/library/scene_data.hpp"
#include "api/python/bindings.hpp"
#include "film/cache/reader.hpp"
#include "film/run_error/companions.hpp"
#include "tools/compare/files.hpp"

namespace weft::python {
namespace {

using library::with_public_errors;

/// The error of each quantity, by its name.
using Errors = std::map<std::string, double>;

Errors errors_of(const run_error::Errors& errors) {
  Errors result;
  for (std::size_t q = 0; q < run_error::kQuantities; ++q)
    result[std::string(run_error::name_of(static_cast<run_error::Quantity>(q)))] = errors[q];
  return result;
}

struct ErrorEstimate {
  Errors all;
  std::map<std::string, std::optional<Errors>> parts;  // by source of error; nullopt: not known
  bool chaotic = false, comparable = true;
  double cpu_s = 0;
};

ErrorEstimate estimate_error(const Scene& public_scene, bool with_mesh_error) {
  return with_public_errors([&] {
    const scene::Scene& scene = public_scene.data().scene;
    const run_error::ErrorEstimate estimate =
        run_error::estimate_error(scene, run_error::follow(scene), {.mesh = with_mesh_error});
    ErrorEstimate result{errors_of(estimate.all), {}, estimate.is_chaotic, !estimate.is_lower_bound(), estimate.cpu_s};
    for (const run_error::ErrorPart& part : estimate.parts)
      result.parts[std::string(name_of(part.source))] =
          part.missing.empty() ? std::optional(errors_of(part.errors)) : std::nullopt;
    return result;
  });
}

/// A frame cache on disk. Its frames have no velocities, strains and contact forces.
class Cache {
 public:
  explicit Cache(const std::filesystem::path& folder)
      // The absolute path stays valid after os.chdir().
      : reader_(with_public_errors(
            [&] { return std::make_unique<cache::Reader>(std::filesystem::current_path() / folder); })) {}

  std::vector<int> frames() const {
    return with_public_errors([&] { return reader_->frames(); });
  }
  double fps() const { return reader_->manifest().fps; }
  const std::filesystem::path& folder() const { return reader_->folder(); }
  Scene scene() const {
    return Scene::parse(with_public_errors([&] { return reader_->scene_text(); }), {},
                        reader_->folder() / (reader_->manifest().scene + ".toml"));
  }
  bool has(int number) const { return reader_->has(number); }
  /// Throws KeyError if the cache does not contain the frame.
  Frame frame(int number) const {
    if (!has(number)) throw py::key_error(fmt::format("{}: holds no frame {}", reader_->folder().string(), number));
    return with_public_errors([&] {
      cache::CachedFrame frame = reader_->read(number);
      Frame::Data data = library::view(std::move(frame.snapshot));
      data.report = library::report_of(frame.report);
      return library::make_frame(std::move(data));
    });
  }

 private:
  std::unique_ptr<const cache::Reader> reader_;
};

struct Difference {
  std::string outcome, problem;
  compare::FileComparison files;
};

Difference compare_files(const std::filesystem::path& reference, const std::filesystem::path& test,
                         const compare::Limits& limits, const std::filesystem::path& mask) {
  constexpr const char* kNames[] = {"same",        "within",  "differs",      "size",
                                    "frame count", "no test", "no reference", "unreadable"};
  Difference result;
  if (!exists(reference)) return {"no reference", reference.string() + ": no such file", {}};
  if (!exists(test)) return {"no test", test.string() + ": no such file", {}};
  result.files = with_public_errors(
      [&] { return compare::compare_files(reference, test, compare::limits_for(limits, reference, test), mask); });
  result.outcome = kNames[static_cast<std::size_t>(result.files.outcome)];
  result.problem = result.files.problem;
  return result;
}

void bind_difference(py::module_& module) {
  const auto figure = [](auto field) {
    return [field](const Difference& self) { return self.files.worst.figures.*field; };
  };
  using Figures = compare::Figures;
  py::class_<Difference>(module, "Difference",
                         "Differences of two pictures or videos; the values are those of the worst frame.")
      .def_readonly("outcome", &Difference::outcome,
                    "\"same\", \"within\" the limits, \"differs\", \"size\", \"frame count\", \"no test\", "
                    "\"no reference\" or \"unreadable\".")
      .def_property_readonly(
          "problem", [](const Difference& self) { return text_of(self.problem); },
          "Explanation in words, for the outcomes from \"size\" on.")
      .def_property_readonly("good",
                             [](const Difference& self) { return self.outcome == "same" || self.outcome == "within"; })
      .def_property_readonly("frames", [](const Difference& self) { return self.files.frames; })
      .def_property_readonly("worst_frame", [](const Difference& self) { return self.files.worst_frame; })
      .def_property_readonly("pixels", figure(&Figures::pixels))
      .def_property_readonly("pixels_changed", figure(&Figures::pixels_changed))
      .def_property_readonly("pixels_over", figure(&Figures::pixels_over))
      .def_property_readonly("pixels_at_edges", figure(&Figures::pixels_at_edges),
                             "Number of pixels_over at edges; without a pixel_budget, each counts as 1/40.")
      .def_property_readonly("largest", figure(&Figures::largest), "Largest difference of a channel, out of 255.")
      .def_property_readonly("ssim", figure(&Figures::ssim), "Mean structural similarity, 1 where equal.")
      .def_property_readonly("flip", figure(&Figures::flip), "Mean of the FLIP map, 0 where equal.")
      .def_property_readonly("spot", figure(&Figures::spot), "Largest value of the FLIP map.");
  const auto compare = [](const std::filesystem::path& reference, const std::filesystem::path& test,
                          int pixel_tolerance, std::optional<double> pixel_budget, std::optional<double> flip,
                          std::optional<double> spot, const std::optional<std::filesystem::path>& mask) {
    using Limit = std::pair<const char*, std::optional<double>>;
    for (const auto& [name, limit] : {Limit("pixel_tolerance", pixel_tolerance), Limit("pixel_budget", pixel_budget),
                                      Limit("flip", flip), Limit("spot", spot)})
      if (limit && !(*limit >= 0))
        throw std::invalid_argument(fmt::format("{}: expected 0 or more, got {:g}", name, *limit));
    return compare_files(reference, test, {pixel_tolerance, pixel_budget, flip, spot}, mask.value_or(""));
  };
  module.def(
      "compare", compare, py::arg("reference"), py::arg("test"), py::kw_only(),
      py::arg("pixel_tolerance") = compare::Limits{}.pixel_tolerance, py::arg("pixel_budget") = py::none(),
      py::arg("flip") = py::none(), py::arg("spot") = py::none(), py::arg("mask") = py::none(), ReleaseGil(),
      "Compare two pictures or videos as `weft diff` does. A limit that is None has the default of `weft diff`.");
}

}  // namespace

void bind_tools(py::module_& module) {
  py::class_<ErrorEstimate>(module, "ErrorEstimate",
                            "Estimated error of a run, compared with exactly solved short steps.")
      .def_readonly("all", &ErrorEstimate::all, "By quantity: position (m), velocity (m/s), energy (relative), ...")
      .def_readonly("parts", &ErrorEstimate::parts,
                    "The same for each source: time steps, solver, start, mesh; None if not known.")
      .def_readonly(
          "chaotic", &ErrorEstimate::chaotic,
          "Whether a start moved by 1 um changes the run as much as its errors do; then no setting reduces them.")
      .def_readonly("comparable", &ErrorEstimate::comparable,
                    "False if the true error may be larger, as for `comparable` of weft run --error --stats.")
      .def_readonly("cpu_s", &ErrorEstimate::cpu_s, "CPU seconds of the comparison runs.");
  module.def("estimate_error", &estimate_error, py::arg("scene"), py::arg("mesh") = false, ReleaseGil(),
             "Simulate the scene several times and estimate its error; with `mesh`, also that of the mesh.");
  py::class_<Cache>(module, "Cache", "A frame cache that `weft simulate` wrote or is still writing.")
      .def(py::init<const std::filesystem::path&>(), py::arg("folder"))
      .def_property_readonly("frames", &Cache::frames, "Numbers of the frames that the cache contains now.")
      .def_property_readonly("fps", &Cache::fps)
      .def_property_readonly("scene", &Cache::scene)
      .def("__repr__",
           [](const Cache& self) {
             return fmt::format("weft.Cache({})", py::repr(text_of(self.folder().string())).cast<std::string>());
           })
      .def("__getitem__", &Cache::frame, py::arg("number"), ReleaseGil(),
           "The frame of this number. Raises KeyError if the cache does not contain it now.")
      .def("__contains__", &Cache::has, py::arg("number"), "Whether the cache contains the frame of this number now.")
      .def(
          "__iter__",
          [](const py::object& self) {
            return py::module_::import("builtins").attr("map")(self.attr("__getitem__"), self.attr("frames"));
          },
          "The frames that the cache contains now, in order; each is read when it is needed.");
  bind_difference(module);
}

}  // namespace weft::python
