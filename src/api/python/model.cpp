#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>
#include <weft/model.hpp>
#include <weft/scene.hpp>

#include "api/physics_library/material_members.hpp"
#include "api/physics_library/model_bytes.hpp"
#include "api/python/bindings.hpp"

namespace weft::python {
namespace {

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

// The rows of an array, which must have as many columns as `Row` has numbers. Raises ValueError if the array has a
// different shape or if an integer does not fit into the type of the numbers of `Row`.
template <class Row, class Array>
std::vector<Row> rows_of(const Array& array, const char* name) {
  constexpr std::size_t kColumns = std::tuple_size_v<Row>;
  if (array.ndim() != 2 || array.shape(1) != kColumns)
    throw py::value_error(fmt::format("{}: expected an array of n rows and {} columns, got shape ({})", name, kColumns,
                                      fmt::join(array.shape(), array.shape() + array.ndim(), ", ")));
  using Number = typename Row::value_type;
  std::vector<Row> rows(static_cast<std::size_t>(array.shape(0)));
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t k = 0; k < kColumns; ++k) {
      const auto value = array.data()[kColumns * i + k];
      rows[i][k] = static_cast<Number>(value);
      if (std::is_integral_v<Number> && static_cast<std::int64_t>(rows[i][k]) != static_cast<std::int64_t>(value))
        throw py::value_error(fmt::format("{}: expected numbers of vertices, got {}", name, value));
    }
  return rows;
}

using Integers = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

// Converts an array of integers. If the elements are not integers, for example the booleans of a mask, raises
// ValueError with the type of the elements.
Integers integers_of(const py::object& given, const char* name) {
  const py::array array = py::array::ensure(given);
  if (!array) throw py::value_error(fmt::format("{}: expected an array of integers", name));
  const char kind = array.dtype().kind();
  if (array.size() > 0 && kind != 'i' && kind != 'u')
    throw py::value_error(
        fmt::format("{}: expected integers, got {}", name, py::str(array.dtype()).cast<std::string>()));
  return Integers(array);
}

Mesh mesh_of(const Doubles& positions, const py::object& triangles) {
  return {rows_of<Vector>(positions, "positions"), rows_of<Triangle>(integers_of(triangles, "triangles"), "triangles")};
}

void add_cloth(Model& model, const std::string& name, const Doubles& positions, const py::object& triangles,
               const std::optional<Doubles>& rest, const std::variant<std::string, Material>& material,
               const Vector& velocity) {
  Cloth cloth{.name = name, .mesh = mesh_of(positions, triangles), .rest = {}, .material = {}, .velocity = velocity};
  if (rest) cloth.rest = rows_of<RestPoint>(*rest, "rest");
  const auto* fabric_name = std::get_if<std::string>(&material);
  cloth.material = fabric_name != nullptr ? fabric(*fabric_name) : std::get<Material>(material);
  model.cloths.push_back(std::move(cloth));
}

using Rotation = std::array<double, 4>;
using Key = std::tuple<double, Vector, Rotation>;

void add_body(Model& model, const std::string& name, const Doubles& positions, const py::object& triangles,
              const Vector& position, const Rotation& rotation, const std::vector<Key>& keys, double mass,
              const Vector& velocity, double friction, bool collide) {
  Body body{.name = name,
            .mesh = mesh_of(positions, triangles),
            .pose = {position, rotation},
            .keys = {},
            .mass = mass,
            .velocity = velocity,
            .friction = friction,
            .collide = collide};
  for (const auto& [time, place, turn] : keys) body.keys.push_back({time, {place, turn}});
  model.bodies.push_back(std::move(body));
}

void add_pin(Model& model, const std::string& cloth, const py::object& particles, const std::string& body,
             double release) {
  Pin pin{.cloth = cloth, .particles = {}, .body = body, .release = release};
  const Integers numbers = integers_of(particles, "particles");
  for (py::ssize_t i = 0; i < numbers.size(); ++i) {
    const std::int64_t number = numbers.data()[i];
    if (!std::in_range<int>(number))
      throw py::value_error(fmt::format("particles: expected numbers of particles, got {}", number));
    pin.particles.push_back(static_cast<int>(number));
  }
  model.pins.push_back(std::move(pin));
}

// Returns a tuple, not a list: assigning to an element of a list would only change a copy.
template <Vector Model::*member>
py::tuple vector_of(const Model& model) {
  return py::tuple(py::cast(model.*member));
}

template <Vector Model::*member>
void set_vector(Model& model, const Vector& value) {
  model.*member = value;
}

Material make_material(const py::kwargs& values) {
  Material material;
  const py::object self = py::cast(&material, py::return_value_policy::reference);
  for (const auto& [name, value] : values) self.attr(name) = value;
  return material;
}

using MaterialValues = std::array<double, library::kMaterialMembers.size()>;

MaterialValues values_of(const Material& material) {
  MaterialValues values{};
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = material.*library::kMaterialMembers[k].given;
  return values;
}

Material material_of(const MaterialValues& values) {
  Material material;
  for (std::size_t k = 0; k < values.size(); ++k) material.*library::kMaterialMembers[k].given = values[k];
  return material;
}

void bind_material(py::module_& module) {
  py::class_<Material>(module, "Material", "A fabric in continuum units; the defaults are cotton. SI units.")
      .def(py::init(&make_material),
           "Values by their names, such as Material(density=0.2); the others are those of cotton.")
      .def(py::pickle(&values_of, &material_of))
      .def_readwrite("density", &Material::density, "kg/m².")
      .def_readwrite("stretch_weft", &Material::stretch_weft, "N/m.")
      .def_readwrite("stretch_warp", &Material::stretch_warp, "N/m.")
      .def_readwrite("shear", &Material::shear, "N/m.")
      .def_readwrite("bend", &Material::bend, "N m.")
      .def_readwrite("max_stretch", &Material::max_stretch, "Extension at which threads lock; 0: never.")
      .def_readwrite("max_shear", &Material::max_shear, "Degrees at which threads lock; 0: never.")
      .def_readwrite("stretch_viscosity", &Material::stretch_viscosity, "N s/m.")
      .def_readwrite("shear_viscosity", &Material::shear_viscosity, "N s/m.")
      .def_readwrite("bend_viscosity", &Material::bend_viscosity, "N m s.")
      .def_readwrite("bend_friction", &Material::bend_friction, "N.")
      .def_readwrite("thickness", &Material::thickness, "Contact distance between two layers, m.")
      .def_readwrite("friction", &Material::friction, "Coulomb coefficient.")
      .def_readwrite("drag", &Material::drag, "Air resistance coefficient.");
  module.def("fabric", &fabric, py::arg("name"), "A measured fabric, such as \"silk\".");
}

}  // namespace

