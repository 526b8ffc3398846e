#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>
#include <weft/scene.hpp>
#include <weft/settings.hpp>
#include <weft/simulation.hpp>

#include "api/library/scene_data.hpp"
#include "api/python/bindings.hpp"

namespace weft::python {
namespace {

// Converts a value of a change to TOML text. Accepts scalars and arrays of numpy, too. Raises TypeError for values that
// TOML cannot express, such as None or a set. `path`: key of the change, for messages.
std::string toml_of(const py::handle& value, const std::string& path) {
  if (py::hasattr(value, "tolist")) return toml_of(value.attr("tolist")(), path);
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
  // The value becomes a plain number first, because a subclass may have a repr() that is not TOML.
  if (py::hasattr(value, "__index__")) return py::repr(value.attr("__index__")());
  if (py::hasattr(value, "__float__")) return py::repr(value.attr("__float__")());
  if (py::isinstance<py::dict>(value)) {
    std::vector<std::string> entries;
    for (const auto& [key, entry] : value.cast<py::dict>())
      entries.push_back(fmt::format("{} = {}", toml_of(key, path), toml_of(entry, path)));
    return fmt::format("{{ {} }}", fmt::join(entries, ", "));
  }
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
    std::vector<std::string> entries;
    for (const py::handle entry : value) entries.push_back(toml_of(entry, path));
    return fmt::format("[{}]", fmt::join(entries, ", "));
  }
  if (py::hasattr(value, "__fspath__")) return toml_of(value.attr("__fspath__")(), path);
  if (!py::isinstance<py::str>(value))
    throw py::type_error(
        fmt::format("{}: expected a number, a bool, a text, a path, or an array, list, tuple or dict of these, got {}",
                    path, Py_TYPE(value.ptr())->tp_name));
  // json.dumps() uses only escapes that TOML has, too. It does not escape U+007F, which TOML then refuses.
  return py::module_::import("json").attr("dumps")(value, py::arg("ensure_ascii") = false).cast<std::string>();
}

using Changes = std::optional<py::dict>;

std::vector<std::string> changes_of(const Changes& changes) {
  std::vector<std::string> texts;
  if (!changes) return texts;
  for (const auto& [key, value] : *changes) {
    if (!py::isinstance<py::str>(key))
      throw py::type_error(fmt::format("changes: expected texts as keys, got {}", Py_TYPE(key.ptr())->tp_name));
    const auto path = key.cast<std::string>();
    texts.push_back(fmt::format("{}={}", path, toml_of(value, path)));
  }
  return texts;
}

Scene load(const std::filesystem::path& file, const Changes& changes) {
  const std::vector<std::string> texts = changes_of(changes);
  const py::gil_scoped_release without_lock;
  return Scene::load(file, texts);
}

Scene parse(const std::string& toml, const Changes& changes, const std::filesystem::path& name) {
  const std::vector<std::string> texts = changes_of(changes);
  const py::gil_scoped_release without_lock;
  return Scene::parse(toml, texts, name);
}

Scene change(const Scene& scene, const py::dict& changes) {
  const std::vector<std::string> texts = changes_of(changes);
  const py::gil_scoped_release without_lock;
  return scene.with(texts);
}

/// An object of a frame, together with the frame, which owns the data of the object.
struct FrameObject {
  Frame frame;
  const Object* object;
};

FrameObject find_object(const Frame& frame, const std::string& name) {
  try {
    return {frame, &frame.object(name)};
  } catch (const std::out_of_range& error) {
    throw py::key_error(error.what());
  }
}

// A read-only array that views numbers of `owner` and keeps `owner` alive.
template <class Number>
py::array view(const Number* numbers, std::vector<py::ssize_t> shape, const py::object& owner) {
  py::array_t<Number> array(std::move(shape), numbers, owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

// An array with one row for each std::array of a span. `field`: the member of Object with this span.
template <auto field>
py::array rows(const py::object& self) {
  const auto& span = self.cast<const FrameObject&>().object->*field;
  using Row = typename std::remove_cvref_t<decltype(span)>::value_type;
  return view(reinterpret_cast<const typename Row::value_type*>(span.data()),
              {static_cast<py::ssize_t>(span.size()), static_cast<py::ssize_t>(std::tuple_size_v<Row>)}, self);
}

py::array strains(const py::object& self) {
  const auto span = self.cast<const FrameObject&>().object->strains;
  return view(span.data(), {static_cast<py::ssize_t>(span.size())}, self);
}

const char* kind_of(const FrameObject& object) {
  constexpr const char* kNames[] = {"cloth", "obstacle", "character", "rope"};
  return kNames[static_cast<std::size_t>(object.object->kind)];
}

// Bytes, because names of files may not be UTF-8.
using MistakeState = std::tuple<py::bytes, int, int, py::bytes, py::bytes, py::bytes>;

// Defines the exceptions. The attribute `mistakes` of SceneError lists the mistakes with their places.
void bind_errors(py::module_& module) {
  py::class_<Mistake>(module, "Mistake", "One mistake in a scene, with its place in the file.")
      .def_property_readonly(
          "file", [](const Mistake& mistake) { return text_of(mistake.file); },
          "Path of the scene file, as it was given; absolute if a Simulation raises the error.")
      .def_readonly("line", &Mistake::line,
                    "Line, counted from 1; 0 for mistakes that are not in the text of the file.")
      .def_readonly("column", &Mistake::column, "Column, counted from 1; 0 likewise.")
      .def_readonly("change", &Mistake::change,
                    "\"key=value\" of the change that contains the mistake; empty if the mistake is in the file.")
      .def_readonly("key", &Mistake::key, "Key, such as \"cloth.band.material.thickness\"; may be empty.")
      .def_property_readonly(
          "text", [](const Mistake& mistake) { return text_of(mistake.text); },
          "Description, such as \"expected > 0 m, got -0.001\".")
      // Worker processes send exceptions as pickles.
      .def(py::pickle(
          [](const Mistake& mistake) {
            return MistakeState(mistake.file, mistake.line, mistake.column, mistake.change, mistake.key, mistake.text);
          },
          [](const MistakeState& state) {
            const auto& [file, line, column, change, key, text] = state;
            return Mistake{file.cast<std::string>(), line, column, change.cast<std::string>(), key.cast<std::string>(),
                           text.cast<std::string>()};
          }));
  // These references are never released, because the interpreter may end before this library is unloaded.
  static const py::handle scene_error = py::exception<SceneError>(module, "SceneError", PyExc_ValueError).release();
  static const py::handle file_error = py::exception<FileError>(module, "FileError", scene_error).release();
  static const py::handle simulation_error =
      py::exception<SimulationError>(module, "SimulationError", PyExc_RuntimeError).release();
  scene_error.attr("__doc__") =
      "A scene has mistakes, or surfaces touch at the start. The text lists all mistakes; `mistakes` has their places.";
  file_error.attr("__doc__") = "A file that the scene names, or a frame cache, cannot be used.";
  simulation_error.attr("__doc__") =
      "The simulation cannot continue. The text names the frame, the time and the reason.";
  static const auto set = [](const py::handle& type, const SceneError& error) {
    py::object instance = type(text_of(error.what()));
    instance.attr("mistakes") = py::cast(error.mistakes());
    PyErr_SetObject(type.ptr(), instance.ptr());
  };
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const FileError& error) {
      set(file_error, error);
    } catch (const SceneError& error) {
      set(scene_error, error);
    } catch (const SimulationError& error) {
      PyErr_SetObject(simulation_error.ptr(), text_of(error.what()).ptr());
    } catch (const py::key_error& error) {
      PyErr_SetObject(PyExc_KeyError, text_of(error.what()).ptr());
    }
  });
}

