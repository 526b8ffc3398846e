#include "api/python/bindings.hpp"

PYBIND11_MODULE(_weft, module) {
  weft::python::bind_model(module);
  weft::python::bind_simulation(module);
  weft::python::bind_tools(module);
  weft::python::bind_drawing(module);
}
