// Malformed scenes, with the exact messages that a user reads.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "film/scene/findings.hpp"
#include "film/scene/loader.hpp"
#include "support/test_folder.hpp"

namespace weft::scene {
namespace {

struct Malformed {
  std::string claim;
  std::string text;
  std::string messages;  ///< complete output of describe() for a file named s.toml
};

void PrintTo(const Malformed& malformed, std::ostream* out) {
  *out << malformed.claim;
}

// The smallest valid scene is on one line, so that text after it begins on line 2.
const std::string kFloor = "obstacle = [{ name = 'floor', shape = 'plane' }]\n";
const std::string kBand = "cloth = [{ name = 'band' }]\n";

const std::vector<Malformed> kMalformed = {
    // The file as a whole.
    {"EmptyFile", "", "s.toml: expected a scene, got an empty file\n"},
    {"BlankFile", " \n\t\n", "s.toml: expected a scene, got an empty file\n"},
    {"OnlyComments", "# nothing\n",
     "s.toml:1:1: expected at least one [[cloth]], [[rope]], [[obstacle]] or [[character]], got none\n"},
    {"NoObjects", "[time]\nfps = 24\n",
     "s.toml:1:1: expected at least one [[cloth]], [[rope]], [[obstacle]] or [[character]], got none\n"},
    {"BinaryData",
     std::string("\x7f"
                 "ELF\x02\0\0",
                 7),
     "s.toml: expected text, got binary data (byte 0 at offset 5)\n"},
    {"InvalidUtf8", "title = '\xc3\x28'\n", "s.toml:1:9: not TOML: Encountered invalid utf-8 sequence\n"},
    // Air, fans and attachments.
    {"QuantityOfAnotherControl", "[[cloth]]\nname = 'a'\npressure = { control = 'air', gauge = 3 }\n",
     "s.toml:3:31: cloth.a.pressure.gauge: unknown key of a air; it belongs to gauge\n"},
    {"NegativeFill", "[[cloth]]\nname = 'a'\npressure = { control = 'fill', fill = -1 }\n",
     "s.toml:3:39: cloth.a.pressure.fill: expected >= 0, got -1\n"},
    {"PressureKeysOutOfOrder", "[[cloth]]\nname = 'a'\npressure.keys = [{ time = 1, gauge = 3 }, { time = 0.5 }]\n",
     "s.toml:3:52: cloth.a.pressure.keys.1.time: expected > 1 s, later than the keys before, got 0.5\n"},
    {"PhysicsKeysOutOfOrder", kBand + "[physics]\nkeys = [{ time = 1 }, { time = 1, wind = [1, 0, 0] }]\n",
     "s.toml:3:32: physics.keys.1.time: expected > 1 s, later than the keys before, got 1\n"},
    {"FanWithoutAPlace", kBand + "[[fan]]\nname = 'f'\ndirection = [0, 0, 0]\n",
     "s.toml:2:1: fan.f.position: expected [x, y, z], each from -100000 to 100000 m, here or in the first of its keys, "
     "got none\ns.toml:4:13: fan.f.direction: expected at least one number that is not 0, got 0 in all\n"},
    {"FanWithoutADirection", kBand + "[[fan]]\nname = 'f'\nposition = [0, 0, 1]\n",
     "s.toml:2:1: fan.f.direction: expected [x, y, z], each from -100000 to 100000, here or in the first of its keys, "
     "got none\n"},
    {"FanWithADirectionInItsSecondKeyOnly",
     kBand + "[[fan]]\nname = 'f'\nkeys = [{ time = 0, position = [0, 0, 1] }, { time = 1, direction = [1, 0, 0] }]\n",
     "s.toml:2:1: fan.f.direction: expected [x, y, z], each from -100000 to 100000, here or in the first of its keys, "
     "got none\n"},
    {"AttachmentToNothing", kBand + "[[attach]]\nname = 'peg'\ncloth = 'bond'\nto = 'line'\n",
     "s.toml:4:9: attach.peg.cloth: expected the name of a cloth or rope, got \"bond\"; did you mean band?\n"
     "s.toml:5:6: attach.peg.to: expected the name of a cloth, rope, obstacle or character, got \"line\"\n"},
    {"AttachmentToAnEmptyName", kBand + "[[attach]]\nname = 'peg'\ncloth = ''\nto = ''\n",
     "s.toml:4:9: attach.peg.cloth: expected a text, got an empty one\n"
     "s.toml:5:6: attach.peg.to: expected a text, got an empty one\n"},
    {"SequenceWithoutAName", "[[character]]\nname = 'a'\nsource = 'sequence'\nfiles = ''\n",
     "s.toml:4:9: character.a.files: expected a text, got an empty one\n"},
    {"ReleaseOfKeysBeforeTheStart",
     "[[obstacle]]\nname = 'b'\nshape = 'box'\nmass = 1\nkeys = [{ time = 0 }, { time = 1 }]\n",
     "s.toml:1:1: obstacle.b.release: expected > 0 s beside keys, which move it until then, got none\n"},
    {"AttachmentToItself", kBand + "[[attach]]\nname = 'peg'\ncloth = 'band'\nto = 'band'\nbegin = 2\nrelease = 1\n",
     "s.toml:5:6: attach.peg.to: expected another object than the cloth itself, got \"band\"\n"
     "s.toml:7:11: attach.peg.release: expected > 2 s, when it begins, got 1\n"},
    // Pictures and cameras.
    {"PictureThatIsNone", "[[cloth]]\nname = 'a'\nlook.image = '/etc/passwd'\n",
     "s.toml:3:14: cloth.a.look.image: expected a picture (PNG, JPEG or TGA), got \"/etc/passwd\": it begins like no "
     "picture\n"},
    {"PictureThatIsMissing", "[[cloth]]\nname = 'a'\nlook.image = '/none.png'\n",
     "s.toml:3:14: cloth.a.look.image: expected a readable file, got \"/none.png\": there is no /none.png\n"},
    {"PanelOfNoPattern", "[[cloth]]\nname = 'a'\nlook.panel = [{ name = 'front' }]\n",
     "s.toml:3:15: cloth.a.look.panel.front: expected none for a cloth that is not shape = \"pattern\"\n"},
    {"SubjectThatIsNotThere", kBand + "[[camera]]\nname = 'c'\nkind = 'follow'\nsubject = 'bond'\n",
     "s.toml:5:11: camera.c.subject: expected the name of a cloth, rope, obstacle or character, got \"bond\"; did you "
     "mean "
     "band?\n"},
    {"TargetOfACameraThatIsFound", kBand + "[[camera]]\nname = 'c'\nkind = 'whole'\ntarget = [0, 0, 0]\n",
     "s.toml:5:1: camera.c.target: unknown key of a whole; it belongs to placed\n"},
    {"SyntaxError", "[time\nfps = 24\n",
     "s.toml:1:6: not TOML: Error while parsing table header: expected ']', saw '\\n'\n"},
    {"DuplicateKey", kFloor + "[time]\nfps = 24\nfps = 25\n",
     "s.toml:4:7: expected each key once, got \"fps\" again\n"},
    {"DuplicateTable", kFloor + "[time]\n[render]\n[time]\n",
     "s.toml:4:1: expected each key once, got \"time\" again\n"},
    {"HeaderInSingleBracketsAfterDoubleOnes", "[[cloth]]\nname = 'a'\n[cloth]\nname = 'b'\n",
     "s.toml:3:1: expected \"cloth\" in one form, in [ ], in [[ ]] or as a value, got two; entries of a list need "
     "[[ ]]\n"},
    {"HeaderInDoubleBracketsAfterSingleOnes", "[cloth]\nname = 'a'\n[[cloth]]\nname = 'b'\n",
     "s.toml:3:1: expected \"cloth\" in one form, in [ ], in [[ ]] or as a value, got two; entries of a list need "
     "[[ ]]\n"},
    {"NumberTooLarge", "a = 99999999999999999999\n",
     "s.toml:1:25: not TOML: Error while parsing decimal integer: '99999999999999999999' is not representable in 64 "
     "bits\n"},
    {"NestedTooDeep", "a = " + std::string(300, '['),
     "s.toml:1:1: not TOML: expected at most 128 levels of lists, tables and dotted keys, got more\n"},

    // Keys.
    {"OverUnknown", "[[cloth]]\nname = 'shirt'\n[[cloth]]\nname = 'coat'\nover = ['shirt', 'shrt']\n",
     "s.toml:5:8: cloth.coat.over: expected the name of a cloth, got \"shrt\"; did you mean shirt?\n"},
    {"OverNumber", "[[cloth]]\nname = 'coat'\nover = ['coat', 3]\n",
     "s.toml:3:17: cloth.coat.over: expected a text or an array of texts, got 3\n"},
    {"OverAnEmptyName", "[[cloth]]\nname = 'coat'\nover = ['']\n",
     "s.toml:3:8: cloth.coat.over: expected a text or an array of texts, got an empty one\n"},
    {"OverItself", "[[cloth]]\nname = 'coat'\nover = 'coat'\n",
     "s.toml:3:8: cloth.coat.over: expected cloth that is put on before this one, got \"coat\", which it is itself\n"},
    {"OverInACircle",
     "[[cloth]]\nname = 'a'\nover = 'c'\n[[cloth]]\nname = 'b'\nover = 'a'\n[[cloth]]\nname = 'c'\nover = 'b'\n",
     "s.toml:3:8: cloth.a.over: expected cloth that is put on before this one, got \"c\", which is worn over this "
     "one\n"},
    {"UnknownTable", kFloor + "[phisics]\n", "s.toml:2:2: phisics: unknown key; did you mean physics?\n"},
    {"MisspeltKey", kFloor + "[time]\nduraton = 3\n",
     "s.toml:3:1: time.duraton: unknown key; did you mean duration?\n"},
    {"KeyOfNoKind", kFloor + "[contact]\nzzzzzzzz = 3\n",
     "s.toml:3:1: contact.zzzzzzzz: unknown key; known here: self, obstacles, stiffness, search, pair, response\n"},
    {"StaticFrictionBelowThatOfSliding",
     kFloor + "[[cloth]]\nname = 'band'\n[[contact.pair]]\nfirst = 'band'\nsecond = 'flor'\nfriction = 0.5\n"
              "static_friction = 0.4\n",
     "s.toml:6:10: contact.pair.0.second: expected the name of a cloth, rope, obstacle or character, got \"flor\"; did "
     "you "
     "mean floor?\n"
     "s.toml:8:19: contact.pair.0.static_friction: expected >= 0.5, that of sliding, got 0.4\n"},
    {"KeyOfAnInnerTable", "[[cloth]]\nname = 'band'\nthickness = 0.002\n",
     "s.toml:3:1: cloth.band.thickness: unknown key; did you mean material.thickness?\n"},
    {"KeyOfAnotherShape", "[[obstacle]]\nname = 'ball'\nshape = 'sphere'\nradius = 1\nheight = 2\n",
     "s.toml:5:1: obstacle.ball.height: unknown key of a sphere; it belongs to cone or cylinder\n"},
    {"KeyOfAnotherLight", kFloor + "[[light]]\nname = 'sun'\ncone_angle = 30\n",
     "s.toml:4:1: light.sun.cone_angle: unknown key of a sun; it belongs to spot\n"},
    {"KeyWithOddCharacters", kFloor + "\"a b\\u0007\" = 3\n",
     "s.toml:2:1: \"a b\\x07\": unknown key; known here: up, title, time, physics, solver, contact, render, fan, "
     "obstacle, character, cloth, rope, attach, camera, light\n"},
    {"MissingName", "[[cloth]]\nsize = 1\n",
     "s.toml:1:1: cloth.0.name: expected a name of letters, digits, _ and -, starting with a letter, at most 64 long, "
     "got none\n"},
    {"MissingShape", "\n[[obstacle]]\nname = 'ball'\nradius = 1\n",
     "s.toml:2:1: obstacle.ball.shape: expected sphere, box, cone, torus, cylinder, half_pipe, plane or mesh, got "
     "none\n"},
    {"MissingCameraPosition", kFloor + "[[camera]]\nname = 'main'\ntarget = [0, 0, 1]\n",
     "s.toml:2:1: camera.main.position: expected [x, y, z], each from -100000 to 100000 m, here or in the first of its "
     "keys, got none\n"},
    {"MissingKeyTime", "[[obstacle]]\nname = 'b'\nshape = 'box'\nkeys = [{ position = [0, 0, 1] }]\n",
     "s.toml:4:9: obstacle.b.keys.0.time: expected a number from -100000 to 100000 s, got none\n"},
    {"RotationTwice", "[[cloth]]\nname = 'band'\nquaternion = [1, 0, 0, 0]\nrotation = [0, 0, 90]\n",
     "s.toml:4:12: cloth.band.rotation: expected either rotation or quaternion, got both\n"},
    {"StepBesideTolerance", kFloor + "[time]\nstep = 0.01\ntolerance = 1e-4\n",
     "s.toml:3:8: time.step: expected either step or tolerance, got both\n"
     "s.toml:4:13: time.tolerance: expected either tolerance or step, got both\n"},
    {"OffsetBesidePosition",
     "[[cloth]]\nname = 'a'\n[[cloth.pin]]\nkeys = [{ time = 0, offset = [0, 0, 1], position = [0, 0, 1] }]\n",
     "s.toml:4:30: cloth.a.pin.0.keys.0.offset: expected either offset or position, got both\n"
     "s.toml:4:52: cloth.a.pin.0.keys.0.position: expected either position or offset, got both\n"},
    {"FollowBesideKeys", kFloor + "[[cloth]]\nname = 'a'\n[[cloth.pin]]\nfollow = 'floor'\nkeys = [{ time = 0 }]\n",
     "s.toml:5:10: cloth.a.pin.0.follow: expected either follow or keys, got both\n"},

    // Types.
    {"TextForNumber", kFloor + "[time]\nfps = \"fast\"\n",
     "s.toml:3:7: time.fps: expected a number > 0 and <= 1000 Hz, got the text \"fast\"\n"},
    {"LongTextIsCut", kFloor + "[time]\nfps = '" + std::string(39, 'a') + "\xc3\xa9 and more'\n",
     "s.toml:3:7: time.fps: expected a number > 0 and <= 1000 Hz, got the text \"" + std::string(39, 'a') + "...\"\n"},
    {"NumberForFlag", kFloor + "[contact]\nself = 1\n", "s.toml:3:8: contact.self: expected true or false, got 1\n"},
    {"DateForNumber", kFloor + "[time]\nfps = 2024-01-01\n",
     "s.toml:3:7: time.fps: expected a number > 0 and <= 1000 Hz, got a date or time\n"},
    {"NumberForText", "title = 3\n" + kFloor, "s.toml:1:9: title: expected a text, got 3\n"},
    {"FractionForWholeNumber", kFloor + "[render]\nwidth = 640.5\n",
     "s.toml:3:9: render.width: expected a whole number, got 640.5\n"},
    {"ValueForTable", kFloor + "time = 5\n", "s.toml:2:8: time: expected a table ([time]), got 5\n"},
    {"TableForList", "[cloth]\nname = 'band'\n",
     "s.toml:1:1: cloth: expected a list of tables ([[cloth]]), got a table\n"},
    {"ValueForInnerTable", "[[cloth]]\nname = 'a'\nmaterial = 'silk'\n",
     "s.toml:3:12: cloth.a.material: expected a table (material = { ... }), got the text \"silk\"\n"},
    {"TableForInnerList", "[[cloth]]\nname = 'a'\n[cloth.pin]\nlow = 0.5\n",
     "s.toml:3:1: cloth.a.pin: expected a list of tables (pin = [{ ... }, ...]), got a table\n"},
    {"NumberInList", kFloor + "cloth = [1]\n", "s.toml:2:10: cloth.0: expected a table, got 1\n"},
    {"ValueForKeys", "[[obstacle]]\nname = 'b'\nshape = 'box'\nkeys = 1\n",
     "s.toml:4:8: obstacle.b.keys: expected a list of tables (keys = [{ time = 0, ... }, ...]), got 1\n"},
    {"ArrayTooShort", kFloor + "[physics]\ngravity = [0, -9.81]\n",
     "s.toml:3:11: physics.gravity: expected [x, y, z], each from -100000 to 100000 m/s², got an array of 2 values\n"},
    {"ArrayTooLong", "[[cloth]]\nname = 'band'\nparticles = [8, 8, 8]\n",
     "s.toml:3:13: cloth.band.particles: expected a whole number or [weft, warp], each from 2 to 2000, got an array of "
     "3 values\n"},
    {"TextInArray", kFloor + "[physics]\nwind = [0, 'x', 0]\n",
     "s.toml:3:12: physics.wind: expected [x, y, z], each from -1000 to 1000 m/s, got the text \"x\"\n"},
    {"BadColor", kBand + "[render]\nsky_color = '#12345'\n",
     "s.toml:3:13: render.sky_color: expected [r, g, b], each from 0 to 1, or \"#rrggbb\", got the text \"#12345\"\n"},

    // Ranges.
    {"NegativeThickness", "[[cloth]]\nname = 'band'\nmaterial = { thickness = -0.001 }\n",
     "s.toml:3:26: cloth.band.material.thickness: expected > 0 m, got -0.001\n"},
    {"ZeroFps", kFloor + "[time]\nfps = 0\n", "s.toml:3:7: time.fps: expected > 0 Hz, got 0\n"},
    {"NotANumber", kFloor + "[time]\nstep = nan\n",
     "s.toml:3:8: time.step: expected a number from 1e-07 to 1 s, got nan\n"},
    {"Infinite", kFloor + "[physics]\nair_density = inf\n",
     "s.toml:3:15: physics.air_density: expected a number from 0 to 1000 kg/m³, got inf\n"},
    {"TooManyParticles", "[[cloth]]\nname = 'band'\nparticles = [2001, 2]\n",
     "s.toml:3:14: cloth.band.particles: expected <= 2000, got 2001\n"},
    {"TooManyParticlesTogether", "[[cloth]]\nname = 'a'\nparticles = 2000\n[[cloth]]\nname = 'b'\nparticles = [2, 3]\n",
     "s.toml:6:13: cloth.b.particles: expected at most 4000000 in all cloths together, got 4000006\n"},
    {"TooFewParticles", "[[cloth]]\nname = 'band'\nparticles = 1\n",
     "s.toml:3:13: cloth.band.particles: expected >= 2, got 1\n"},
    {"TooManyFrames", kFloor + "[time]\nduration = 3600\nfps = 1000\n",
     "s.toml:3:12: time.duration: expected at most 100000 frames (duration * fps), got 3600000\n"},
    {"TooManyStepsInAFrame", kFloor + "[time]\nfps = 1e-6\nstep = 1e-7\nduration = 1\n",
     "s.toml:4:8: time.step: expected at most 1e+09 steps in a frame (1 / (fps * step)), got 1e+13\n"},
    {"ZeroQuaternion", "[[cloth]]\nname = 'band'\nquaternion = [0, 0, 0, 0]\n",
     "s.toml:3:14: cloth.band.quaternion: expected at least one number that is not 0, got 0 in all\n"},
    {"TorusWithoutHole", "[[obstacle]]\nname = 't'\nshape = 'torus'\nradius = 0.1\ntube_radius = 0.2\n",
     "s.toml:5:15: obstacle.t.tube_radius: expected < 0.1 m, the radius, got 0.2\n"},
    {"BevelTooWide", "[[obstacle]]\nname = 'b'\nshape = 'box'\nsize = [1, 0.2, 1]\nbevel = 0.1\n",
     "s.toml:5:9: obstacle.b.bevel: expected < 0.1 m, half the shortest edge, got 0.1\n"},
    {"PinUpsideDown", "[[cloth]]\nname = 'band'\npin = [{ low = [0.5, 0], high = [0.2, 1] }]\n",
     "s.toml:3:33: cloth.band.pin.0.high: expected >= 0.5, the low end, got 0.2\n"},
    {"PinBetweenParticles", "[[cloth]]\nname = 'band'\nparticles = 3\npin = [{ low = [0.6, 0], high = [0.9, 1] }]\n",
     "s.toml:4:8: cloth.band.pin.0: expected a part that holds at least one particle, got one between two rows; the "
     "nearest along weft is at 0.5\n"},
    {"PinBetweenGradedParticles",
     "[[cloth]]\nname = 'band'\nparticles = 3\ngrading = 4\npin = [{ low = [0.4, 0], high = [0.6, 1] }]\n",
     "s.toml:5:8: cloth.band.pin.0: expected a part that holds at least one particle, got one between two rows; the "
     "nearest along weft is at 0.2\n"},
    {"PinAtAnEdgeOfASheet", "[[cloth]]\nname = 'band'\npin = [{ edge = 'front.top' }]\n",
     "s.toml:3:17: cloth.band.pin.0.edge: expected none for a cloth that is not shape = \"pattern\", got "
     "\"front.top\"\n"},
    {"PinFadesWithoutStrength", "[[cloth]]\nname = 'band'\npin = [{ high = [1, 0], fade = 0.1 }]\n",
     "s.toml:3:32: cloth.band.pin.0.fade: expected a strength beside it, got 0.1 m and none; to hold the part exactly "
     "and pull the cloth around it, write two pins: one without strength, and one with strength and fade\n"},
    {"GroupOfARectangle", "[[cloth]]\nname = 'band'\nweight = [{ vertex_group = 'hem' }]\n",
     "s.toml:3:28: cloth.band.weight.0.vertex_group: expected none for a cloth that is not shape = \"mesh\", got "
     "\"hem\"\n"},
    {"PinFollowsAPartOfAnObstacle",
     "[[obstacle]]\nname = 'ball'\nshape = 'sphere'\n[[cloth]]\nname = 'band'\npin = [{ follow = 'ball.top' }]\n",
     "s.toml:6:19: cloth.band.pin.0.follow: expected the name of a character before the part, got \"ball\"\n"},
    {"ObstaclesFollowEachOther",
     "[[obstacle]]\nname = 'a'\nshape = 'box'\nfollow = 'b'\n"
     "[[obstacle]]\nname = 'b'\nshape = 'box'\nfollow = 'c'\n"
     "[[obstacle]]\nname = 'c'\nshape = 'box'\nfollow = 'a'\n",
     "s.toml:4:10: obstacle.a.follow: expected an obstacle that does not follow this one, got \"b\", which follows "
     "it\n"},
    {"ObstacleFollowsItself", "[[obstacle]]\nname = 'a'\nshape = 'box'\nfollow = 'a'\n",
     "s.toml:4:10: obstacle.a.follow: expected an obstacle that does not follow this one, got \"a\", which it is "
     "itself\n"},
    {"ObstacleFollowsNothing",
     "[[obstacle]]\nname = 'floor'\nshape = 'plane'\n[[obstacle]]\nname = 'a'\nshape = 'box'\nfollow = 'flor'\n",
     "s.toml:7:10: obstacle.a.follow: expected the name of an obstacle, or a part of a character, got \"flor\"; did "
     "you "
     "mean floor?\n"},
    {"ObstacleFollowsACharacterWithoutAPart",
     "[[character]]\nname = 'man'\nsource = 'mannequin'\n[[obstacle]]\nname = 'a'\nshape = 'box'\nfollow = 'man'\n",
     "s.toml:7:10: obstacle.a.follow: expected a part of the character, such as \"man.torso\" or \"man.head\", got "
     "\"man\"\n"},
    {"CameraFollowsNothing",
     kFloor + "[[camera]]\nname = 'c'\nposition = [1, 2, 3]\ntarget = [0, 0, 0]\nfollow = 'ball'\n",
     "s.toml:6:10: camera.c.follow: expected the name of an obstacle, or a part of a character, got \"ball\"\n"},
    {"CameraTurnsWithNothing",
     kFloor + "[[camera]]\nname = 'c'\nposition = [1, 2, 3]\ntarget = [0, 0, 0]\nfollow_rotation = false\n",
     "s.toml:6:19: camera.c.follow_rotation: expected a follow beside it, got none\n"},
    {"LensTwice",
     kFloor + "[[camera]]\nname = 'c'\nposition = [1, 2, 3]\ntarget = [0, 0, 0]\nfield_of_view = 30\n"
              "focal_length = 50\n",
     "s.toml:7:16: camera.c.focal_length: expected either focal_length or field_of_view, got both\n"},
    {"LensesOfTwoKinds",
     kFloor + "[[camera]]\nname = 'c'\ntarget = [0, 0, 0]\nfocal_length = 50\n"
              "keys = [{ time = 0, position = [1, 0, 0] }, { time = 1, field_of_view = 30 }]\n",
     "s.toml:6:73: camera.c.keys.1.field_of_view: expected focal_length as in the keys before, got field_of_view\n"},
    {"SensorWithoutALens",
     kFloor + "[[camera]]\nname = 'c'\nposition = [1, 2, 3]\ntarget = [0, 0, 0]\nsensor_width = 23.6\n",
     "s.toml:6:16: camera.c.sensor_width: expected a focal_length beside it, got none\n"},
    {"PictureOfAnObstacleThatIsNone", "[[obstacle]]\nname = 'a'\nshape = 'box'\nlook.image = '/etc/passwd'\n",
     "s.toml:4:14: obstacle.a.look.image: expected a picture (PNG, JPEG or TGA), got \"/etc/passwd\": it begins like "
     "no "
     "picture\n"},
    {"CameraLooksAtItself", kFloor + "[[camera]]\nname = 'c'\nposition = [1, 2, 3]\ntarget = [1, 2, 3]\n",
     "s.toml:5:10: camera.c.target: expected a point away from position, got the same\n"},

    // Names and references.
    {"NameTwice", "[[cloth]]\nname = 'band'\n[[cloth]]\nname = 'band'\nsize = 0\n",
     "s.toml:4:8: cloth.1.name: expected a name used once, got \"band\" again\n"
     "s.toml:5:8: cloth.1.size: expected > 0 m, got 0\n"},
    {"NameOfClothAndCharacter", kBand + "[[character]]\nname = 'band'\nsource = 'sequence'\nfiles = '/none/*.obj'\n",
     "s.toml:3:8: character.band.name: expected a name used once, got \"band\", which a cloth, rope or obstacle has\n"
     "s.toml:5:9: character.band.files: expected a folder, or a file name with a *, of at least 2 files, got "
     "\"/none/*.obj\": 0 there\n"},
    {"StanceWithoutTime",
     "[[character]]\nname = 'a'\nsource = 'mannequin'\nstance_arms = 90\ndressing = 0.5\ngrow = 1.0\n",
     "s.toml:1:1: character.a.blend: expected > 0 s to get from the stance to the clip, got 0\n"
     "s.toml:6:8: character.a.grow: expected at most the 0.5 s of dressing, in which it stands, got 1\n"},
    {"KeyOfTheOtherSource", "[[character]]\nname = 'a'\nsource = 'sequence'\nloop = true\n",
     "s.toml:1:1: character.a.files: expected a text, got none\n"
     "s.toml:4:1: character.a.loop: unknown key of a sequence; it belongs to file or mannequin\n"},
    {"NameOfClothAndObstacle", kBand + "[[obstacle]]\nname = 'band'\nshape = 'box'\n",
     "s.toml:3:8: obstacle.band.name: expected a name used once, got \"band\", which a cloth or rope has\n"},
    {"NameThatIsAPath", "[[cloth]]\nname = '../band'\n",
     "s.toml:2:8: cloth.0.name: expected a name of letters, digits, _ and -, starting with a letter, at most 64 long, "
     "got \"../band\"\n"},
    {"UnknownFabric", "[[cloth]]\nname = 'band'\n[cloth.material]\nfabric = 'coton'\n",
     "s.toml:4:10: cloth.band.material.fabric: expected cotton, poplin, denim, canvas, linen, jersey, wool, suiting, "
     "felt, silk, satin, chiffon, polyester, faille, ripstop or leather, got \"coton\"; did you mean cotton?\n"},
    {"UnknownShape", "[[obstacle]]\nname = 'b'\nshape = 'shpere'\nradius = 1\n",
     "s.toml:3:9: obstacle.b.shape: expected sphere, box, cone, torus, cylinder, half_pipe, plane or mesh, got "
     "\"shpere\"; did you mean sphere?\n"},
    {"UnknownIntegrator", kFloor + "[time]\nintegrator = 'bdf3'\n",
     "s.toml:3:14: time.integrator: expected implicit_euler, implicit_midpoint or bdf2, got \"bdf3\"; did you mean "
     "bdf2?\n"},
    {"FollowsAPartOfNothing", kFloor + "[[cloth]]\nname = 'a'\npin = [{ follow = '.head' }]\n",
     "s.toml:4:19: cloth.a.pin.0.follow: expected the name of an obstacle or character, got \".head\"\n"},
    {"FollowsNothing", kFloor + "[[cloth]]\nname = 'a'\npin = [{ follow = 'flor' }]\n",
     "s.toml:4:19: cloth.a.pin.0.follow: expected the name of an obstacle or character, got \"flor\"; did you mean "
     "floor?\n"},
    {"UnknownCamera", kFloor + "[render]\ncamera = 'main'\n",
     "s.toml:3:10: render.camera: expected the name of a camera, got \"main\"\n"},
    {"KeysOutOfOrder",
     "[[obstacle]]\nname = 'b'\nshape = 'box'\nkeys = [{ time = 0 }, { time = 2 }, { time = 2 }, { time = 1 }]\n",
     "s.toml:4:46: obstacle.b.keys.2.time: expected > 2 s, later than the keys before, got 2\n"
     "s.toml:4:60: obstacle.b.keys.3.time: expected > 2 s, later than the keys before, got 1\n"},
    {"TurnsWithoutAnAxis",
     "[[obstacle]]\nname = 'b'\nshape = 'box'\n"
     "keys = [{ time = 0 }, { time = 1, rotation = [0, 0, 720] }, { time = 2, rotation = [10, 0, 1000] }]\n",
     "s.toml:4:84: obstacle.b.keys.2.rotation: expected that since the key before only one angle changes, or none by "
     "more than 180 degrees; got changes of [10, 0, 280] degrees\n"},
    {"MissingMesh", "[[obstacle]]\nname = 'b'\nshape = 'mesh'\nfile = '/no/such.obj'\n",
     "s.toml:4:8: obstacle.b.file: expected a readable file, got \"/no/such.obj\": there is no /no/such.obj\n"},
    {"MeshIsAFolder", "[[obstacle]]\nname = 'b'\nshape = 'mesh'\nfile = '/'\n",
     "s.toml:4:8: obstacle.b.file: expected a readable file, got \"/\": / is not a file\n"},

    // All mistakes are reported at once, in their order in the file, not in the order of the rules.
    {"AllMistakesInFileOrder",
     "[render]\nwidth = 1\n[[light]]\nkind = 'spot'\n[[cloth]]\nname = 'band'\nsize = [0, 1]\nsise = 2\n[time]\nfps = "
     "-1\nstep = 'x'\n",
     "s.toml:2:9: render.width: expected >= 16, got 1\n"
     "s.toml:3:1: light.0.name: expected a name of letters, digits, _ and -, starting with a letter, at most 64 long, "
     "got none\n"
     "s.toml:7:9: cloth.band.size: expected > 0 m, got 0\n"
     "s.toml:8:1: cloth.band.sise: unknown key; did you mean size?\n"
     "s.toml:10:7: time.fps: expected > 0 Hz, got -1\n"
     "s.toml:11:8: time.step: expected a number from 1e-07 to 1 s, got the text \"x\"\n"},
};

class MalformedScene : public testing::TestWithParam<Malformed> {};

TEST_P(MalformedScene, IsReportedInExactlyTheseWords) {
  const LoadResult result = load_text(GetParam().text, "s.toml");
  EXPECT_FALSE(result.ok());
  EXPECT_EQ(result.describe(), GetParam().messages);
}

INSTANTIATE_TEST_SUITE_P(Scene, MalformedScene, testing::ValuesIn(kMalformed),
                         [](const auto& test) { return test.param.claim; });

class SceneFile : public support::TestFolder {
 protected:
  std::string messages(const std::filesystem::path& file) { return load(file).describe(); }
};

TEST_F(SceneFile, ThatIsMissingIsNamed) {
  EXPECT_EQ(messages(folder_ / "no.toml"),
            (folder_ / "no.toml").string() + ": expected a scene file, got no such file\n");
}

TEST_F(SceneFile, WithoutANameIsRefused) {
  EXPECT_TRUE(messages("").starts_with(": expected a scene file, got no such file\n")) << messages("");
}

TEST_F(SceneFile, ThatIsAFolderIsRefused) {
  EXPECT_EQ(messages(folder_), folder_.string() + ": expected a scene file, got a folder\n");
}

TEST_F(SceneFile, ThatIsAPipeIsRefusedWithoutWaitingForIt) {
  const auto pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(messages(pipe), pipe.string() + ": expected a scene file, got a device or pipe\n");
}

TEST_F(SceneFile, OfAGigabyteIsRefusedByItsSize) {
  const auto file = folder_ / "big.toml";
  std::ofstream(file) << "# big";
  std::filesystem::resize_file(file, std::uintmax_t{1} << 30);  // sparse: occupies no disk space
  EXPECT_EQ(messages(file), file.string() + ": expected at most 16 MB, got 1024 MB\n");
}

TEST_F(SceneFile, ThatCannotBeOpenedSaysWhy) {
  if (geteuid() == 0) GTEST_SKIP() << "root opens every file";
  const auto file = folder_ / "secret.toml";
  std::ofstream(file) << kFloor;
  std::filesystem::permissions(file, std::filesystem::perms::none);
  EXPECT_EQ(messages(file),
            file.string() + ": expected a scene file, got a file that cannot be read: Permission denied\n");
}

TEST_F(SceneFile, IsPrintedTheWayItWasGiven) {
  std::ofstream(folder_ / "a.toml") << kFloor << "x = 1\n";
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder_);
  const std::string text = messages("./../" / folder_.filename() / "a.toml");
  std::filesystem::current_path(before);
  EXPECT_EQ(text.substr(0, text.find(": ")), "./../" + folder_.filename().string() + "/a.toml:2:1");
}

TEST(Mistakes, BeyondTheFirstTwoHundredAreCounted) {
  std::string text = kFloor;
  for (int i = 0; i < 5000; ++i) text += "k" + std::to_string(i) + " = 1\n";
  const LoadResult result = load_text(text, "s.toml");
  ASSERT_EQ(result.mistakes.size(), kMaxMistakes + 1);
  for (std::size_t i = 0; i < kMaxMistakes; ++i) EXPECT_EQ(result.mistakes[i].line, static_cast<int>(i) + 2);
  EXPECT_EQ(result.mistakes.back().text, "4800 further mistakes are not listed");
}

TEST(Mistakes, AreClearedAlsoThoseThatAreOnlyCounted) {
  Findings findings;
  for (std::size_t i = 0; i <= kMaxMistakes; ++i) findings.report("k" + std::to_string(i), "expected none");
  EXPECT_EQ(findings.take_mistakes().back().text, "1 further mistakes are not listed");
  EXPECT_TRUE(findings.take_mistakes().empty());
}

TEST(Mistakes, OfADeeplyDottedKeyDoNotExhaustTheStack) {
  std::string key = "a";
  for (int i = 0; i < 1'000'000; ++i) key += ".a";
  const std::string expected =
      "s.toml:1:1: not TOML: expected at most 128 levels of lists, tables and dotted keys, got more\n";
  EXPECT_EQ(load_text(key + " = 1\n", "s.toml").describe(), expected);
  EXPECT_EQ(load_text("time = {" + key + " = 1}\n", "s.toml").describe(), expected);
  EXPECT_NE(load_text(kFloor, "s.toml", {"time={" + key + "=1}"}).describe(), "");
}

TEST(Mistakes, OfANameThatCannotNameOutputsAreSaidBeforeAnythingElse) {
  for (const char* name : {"", "a\nb.toml", "a\x1b[2J.toml", "...toml", "a\x7f.toml", "\t.toml", "a\xC2\x9Bm.toml"})
    EXPECT_NE(load_text(kFloor, name).describe().find("expected a file whose name without its ending can name outputs"),
              std::string::npos)
        << name;
  for (const char* name : {"a.toml", "a b.toml", "..a.toml", "ä.toml", "a"})
    EXPECT_EQ(load_text(kFloor, name).describe(), "") << name;
}

TEST(Mistakes, OfKeysThatAreTooNearAndOfPairsThatNeverMeetAreSaid) {
  const auto mistakes_of = [](const std::string& text) { return load_text(text, "s.toml").describe(); };
  const std::string ball = "\n[[obstacle]]\nname = \"ball\"\nshape = \"sphere\"\n";
  const auto keys = [&](const char* time) {
    return mistakes_of(ball + "keys = [{time = 0, position = [0,0,0]}, {time = " + time + ", position = [0,0,1]}]\n");
  };
  EXPECT_EQ(keys("1e-6"), "");
  EXPECT_NE(keys("1e-300").find("expected at least 1e-07 s after the key before, at 0 s, got 1e-300"),
            std::string::npos)
      << keys("1e-300");
  const auto pair = [&](const char* a, const char* b) {
    return mistakes_of(ball + "[[cloth]]\nname = \"c\"\n[[contact.pair]]\nfirst = \"" + a + "\"\nsecond = \"" + b +
                       "\"\nfriction = 0.1\n");
  };
  EXPECT_EQ(pair("c", "ball"), "");
  EXPECT_EQ(pair("c", "c"), "");
  EXPECT_NE(pair("ball", "ball").find("expected a cloth or rope as one of the two"), std::string::npos)
      << pair("ball", "ball");
}

}  // namespace
}  // namespace weft::scene