// Pickled form of a scene: text, absolute path and changes.
using SceneState = std::tuple<std::string, std::filesystem::path, std::vector<std::vector<std::string>>>;

void bind_scene(py::module_& module) {
  py::class_<Scene>(module, "Scene", "A checked scene; it never changes.")
      .def(py::pickle(
          [](const Scene& scene) {
            return SceneState(scene.data().text, scene.data().scene.file, scene.data().changes);
          },
          [](const SceneState& state) {
            const auto& [text, file, changes] = state;
            return library::scene_of(text, file, file, changes);
          }))
      .def("with_changes", &change, py::arg("changes"),
           "This scene with further changes, such as {\"cloth.band.material.fabric\": \"silk\"}. A key replaces a "
           "key of the scene that excludes it: time.step replaces time.tolerance.")
      .def_property_readonly(
          "name", [](const Scene& scene) { return text_of(scene.name()); }, "Name of the file without its ending.")
      .def_property_readonly("fps", &Scene::fps, "Frames per second.")
      .def_property_readonly("frames", &Scene::frames, "Number of frames; frame k is the state at time k / fps.")
      .def_property_readonly("cloths", &Scene::cloths, "Names of the cloths.")
      .def_property_readonly("obstacles", &Scene::obstacles, "Names of the obstacles.")
      .def_property_readonly(
          "text", [](const Scene& scene) { return text_of(scene.text()); },
          "The scene as TOML text, with every default.");
  module.def("load", &load, py::arg("file"), py::arg("changes") = py::none(),
             "Read a scene file. Raises SceneError with all mistakes.");
  module.def("parse", &parse, py::arg("toml"), py::arg("changes") = py::none(), py::arg("name") = "scene.toml",
             "Read a scene from text, as load() does; relative paths start at the folder of `name`.");
}