void bind_model(py::module_& module) {
  py::enum_<Method>(module, "Method")
      .value("implicit_euler", Method::implicit_euler)
      .value("implicit_midpoint", Method::implicit_midpoint)
      .value("bdf2", Method::bdf2);
  bind_material(module);
  py::class_<Model>(module, "Model",
                    "What is simulated, made in memory. Positions are arrays n x 3 (m), triangles m x 3, "
                    "counter-clockwise seen from the front. Values are checked when a Simulation is made.")
      .def(py::init<>())
      // copy.deepcopy() uses the pickled form, too.
      .def(py::pickle([](const Model& model) { return py::bytes(library::bytes_of(model)); },
                      [](const py::bytes& bytes) { return library::model_of(bytes.cast<std::string>()); }))
      .def_readwrite("fps", &Model::fps, "Frames per second.")
      .def_readwrite("step", &Model::step, "Maximum time step, s.")
      .def_readwrite("method", &Model::method)
      .def_readwrite("newton_tolerance", &Model::newton_tolerance,
                     "Error that the solver may leave, relative to the local truncation error.")
      .def_property("gravity", &vector_of<&Model::gravity>, &set_vector<&Model::gravity>, "m/s².")
      .def_property("wind", &vector_of<&Model::wind>, &set_vector<&Model::wind>, "m/s.")
      .def_readwrite("air_density", &Model::air_density, "kg/m³.")
      .def_readwrite("self_contact", &Model::self_contact, "Contact of cloth with itself and other cloths.")
      .def("add_cloth", &add_cloth, py::arg("name"), py::arg("positions"), py::arg("triangles"), py::kw_only(),
           py::arg("rest") = py::none(), py::arg_v("material", Material(), "Material()"),
           py::arg("velocity") = Vector{},
           "`rest`: places in the flat fabric along weft and warp, n x 2, m; without, the mesh is the rest shape. "
           "`material`: a Material, or the name of a fabric.")
      .def("add_body", &add_body, py::arg("name"), py::arg("positions"), py::arg("triangles"), py::kw_only(),
           py::arg("position") = Vector{}, py::arg("rotation") = Rotation{1, 0, 0, 0},
           py::arg("keys") = std::vector<Key>(), py::arg("mass") = 0.0, py::arg("velocity") = Vector{},
           py::arg("friction") = 0.3, py::arg("collide") = true,
           "`keys`: (time, position, rotation) through which it moves; rotations are unit quaternions w, x, y, z. "
           "`mass`: above 0, forces move it (kg).")
      .def("pin", &add_pin, py::arg("cloth"), py::arg("particles"), py::kw_only(), py::arg("body") = "",
           py::arg("release") = std::numeric_limits<double>::infinity(),
           "Hold particles where they start, or at a body, until `release` (s). A particle can be in one pin only. "
           "`particles`: their numbers; numpy.flatnonzero(mask) has those of a mask.");
}

}  // namespace weft::python
