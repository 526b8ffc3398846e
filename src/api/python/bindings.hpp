// The parts of the Python module. Each function below adds the classes and functions of one part to `module`.
#pragma once

#include <pybind11/pybind11.h>

#include <string_view>

namespace weft::python {

namespace py = pybind11;

/// Scenes, simulations, frames, and the exceptions of errors.hpp.
void bind_simulation(py::module_& module);
/// Models built in memory, with their materials.
void bind_model(py::module_& module);
/// Error estimates, frame caches, comparison of pictures.
void bind_tools(py::module_& module);
/// Drawing of frames.
void bind_drawing(py::module_& module);

/// The text as str. Bytes that are not UTF-8, such as in names of files, become surrogates, as in os.fsdecode().
py::str text_of(std::string_view text);

/// Releases the global interpreter lock (GIL) during a call, so that other threads of Python can run.
using ReleaseGil = py::call_guard<py::gil_scoped_release>;

}  // namespace weft::python