void bind_frame(py::module_& module) {
  py::class_<EnclosedAir>(module, "EnclosedAir", "Air that a cloth encloses; SI units.")
      .def_readonly("cloth", &EnclosedAir::cloth)
      .def_readonly("volume", &EnclosedAir::volume)
      .def_readonly("pressure", &EnclosedAir::pressure);
  py::class_<Report>(module, "Report", "Cost and results of the computation of one frame; SI units.")
      .def_readonly("wall_s", &Report::wall_s, "Wall time of simulating this frame, s.")
      .def_readonly("cpu_s", &Report::cpu_s,
                    "CPU time of simulating this frame, s: that of the calling thread alone, without helper threads.")
      .def_readonly("steps", &Report::steps)
      .def_readonly("rejected_steps", &Report::rejected_steps)
      .def_readonly("newton_iterations", &Report::newton_iterations)
      .def_readonly("linear_iterations", &Report::linear_iterations)
      .def_readonly("near_pairs", &Report::near_pairs)
      .def_readonly("constraints", &Report::constraints)
      .def_readonly("min_distance", &Report::min_distance)
      .def_readonly("max_strain", &Report::max_strain)
      .def_readonly("stretch_ratio", &Report::stretch_ratio)
      .def_readonly("kinetic_energy", &Report::kinetic_energy)
      .def_readonly("potential_energy", &Report::potential_energy)
      .def_readonly("elastic_energy", &Report::elastic_energy)
      .def_readonly("air_energy", &Report::air_energy)
      .def_readonly("pin_work", &Report::pin_work)
      .def_readonly("error_estimate", &Report::error_estimate)
      .def_readonly("solver_error", &Report::solver_error)
      .def_readonly("pinched_pairs", &Report::pinched_pairs)
      .def_readonly("lagging_particles", &Report::lagging_particles)
      .def_readonly("enclosed_air", &Report::enclosed_air)
      .def_property_readonly("warnings", [](const Report& report) {
        py::list warnings;
        for (const std::string& warning : report.warnings) warnings.append(text_of(warning));
        return warnings;
      });
  py::class_<FrameObject>(module, "Object",
                          "A cloth or body in one frame. Arrays are read-only views; they stay valid.")
      .def_property_readonly("name", [](const FrameObject& self) { return std::string(self.object->name); })
      .def_property_readonly("kind", &kind_of, "\"cloth\", \"obstacle\", \"character\" or \"rope\".")
      .def_property_readonly("positions", &rows<&Object::positions>, "n x 3, m.")
      .def_property_readonly("velocities", &rows<&Object::velocities>,
                             "Velocities, n x 3, m/s; no rows for bodies and caches.")
      .def_property_readonly("contact_forces", &rows<&Object::contact_forces>,
                             "Contact force on each particle, friction included, at the end of the last time step: n x "
                             "3, N; zeros in the first frame of a simulation; no rows for bodies and caches.")
      .def_property_readonly("strains", &strains,
                             "Strain at each particle, n values: the largest |length / rest length - 1| of the threads "
                             "at it; no values for bodies and caches.")
      .def_property_readonly("rest", &rows<&Object::rest>, "Rest coordinates along weft and warp, n x 2, m.")
      .def_property_readonly("triangles", &rows<&Object::triangles>, "Vertex numbers of the triangles, m x 3.");
  py::class_<Frame>(module, "Frame", "One frame; it never changes. frame[\"band\"] is its object with this name.")
      .def_property_readonly("number", &Frame::number, "Counted from 0.")
      .def_property_readonly("time", &Frame::time, "s.")
      .def_property_readonly("report", &Frame::report, py::return_value_policy::reference_internal)
      .def_property_readonly("objects",
                             [](const Frame& self) {
                               std::vector<FrameObject> objects;
                               for (const Object& object : self.objects()) objects.push_back({self, &object});
                               return objects;
                             })
      .def("__getitem__", &find_object, py::arg("name"))
      .def(
          "__contains__",
          [](const Frame& self, const std::string& name) {
            return std::ranges::any_of(self.objects(), [&](const Object& object) { return object.name == name; });
          },
          py::arg("name"), "Whether an object has this name.");
}

