#include "film/scene/view_rules.hpp"

#include "film/scene/common_rules.hpp"
#include "film/scene/table_builder.hpp"

namespace weft::scene {
namespace {

const Range kFieldOfView = within(1, 170);    // [degrees]
const Range kFocalLength = within(1, 10000);  // [mm]
const Range kIntensity = within(0, 1000);

/// Adds the row of the focal length; call it after the row of the field of view. `stands(s)`: whether the effective
/// scene may contain the focal length in the table of `s`. `otherwise`: documentation of the default.
template <class S, class Member, class Stands>
void focal_length_row(TableBuilder<S>& rows, Member member, const std::string& otherwise, Stands stands) {
  rows.number("focal_length", member, kFocalLength, "mm",
              "focal length of the lens, in place of field_of_view; see sensor_width")
      .excludes("field_of_view")
      .by_default(otherwise)
      .written_if([member, stands](S& s) { return stands(s) && std::invoke(member, s) > 0; });
}

/// Adds the rows of the focal length and the sensor width of a camera.
template <class Stands>
void focal_rows(TableBuilder<Camera>& rows, Stands stands) {
  focal_length_row(rows, of_first_key(&CameraKey::focal_length), "none", stands);
  rows.number("sensor_width", &Camera::sensor_width, within(0.1, 1000), "mm",
              "width of the sensor along the longer side of the picture; only with focal_length")
      .by_default("36")
      .written_if([](Camera& camera) { return has_focal_length(camera); });
}
bool has_field_of_view(Camera& camera) {
  return camera.keys.front().field_of_view > 0 && !has_focal_length(camera);
}

const Table& camera_key_rules() {
  static const Table kTable =
      TableBuilder<CameraKey>("The view at one time.")
          .with(key_time_row<CameraKey>)
          .vector("position", &CameraKey::position, kXyz, kPositionRange, "m", "position of the camera")
          .by_default(kDefaultOfKey)
          .vector("target", &CameraKey::target, kXyz, kPositionRange, "m",
                  "point at which the camera looks, the middle of the picture")
          .by_default(kDefaultOfKey)
          .number("field_of_view", &CameraKey::field_of_view, kFieldOfView, "degrees", "vertical field of view")
          .by_default(kDefaultOfKey)
          .written_if([](CameraKey& key) { return key.focal_length == 0; })
          .with([](auto& rows) {
            focal_length_row(rows, &CameraKey::focal_length, kDefaultOfKey, [](CameraKey&) { return true; });
          })
          .build();
  return kTable;
}

/// Adds the keys of a placed camera, with or without key frames.
void placed_camera_rows(TableBuilder<Camera>& rows) {
  rows.vector("position", of_first_key(&CameraKey::position), kXyz, kPositionRange, "m", "position of the camera")
      .need(Need::here_or_in_first_key)
      .written_if(stands_still<Camera>)
      .vector("target", of_first_key(&CameraKey::target), kXyz, kPositionRange, "m",
              "point at which the camera looks, the middle of the picture")
      .need(Need::here_or_in_first_key)
      .written_if(stands_still<Camera>)
      .number("field_of_view", of_first_key(&CameraKey::field_of_view), kFieldOfView, "degrees",
              "vertical field of view")
      .written_if([](Camera& camera) { return stands_still(camera) && has_field_of_view(camera); })
      .with([](auto& own_rows) { focal_rows(own_rows, stands_still<Camera>); })
      .choice("interpolation", &Camera::interpolation, kInterpolations, kBetweenKeys)
      .list(Type::keys, "keys", &Camera::keys, camera_key_rules(), copy_key_before<Camera>)
      .written_if(moves<Camera>)
      .plain(Type::text, "follow", &Camera::follow,
             "obstacle, or part of a character such as \"man.head\", with which the camera moves; position and target "
             "say where it would be if the followed body stayed where it is at the start of the run")
      .by_default("none")
      .plain(Type::boolean, "follow_rotation", &Camera::follow_rotation,
             "false: the camera follows the translation only; it stays upright in either case")
      .by_default("true")
      .written_if([](Camera& camera) { return !camera.follow.empty(); });
}

void lens_rows(TableBuilder<Camera>& rows) {
  rows.number("aperture", &Camera::aperture, within(0, 1000), "",
              "f-number of the lens, for film 24 mm high; a smaller number blurs more of what is out of focus; 0: all "
              "is sharp")
      .number("focus", &Camera::focus, within(0, 1e5), "m", "distance at which the picture is sharp")
      .by_default("the distance of the target; with kind = \"file\", aperture needs it");
}

/// Adds the keys `subject` and `margin` of computed cameras.
void subject_rows(TableBuilder<Camera>& rows) {
  rows.plain(Type::texts, "subject", &Camera::subjects,
             "names of the cloths, ropes, obstacles and characters that it shows")
      .by_default("for kind whole: everything but infinite planes; for the others: the characters, else the cloths")
      .number("margin", &Camera::margin, within(0, 0.9), "",
              "fraction of each half of the picture that stays free around the subject");
}
void smoothing_row(TableBuilder<Camera>& rows) {
  rows.number("smoothing", &Camera::smoothing, within(0, 60), "s",
              "time over which the motion of the camera is smoothed; 0: no smoothing");
}

/// Adds the keys of those computed cameras for which the scene gives the direction from the subject.
void direction_rows(TableBuilder<Camera>& rows) {
  rows.number("azimuth", &Camera::azimuth, within(-36000, 36000), "degrees",
              "direction of the camera as seen from the subject, around the up axis from the front to the right: with "
              "z up, 0 is toward -y and 90 toward +x")
      .number("elevation", &Camera::elevation, within(-89, 89), "degrees",
              "elevation angle of the camera as seen from the subject")
      .number("orbit", &Camera::orbit, within(-3600, 3600), "degrees/s",
              "rate at which the azimuth grows: the camera moves around the subject, to the right")
      .number("field_of_view", of_first_key(&CameraKey::field_of_view), kFieldOfView, "degrees",
              "vertical field of view")
      .by_default("30")
      .written_if(has_field_of_view)
      .with([](auto& own_rows) { focal_rows(own_rows, stands_still<Camera>); })
      .with(subject_rows);
}

void file_rows(TableBuilder<Camera>& rows) {
  rows.plain(Type::file, "file", &Camera::file,
             "glTF file (.glb, .gltf) with a camera, as modelling programs export it; relative paths start at the "
             "scene's folder")
      .need(Need::required)
      .plain(Type::text, "object", &Camera::object, "name of the node with the camera")
      .by_default("the only one")
      .number("start", &Camera::start, kTimeRange, "s", "time of the scene at which the file's time 0 is")
      .number("scale", &Camera::scale, above(0, 1e6), "",
              "factor on the lengths of the file, which glTF gives in metres");
}

/// Rules of a key frame of a light. `rows`: adds the keys that only suns have, or those that only spots have.
Table light_key_table(const std::function<void(TableBuilder<LightKey>&)>& rows) {
  return TableBuilder<LightKey>("The light at one time.")
      .with(key_time_row<LightKey>)
      .with(rows)
      .number("intensity", &LightKey::intensity, kIntensity, "",
              "brightness; with 1, a white surface that faces the light looks white, for a spot at its target")
      .by_default(kDefaultOfKey)
      .build();
}

const Table& sun_key_rules() {
  static const Table kTable = light_key_table([](auto& rows) {
    rows.vector("direction", &LightKey::direction, kXyz, kPositionRange, "",
                "direction in which the light travels, of any length but 0")
        .nonzero()
        .by_default(kDefaultOfKey);
  });
  return kTable;
}

const Table& spot_key_rules() {
  static const Table kTable = light_key_table([](auto& rows) {
    rows.vector("position", &LightKey::position, kXyz, kPositionRange, "m", "position of the lamp")
        .by_default(kDefaultOfKey);
    rows.vector("target", &LightKey::target, kXyz, kPositionRange, "m", "point at which it shines")
        .by_default(kDefaultOfKey);
  });
  return kTable;
}

}  // namespace

const Table& camera_rules() {
  using Rows = TableBuilder<Camera>;
  static const Table kTable =
      Rows("A camera: still, moved by key frames, or computed from all frames.")
          .starting_from({.name = {}, .keys = {CameraKey{}}})
          .plain(Type::name, "name", &Camera::name, "unique name of the camera")
          .need(Need::required)
          .choice("kind", &Camera::kind, {"placed", "whole", "follow", "close", "track", "file"},
                  "placed: by position and target. Computed from all frames before drawing: whole shows the whole run, "
                  "follow moves along at a constant distance, close is as near as the subject allows, track stands "
                  "still and turns. file: position and lens come from a file")
          .when_given([](Camera& c) {
            if (is_computed(c.kind)) c.keys.front().field_of_view = kComputedFieldOfView;
            if (c.kind == CameraKind::track) c.keys.front().field_of_view = 0;
          })
          .selects()
          .with(lens_rows)
          .variant("placed", Rows().with(placed_camera_rows))
          .variant("whole", Rows().with(direction_rows))
          .variant("follow", Rows().with(direction_rows).with(smoothing_row))
          .variant("close", Rows().with(direction_rows).with(smoothing_row))
          .variant("track", Rows()
                                .vector("position", of_first_key(&CameraKey::position), kXyz, kPositionRange, "m",
                                        "position of the camera")
                                .need(Need::required)
                                .number("field_of_view", of_first_key(&CameraKey::field_of_view), kFieldOfView,
                                        "degrees", "vertical field of view")
                                .by_default("as wide as the subject needs in all frames")
                                .written_if(has_field_of_view)
                                .with([](auto& rows) { focal_rows(rows, stands_still<Camera>); })
                                .with(subject_rows)
                                .with(smoothing_row))
          .variant("file", Rows().with(file_rows))
          .build();
  return kTable;
}

const Table& light_rules() {
  using Rows = TableBuilder<Light>;
  const auto keys_row = [](const Table& key_rules) {
    return [&key_rules](Rows& rows) {
      rows.list(Type::keys, "keys", &Light::keys, key_rules, copy_key_before<Light>).written_if(moves<Light>);
    };
  };
  static const Table kTable =
      Rows("A light: still, or moved by key frames. Pictures show the effect of the first 4.")
          .starting_from({.name = {}, .color = {1, 1, 1}, .keys = {LightKey{}}})
          .plain(Type::name, "name", &Light::name, "unique name of the light")
          .need(Need::required)
          .choice("kind", &Light::spot, {"sun", "spot"}, "sun: parallel light; spot: a cone of light from one place")
          .selects()
          .color("color", &Light::color, "color of the light")
          .number("intensity", of_first_key(&LightKey::intensity), kIntensity, "",
                  "brightness; with 1, a white surface that faces the light looks white, for a spot at its target")
          .written_if(stands_still<Light>)
          .number("softness", &Light::softness, within(0, 90), "degrees",
                  "angular width of the source as seen from the scene; wider: softer shadows; above 40 counts as 40")
          .choice("interpolation", &Light::interpolation, kInterpolations, kBetweenKeys)
          .variant("sun", Rows()
                              .vector("direction", of_first_key(&LightKey::direction), kXyz, kPositionRange, "",
                                      "direction in which the light travels, of any length but 0")
                              .nonzero()
                              .by_default("[-0.4, -0.5, -1] where z is up, turned with the up axis")
                              .written_if(stands_still<Light>)
                              .with(keys_row(sun_key_rules())))
          .variant("spot", Rows()
                               .vector("position", of_first_key(&LightKey::position), kXyz, kPositionRange, "m",
                                       "position of the lamp")
                               .by_default("5 m up the up axis")
                               .written_if(stands_still<Light>)
                               .vector("target", of_first_key(&LightKey::target), kXyz, kPositionRange, "m",
                                       "point at which it shines")
                               .written_if(stands_still<Light>)
                               .number("cone_angle", &Light::cone_angle, within(1, 170), "degrees",
                                       "full opening angle of the cone of light")
                               .with(keys_row(spot_key_rules())))
          .build();
  return kTable;
}

const Table& render_rules() {
  static const Table kTable =
      TableBuilder<Render>("Picture size, camera, surroundings and colors.")
          .whole_number("width", &Render::width, within(16, 8192), "width of the picture in pixels")
          .not_simulated()
          .whole_number("height", &Render::height, within(16, 8192), "height of the picture in pixels")
          .not_simulated()
          .plain(Type::text, "camera", &Render::camera, "name of the camera from which the scene is drawn")
          .by_default("the first camera; automatic framing if there is none")
          .not_simulated()
          .choice("look", &Render::look, {"studio", "stage", "daylight", "clay", "wire", "strain"},
                  "surroundings: a photographer's studio, a dark stage, or sun and sky; for review: clay without "
                  "colors, clay with the edges of its faces (wire), or colors of strain")
          .when_given([](Render& render) {
            if (render.look == StageLook::strain) render.heat = HeatQuantity::strain;
          })
          .not_simulated()
          .number("exposure", &Render::exposure, within(-10, 10), "stops",
                  "brightening of the picture; each stop doubles the light")
          .not_simulated()
          .number("motion_blur", &Render::motion_blur, within(0, 360), "degrees",
                  "shutter angle; 360 is the time between two frames, film uses 180; 0: no motion blur")
          .not_simulated()
          .color("sky_color", &Render::sky_color,
                 "color of the light from above and of the background near the horizon")
          .by_default("as `look` defines it")
          .not_simulated()
          .color("ground_color", &Render::ground_color, "color of the light from below")
          .by_default("the color of the floor; without a floor, grey")
          .not_simulated()
          .number("sky_intensity", &Render::sky_intensity, within(0, 100), "",
                  "fraction of all light that comes from the surroundings, not from lights; above 1 counts as 1")
          .by_default("as `look` defines it")
          .not_simulated()
          .choice("heat", &Render::heat, {"none", "strain", "speed"},
                  "quantity that the colors of cloth and ropes show")
          .number(
              "heat_max", &Render::heat_max, within(0, 1e6), "",
              "value of the hottest color: strain (0.1 is 10 %), or speed in m/s; 0: the largest value of each frame")
          .not_simulated()
          .build();
  return kTable;
}

}  // namespace weft::scene
