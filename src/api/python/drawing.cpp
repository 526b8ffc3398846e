#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "api/library/scene_data.hpp"
#include "api/python/bindings.hpp"
#include "film/render/renderer.hpp"

namespace weft::python {
namespace {

using library::with_public_errors;

render::Quality quality_of(const std::string& name) {
  if (name == "draft") return render::Quality::draft;
  if (name == "preview") return render::Quality::preview;
  if (name == "final") return render::Quality::final;
  throw std::invalid_argument("quality: expected \"draft\", \"preview\" or \"final\", got \"" + name + "\"");
}

/// Draws frames as `weft run` does, with one difference: if the scene does not place the camera, the renderer places it
/// for the first frame that it draws, not for the whole run. Only the thread that created the renderer can use it.
class Renderer {
 public:
  Renderer(const Scene& scene, const std::string& quality) {
    const scene::Render& render = scene.data().scene.render;
    render::Settings settings;
    settings.width = render.width;
    settings.height = render.height;
    settings.camera = render.camera;
    settings.quality = quality_of(quality);
    renderer_ = with_public_errors([&] { return std::make_unique<render::Renderer>(settings); });
  }

  py::array_t<std::uint8_t> draw(const Frame& frame, const std::optional<Frame>& before) {
    if (std::this_thread::get_id() != thread_)
      throw std::runtime_error("expected a call from the thread that made the renderer, got one from another");
    if (!frame.data().snapshot || (before && !before->data().snapshot))
      throw py::value_error("expected a frame of a scene, got one of a Model, which has no looks");
    auto image = std::make_unique<image::Image>();
    {
      const py::gil_scoped_release release_gil;
      const frame::FrameSnapshot* previous = before ? before->data().snapshot.get() : nullptr;
      *image = with_public_errors([&] { return renderer_->draw(*frame.data().snapshot, previous); });
    }
    const std::vector<py::ssize_t> shape{image->height, image->width, 3};
    const std::uint8_t* bytes = image->rgb.data();
    const py::capsule owner(image.release(), [](void* data) { delete static_cast<image::Image*>(data); });
    return py::array_t<std::uint8_t>(shape, bytes, owner);
  }

 private:
  std::thread::id thread_ = std::this_thread::get_id();
  std::unique_ptr<render::Renderer> renderer_;
};

}  // namespace

void bind_drawing(py::module_& module) {
  py::class_<Renderer>(module, "Renderer",
                       "Draws frames of a scene with OpenGL on the CPU: no display is needed. Size and camera are "
                       "render.width, render.height and render.camera of the scene.")
      .def(py::init<const Scene&, const std::string&>(), py::arg("scene"), py::kw_only(), py::arg("quality") = "final",
           "quality: \"draft\", \"preview\" or \"final\".")
      .def("draw", &Renderer::draw, py::arg("frame"), py::arg("before") = py::none(),
           "The picture of a frame: an array of height x width x 3 bytes, sRGB, top row first. A camera that the scene "
           "does not place is computed from the first frame that is drawn. `before`: the frame before `frame`, "
           "needed for motion blur. Call it from the thread that made the renderer.");
}

}  // namespace weft::python