/// A simulation that threads of Python share. All members are called with the global interpreter lock held; advance()
/// releases the lock while it computes. So another thread, or a signal handler within advance(), may call members while
/// advance() computes.
class GuardedSimulation {
 public:
  GuardedSimulation(const std::variant<Model, Scene>& of, const std::vector<std::string>& driven,
                    const py::bytes& state)
      : simulation_(make(of, {driven, state})), frame_(simulation_.frame()) {}

  const Frame& frame() const { return frame_; }
  Frame advance() {
    const Use now(is_used_);
    {
      const py::gil_scoped_release without_lock;
      simulation_.advance();
    }
    return frame_ = simulation_.frame();
  }
  void move(const std::string& obstacle, const Vector& position, const std::array<double, 4>& rotation) {
    const Use now(is_used_);
    simulation_.move(obstacle, {position, rotation});
  }
  void set_weather(const Vector& gravity, const Vector& wind) {
    const Use now(is_used_);
    simulation_.set_weather(gravity, wind);
  }
  py::bytes save() {
    const Use now(is_used_);
    return simulation_.save();
  }

 private:
  static Simulation make(const std::variant<Model, Scene>& of, const SimulationOptions& options) {
    const py::gil_scoped_release without_lock;
    return std::visit([&](const auto& given) { return Simulation(given, options); }, of);
  }

  // Throws if the simulation is already in use.
  class Use {
   public:
    explicit Use(bool& is_used) : is_used_(is_used) {
      if (is_used_) throw std::runtime_error("expected a simulation that rests, got one that computes a frame");
      is_used_ = true;
    }
    ~Use() { is_used_ = false; }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    bool& is_used_;
  };

  Simulation simulation_;
  Frame frame_;
  bool is_used_ = false;
};

// Makes Ctrl-C interrupt a frame. The interpreter runs signal handlers only in the main thread.
void check_signals() {
  using Clock = std::chrono::steady_clock;
  const auto main = py::module_::import("threading").attr("main_thread")().attr("ident").cast<unsigned long>();
  set_interrupt_check([main, next = Clock::time_point()]() mutable {
    if (PyThread_get_thread_ident() != main || Clock::now() < next) return;
    const py::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    next = Clock::now() + std::chrono::milliseconds(50);
  });
}

}  // namespace

py::str text_of(std::string_view text) {
  PyObject* made = PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "surrogateescape");
  if (made == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(made);
}

void bind_simulation(py::module_& module) {
  bind_errors(module);
  bind_scene(module);
  bind_frame(module);
  py::class_<GuardedSimulation>(
      module, "Simulation",
      "Simulates a Scene or a Model frame by frame. One thread at a time uses it; while it computes a frame, other "
      "threads can read the one before, and anything else raises RuntimeError.")
      .def(py::init<const std::variant<Model, Scene>&, const std::vector<std::string>&, const py::bytes&>(),
           py::arg("scene"), py::kw_only(), py::arg("driven") = std::vector<std::string>(),
           py::arg("state") = py::bytes(),
           "`scene`: a Scene or a Model. `driven`: names of the obstacles that move() will move. `state`: bytes "
           "returned by save(), to continue from there.")
      .def_property_readonly("frame", &GuardedSimulation::frame, py::return_value_policy::copy, "The current frame.")
      .def("advance", &GuardedSimulation::advance,
           "Compute the next frame. If it raises SimulationError, or KeyboardInterrupt in the main thread, the current "
           "frame stays as it was.")
      .def("move", &GuardedSimulation::move, py::arg("obstacle"), py::arg("position"),
           py::arg("rotation") = std::array<double, 4>{1, 0, 0, 0},
           "During the next frame, move a driven obstacle to this pose (m; unit quaternion w, x, y, z) at constant "
           "velocity. Pins that follow it move with it.")
      .def(
          "set_weather", &GuardedSimulation::set_weather, py::arg("gravity"), py::arg("wind"),
          "From the next frame on, gravity (m/s²) and the velocity of the air (m/s), in place of those of the scene or "
          "model and their keys. Gusts and fans of a scene stay.")
      .def("save", &GuardedSimulation::save, "The complete state, from which later frames follow.");
  module.def("set_threads", &set_threads, py::arg("threads"),
             "Set the maximum number of threads that compute; 0: all processors.");
  module.attr("__version__") = version();
  check_signals();
  set_warning_handler([](std::string_view text) {
    const py::gil_scoped_acquire lock;
    py::module_::import("warnings").attr("warn")(text_of(text));
  });
}

}  // namespace weft::python
