#include "scene/view_rules.hpp"

#include "scene/common_rules.hpp"
#include "scene/table_builder.hpp"

namespace weft::scene {
namespace {

// A camera or light that stands still has one key, which stores its own values. If `keys` are given, the first one
// starts with these values, and each later one with those of its predecessor.
template <class S>
void copy_key_before(S& owner, std::size_t i) {
  if (i == 0) return;
  const auto last = owner.keys.back();
  owner.keys.push_back(last);
}
template <class S>
bool moves(S& owner) {
  return owner.keys.size() > 1;
}
template <class S>
bool stands_still(S& owner) {
  return owner.keys.size() == 1;
}
/// Access to a member of the first key, which stores the own values of a camera or light.
template <class Key, class Field>
auto own(Field Key::*field) {
  return [field](auto& owner) -> Field& { return owner.keys.front().*field; };
}

const Range kFieldOfView = within(1, 170);    // [degrees]
const Range kFocalLength = within(1, 10000);  // [mm]
const Range kIntensity = within(0, 1000);

/// Row of the focal length of a key, after that of its field of view. `stands`: whether (S&) its own value is written.
template <class S, class Member, class Stands>
void focal_length_row(TableBuilder<S>& rows, Member member, const std::string& otherwise, Stands stands) {
  rows.number("focal_length", member, kFocalLength, "mm", "in place of field_of_view, with sensor_width")
      .excludes("field_of_view")
      .by_default(otherwise)
      .written_if([member, stands](S& s) { return stands(s) && std::invoke(member, s) > 0; });
}

/// The same for a camera, with its sensor width.
template <class Stands>
void focal_rows(TableBuilder<Camera>& rows, Stands stands) {
  focal_length_row(rows, own(&CameraKey::focal_length), "none", stands);
  rows.number("sensor_width", &Camera::sensor_width, within(0.1, 1000), "mm",
              "of the longer side of the picture, render.width or render.height; beside focal_length")
      .by_default("36")
      .written_if([](Camera& camera) { return has_focal_length(camera); });
}
bool has_field_of_view(Camera& camera) {
  return camera.keys.front().field_of_view > 0 && !has_focal_length(camera);
}

const Table& camera_key_rules() {
  static const Table kTable =
      TableBuilder<CameraKey>("A view at a time.")
          .number("time", &CameraKey::time, kMoment, "s", "later than the key before")
          .need(Need::required)
          .vector("position", &CameraKey::position, kXyz, kPlace, "m", "of the eye")
          .by_default(kDefaultOfKey)
          .vector("target", &CameraKey::target, kXyz, kPlace, "m", "point in the middle of the picture")
          .by_default(kDefaultOfKey)
          .number("field_of_view", &CameraKey::field_of_view, kFieldOfView, "degrees", "vertical")
          .by_default(kDefaultOfKey)
          .written_if([](CameraKey& key) { return key.focal_length == 0; })
          .with([](auto& rows) {
            focal_length_row(rows, &CameraKey::focal_length, kDefaultOfKey, [](CameraKey&) { return true; });
          })
          .build();
  return kTable;
}

/// Keys of cameras that stand still or move by keys.
void placed_camera_rows(TableBuilder<Camera>& rows) {
  rows.vector("position", own(&CameraKey::position), kXyz, kPlace, "m", "of the eye")
      .need(Need::here_or_in_first_key)
      .written_if(stands_still<Camera>)
      .vector("target", own(&CameraKey::target), kXyz, kPlace, "m", "point in the middle of the picture")
      .need(Need::here_or_in_first_key)
      .written_if(stands_still<Camera>)
      .number("field_of_view", own(&CameraKey::field_of_view), kFieldOfView, "degrees", "vertical")
      .written_if([](Camera& camera) { return stands_still(camera) && has_field_of_view(camera); })
      .with([](auto& own_rows) { focal_rows(own_rows, stands_still<Camera>); })
      .choice("interpolation", &Camera::interpolation, kInterpolations, "between its keys")
      .list(Type::keys, "keys", &Camera::keys, camera_key_rules(), copy_key_before<Camera>)
      .written_if(moves<Camera>)
      .plain(Type::text, "follow", &Camera::follow,
             "obstacle, or part of a character as \"man.head\", with which position and target move; they say where "
             "the camera is while that is where it is at the start of the run")
      .by_default("none")
      .plain(Type::boolean, "follow_rotation", &Camera::follow_rotation,
             "false: with the translation of what it follows alone; the camera stays upright in any case")
      .by_default("true")
      .written_if([](Camera& camera) { return !camera.follow.empty(); });
}

void lens_rows(TableBuilder<Camera>& rows) {
  rows.number("aperture", &Camera::aperture, within(0, 1000), "",
              "f-number that blurs what is out of focus, as of a camera with 24 mm of film; 0: all is sharp")
      .number("focus", &Camera::focus, within(0, 1e5), "m", "distance that is sharp")
      .by_default("that of what is in the middle of the picture");
}

/// Keys of computed cameras for their subject.
void subject_rows(TableBuilder<Camera>& rows) {
  rows.plain(Type::texts, "subject", &Camera::subjects, "names of cloths, obstacles and characters that it shows")
      .by_default("of whole, all but floors without end; of the others the characters, else the cloths")
      .number("margin", &Camera::margin, within(0, 0.9), "", "share of each half picture left free around them");
}
void smoothing_row(TableBuilder<Camera>& rows) {
  rows.number("smoothing", &Camera::smoothing, within(0, 60), "s", "of the way that it takes; 0 follows every twitch");
}

/// Keys of cameras that view the subject from a direction.
void direction_rows(TableBuilder<Camera>& rows) {
  rows.number("azimuth", &Camera::azimuth, within(-36000, 36000), "degrees",
              "direction in which the eye is, around the up axis from the front to the right: with z up, 0 is toward "
              "-y and 90 toward +x")
      .number("elevation", &Camera::elevation, within(-89, 89), "degrees", "of the eye above the subject")
      .number("orbit", &Camera::orbit, within(-3600, 3600), "degrees/s", "in which it goes around, to the right")
      .number("field_of_view", own(&CameraKey::field_of_view), kFieldOfView, "degrees", "vertical")
      .by_default("30")
      .written_if(has_field_of_view)
      .with([](auto& own_rows) { focal_rows(own_rows, stands_still<Camera>); })
      .with(subject_rows);
}

void file_rows(TableBuilder<Camera>& rows) {
  rows.plain(Type::file, "file", &Camera::file,
             "glTF (.glb, .gltf), as modellers export it; relative paths start at the scene's folder")
      .need(Need::required)
      .plain(Type::text, "object", &Camera::object, "name of the node with the camera")
      .by_default("the only one")
      .number("start", &Camera::start, kMoment, "s", "of the scene, when the time of the file begins")
      .number("scale", &Camera::scale, above(0, 1e6), "", "factor on lengths of the file, which are metres there");
}

/// Keys that suns and spots share; `rows` adds the others.
Table light_key_table(const std::function<void(TableBuilder<LightKey>&)>& rows) {
  return TableBuilder<LightKey>("A light at a time.")
      .number("time", &LightKey::time, kMoment, "s", "later than the key before")
      .need(Need::required)
      .with(rows)
      .number("intensity", &LightKey::intensity, kIntensity, "",
              "1 lights a white surface that faces it to white, a spot one at its target")
      .by_default(kDefaultOfKey)
      .build();
}

const Table& sun_key_rules() {
  static const Table kTable = light_key_table([](auto& rows) {
    rows.vector("direction", &LightKey::direction, kXyz, kPlace, "", "the way the light travels")
        .nonzero()
        .by_default(kDefaultOfKey);
  });
  return kTable;
}

const Table& spot_key_rules() {
  static const Table kTable = light_key_table([](auto& rows) {
    rows.vector("position", &LightKey::position, kXyz, kPlace, "m", "of the lamp").by_default(kDefaultOfKey);
    rows.vector("target", &LightKey::target, kXyz, kPlace, "m", "point that it shines at").by_default(kDefaultOfKey);
  });
  return kTable;
}

}  // namespace

const Table& camera_rules() {
  using Rows = TableBuilder<Camera>;
  static const Table kTable =
      Rows("A camera, still or moved by key frames, or found from all frames.")
          .starting_from({.name = {}, .keys = {CameraKey{}}})
          .plain(Type::name, "name", &Camera::name, "unlike that of any other camera")
          .need(Need::required)
          .choice_by(
              "kind", {"placed", "whole", "follow", "close", "track", "file"},
              "placed by position and target, or found before drawing from all frames: so that all of the run is in "
              "view; going along at one distance; as close as the subject allows; turning after it where it stands; or "
              "with the way and lens of one in a file",
              [](Camera& c) { return static_cast<std::size_t>(c.kind); },
              [](Camera& c, std::size_t index) {
                c.kind = static_cast<CameraKind>(index);
                if (is_computed(c.kind)) c.keys.front().field_of_view = kComputedFieldOfView;
                if (c.kind == CameraKind::track) c.keys.front().field_of_view = 0;
              })
          .selects()
          .with(lens_rows)
          .variant("placed", Rows().with(placed_camera_rows))
          .variant("whole", Rows().with(direction_rows))
          .variant("follow", Rows().with(direction_rows).with(smoothing_row))
          .variant("close", Rows().with(direction_rows).with(smoothing_row))
          .variant("track",
                   Rows()
                       .vector("position", own(&CameraKey::position), kXyz, kPlace, "m", "of the eye")
                       .need(Need::required)
                       .number("field_of_view", own(&CameraKey::field_of_view), kFieldOfView, "degrees", "vertical")
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
      Rows("A light, still or moved by key frames.")
          .starting_from({.name = {}, .color = {1, 1, 1}, .keys = {LightKey{}}})
          .plain(Type::name, "name", &Light::name, "unlike that of any other light")
          .need(Need::required)
          .choice("kind", &Light::spot, {"sun", "spot"}, "parallel light, or light from one place")
          .selects()
          .color("color", &Light::color, "of the light")
          .number("intensity", own(&LightKey::intensity), kIntensity, "",
                  "1 lights a white surface that faces it to white, a spot one at its target")
          .written_if(stands_still<Light>)
          .number("softness", &Light::softness, within(0, 90), "degrees",
                  "width of the source as seen from the scene; wider gives softer shadows, up to 40")
          .choice("interpolation", &Light::interpolation, kInterpolations, "between its keys")
          .variant("sun",
                   Rows()
                       .vector("direction", own(&LightKey::direction), kXyz, kPlace, "", "the way the light travels")
                       .nonzero()
                       .by_default("[-0.4, -0.5, -1] where z is up, turned with the up axis")
                       .written_if(stands_still<Light>)
                       .with(keys_row(sun_key_rules())))
          .variant("spot", Rows()
                               .vector("position", own(&LightKey::position), kXyz, kPlace, "m", "of the lamp")
                               .by_default("5 m up the up axis")
                               .written_if(stands_still<Light>)
                               .vector("target", own(&LightKey::target), kXyz, kPlace, "m", "point that it shines at")
                               .written_if(stands_still<Light>)
                               .number("cone_angle", &Light::cone_angle, within(1, 170), "degrees", "full opening")
                               .with(keys_row(spot_key_rules())))
          .build();
  return kTable;
}

const Table& render_rules() {
  static const Table kTable =
      TableBuilder<Render>("The picture.")
          .whole_number("width", &Render::width, within(16, 8192), "of the picture, in pixels")
          .not_simulated()
          .whole_number("height", &Render::height, within(16, 8192), "of the picture, in pixels")
          .not_simulated()
          .plain(Type::text, "camera", &Render::camera, "name of the camera that is looked through")
          .by_default("the first camera; automatic framing where there is none")
          .not_simulated()
          .choice("look", &Render::look, {"studio", "stage", "daylight", "clay", "wire", "strain"},
                  "surroundings and style: a photographer's studio, a dark stage, sun and sky; for review clay without "
                  "colors, clay with the edges of its faces, or colors of strain")
          .when_given([](Render& render) {
            if (render.look == StageLook::strain) render.heat = HeatQuantity::strain;
          })
          .not_simulated()
          .number("exposure", &Render::exposure, within(-10, 10), "stops", "by which the picture is brighter")
          .not_simulated()
          .number("motion_blur", &Render::motion_blur, within(0, 360), "degrees",
                  "angle of the shutter, 180 as of film; 0: all is sharp")
          .not_simulated()
          .color("sky_color", &Render::sky_color, "of the light from above")
          .by_default("that of the look")
          .not_simulated()
          .color("ground_color", &Render::ground_color, "of the light from below")
          .by_default("that of the floor, or of the look")
          .not_simulated()
          .number("sky_intensity", &Render::sky_intensity, within(0, 100), "", "share of light from around")
          .by_default("that of the look")
          .not_simulated()
          .choice("heat", &Render::heat, {"none", "strain", "speed"}, "quantity that colors the cloth")
          .number("heat_max", &Render::heat_max, within(0, 1e6), "",
                  "value at the hot end (strain: 1, speed: m/s); 0 follows each frame's largest")
          .not_simulated()
          .build();
  return kTable;
}

}  // namespace weft::scene
