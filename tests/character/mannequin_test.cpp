#include "film/character/mannequin.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <numbers>
#include <utility>

#include "film/character/mannequin_shape.hpp"
#include "physics/mesh/geometry.hpp"
#include "physics/mesh/topology.hpp"
#include "posed_mannequin.hpp"
#include "support/intersections.hpp"
#include "support/mesh_measures.hpp"

namespace weft::character {
namespace {

/// The default build with edges of this length [m]. Each build is made only once.
const Character& standard(double edge_length = 0.02) {
  static std::map<double, Character> made;
  const auto found = made.find(edge_length);
  if (found != made.end()) return found->second;
  return made.emplace(edge_length, make_mannequin({.edge_length = edge_length})).first->second;
}

/// Length [m] of the intersection of the mesh with a plane; counts only points for which `take` returns true.
double girth(const Character& body, const Vec3& at, const Vec3& normal, const std::function<bool(const Vec3&)>& take) {
  double length = 0;
  for (const auto& t : body.mesh.topology.triangles) {
    std::vector<Vec3> cut;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = body.mesh.positions[t[k]];
      const Vec3& q = body.mesh.positions[t[(k + 1) % 3]];
      const double a = (p - at).dot(normal), b = (q - at).dot(normal);
      if ((a < 0) != (b < 0)) cut.push_back(p + a / (a - b) * (q - p));
    }
    if (cut.size() == 2 && take(cut[0])) length += (cut[1] - cut[0]).norm();
  }
  return length;
}

double smallest_angle(const mesh::Mesh& mesh) {
  double least = std::numbers::pi;
  for (const auto& t : mesh.topology.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto corner = [&](std::size_t c) { return mesh.positions[t[(k + c) % 3]]; };
      const Vec3 a = corner(1) - corner(0), b = corner(2) - corner(0);
      least = std::min(least, std::atan2(a.cross(b).norm(), a.dot(b)));
    }
  }
  return least * 180 / std::numbers::pi;
}

double mean_edge(const mesh::Mesh& mesh) {
  double sum = 0;
  const auto edges = mesh::collect_edges(mesh.topology.triangles).edges;
  for (const auto& e : edges) {
    sum += (mesh.positions[e.vertices[0]] - mesh.positions[e.vertices[1]]).norm();
  }
  return sum / static_cast<double>(edges.size());
}

void expect_whole(const Character& body) {
  const auto& triangles = body.mesh.topology.triangles;
  EXPECT_TRUE(support::watertight(mesh::inspect(triangles, body.mesh.positions.size())));
  const auto edges = mesh::collect_edges(triangles).edges.size();
  EXPECT_EQ(body.mesh.positions.size() + triangles.size() - edges, 2U) << "not a sphere with limbs";
  const double height = mesh::bounding_box(body.mesh.positions).max().z();
  EXPECT_GT(support::enclosed_volume(triangles, body.mesh.positions), 0.007 * std::pow(height, 3)) << "inside out";
  const support::TestedObject object{"body", true, body.mesh.positions, triangles};
  const auto intersections = support::find_intersections(std::span(&object, 1));
  EXPECT_TRUE(intersections.pairs.empty()) << intersections.pairs.size();
  EXPECT_TRUE(intersections.degenerate.empty());
}

// The expected lengths are fractions of the body height, from Drillis & Contini (1966), in Winter, Fig. 4.1.
TEST(Mannequin, HasPublishedProportionsAtAnyHeight) {
  for (const double h : {1.5, 1.75, 1.95}) {
    const MannequinBuild build{.height = h, .edge_length = 0.03};
    const Character body = h == MannequinBuild{}.height ? standard(0.03) : make_mannequin(build);
    const auto at = mannequin_joints(build);
    const auto distance = [&](Joint a, Joint b) { return (at[joint_index(a)] - at[joint_index(b)]).norm() / h; };
    EXPECT_NEAR(at[joint_index(Joint::left_foot)].z() / h, 0.039, 1e-12);
    EXPECT_NEAR(at[joint_index(Joint::left_lower_leg)].z() / h, 0.285, 1e-12);
    EXPECT_NEAR(at[joint_index(Joint::left_upper_leg)].z() / h, 0.530, 1e-12);
    EXPECT_NEAR(distance(Joint::left_upper_arm, Joint::left_lower_arm), 0.186, 1e-12);
    EXPECT_NEAR(distance(Joint::left_lower_arm, Joint::left_hand), 0.146, 1e-12);
    // The legs slope outward by less than two degrees.
    EXPECT_NEAR(distance(Joint::left_upper_leg, Joint::left_lower_leg), 0.245, 0.001);
    EXPECT_NEAR(distance(Joint::left_lower_leg, Joint::left_foot), 0.246, 0.001);

    // Tolerances: up to a hundredth of the height. The mesh is inside of the surface, on which its vertices lie.
    const Box3 box = mesh::bounding_box(body.mesh.positions);
    EXPECT_NEAR(box.min().z() / h, 0, 0.001);
    EXPECT_NEAR(box.max().z() / h, 1, 0.003);
    const Vec3 along = (at[joint_index(Joint::left_hand)] - at[joint_index(Joint::left_lower_arm)]).normalized();
    double finger = 0, heel = -1, toe = 1, shoulder = 0, ball = 0;
    for (const Vec3& p : body.mesh.positions) {
      if (p.x() > 0.3 * h) finger = std::max(finger, (p - at[joint_index(Joint::left_hand)]).dot(along));
      if (p.z() < 0.06 * h) heel = std::max(heel, p.y()), toe = std::min(toe, p.y());
      if (std::abs(p.x() - at[joint_index(Joint::left_upper_arm)].x()) < 0.01 * h) shoulder = std::max(shoulder, p.z());
    }
    for (const Vec3& p : body.mesh.positions) {
      if (p.z() < 0.03 * h && p.x() > 0) ball = std::max(ball, 2 * (p.x() - at[joint_index(Joint::left_toes)].x()));
    }
    EXPECT_NEAR(finger / h, 0.108, 0.01);
    EXPECT_NEAR((heel - toe) / h, 0.152, 0.01);
    EXPECT_NEAR(ball / h, 0.055, 0.01);
    EXPECT_NEAR(shoulder / h, 0.818, 0.01);
  }
}

TEST(Mannequin, GirthsAreThoseOfASlenderWomanAndGrowWithTheBuild) {
  const auto middle = [](const Vec3& p) { return std::abs(p.x()) < 0.19; };
  const auto left = [](const Vec3& p) { return p.x() > 0 && p.x() < 0.3; };
  const auto all = [](const Vec3&) { return true; };
  struct Place {
    const char* what;
    double height, least, most;
    std::function<bool(const Vec3&)> take;
  };
  const std::vector<Place> places{
      {"bust", 1.262, 0.80, 0.95, middle}, {"waist", 1.11, 0.60, 0.70, middle}, {"hips", 0.89, 0.86, 0.98, middle},
      {"thigh", 0.76, 0.48, 0.58, left},   {"calf", 0.34, 0.31, 0.37, left},    {"ankle", 0.12, 0.17, 0.22, left},
      {"neck", 1.51, 0.28, 0.35, all},
  };
  const Character heavier = make_mannequin({.girth = 1.15, .edge_length = 0.03});
  for (const Place& place : places) {
    const double length = girth(standard(), Vec3(0, 0, place.height), Vec3::UnitZ(), place.take);
    EXPECT_GT(length, place.least) << place.what;
    EXPECT_LT(length, place.most) << place.what;
    EXPECT_GT(girth(heavier, Vec3(0, 0, place.height), Vec3::UnitZ(), place.take), 1.05 * length) << place.what;
  }
}

TEST(Mannequin, IsClosedAndFreeOfSelfIntersections) {
  for (const double edge : {0.02, 0.03, 0.04}) expect_whole(standard(edge));
}

void expect_whole(const MannequinBuild& build) {
  SCOPED_TRACE(testing::Message() << build.height << ' ' << build.girth << ' ' << build.masculinity);
  expect_whole(make_mannequin(build));
}

// For any two of the three parameters (height, girth, masculinity), all four combinations of their extremes occur.
TEST(Mannequin, IsWholeInExtremeBuilds) {
  for (const auto& [height, girth_of, masculinity] :
       {std::array{1.2, 0.9, 0.0}, std::array{1.95, 0.9, 1.0}, std::array{1.95, 1.3, 0.0}, std::array{1.2, 1.3, 1.0}})
    expect_whole(MannequinBuild{height, girth_of, masculinity, 0.035});
}

TEST(SlowMannequin, IsWholeInEveryBuild) {
  for (const double girth_of : {0.9, 1.3})
    for (const double masculinity : {0.0, 1.0})
      for (const double height : {1.2, 1.95})
        for (const double edge : {0.025, 0.035}) expect_whole(MannequinBuild{height, girth_of, masculinity, edge});
}

TEST(Mannequin, HasTrianglesOfTheLengthAskedForAndOfGoodShape) {
  // Head, hands and feet have shorter edges, which do not grow with a requested length above 0.02 m. Measured: the mean
  // edge is 0.60, 0.60 and 0.32 of the requested length.
  for (const auto& [edge, share] : {std::pair(0.015, 0.60), std::pair(0.02, 0.60), std::pair(0.04, 0.32)}) {
    const Character& body = standard(edge);
    EXPECT_NEAR(mean_edge(body.mesh) / edge, share, 0.03) << edge;
    EXPECT_GT(smallest_angle(body.mesh), 19.5) << edge;  // measured: 19.99 and more
  }
}

/// How far the middle of the face reaches forward (-y) at the height `up`; both in centimetres, for a body of 1.75 m.
double profile(const Character& body, double up) {
  double forward = -20;
  for (const auto& e : mesh::collect_edges(body.mesh.topology.triangles).edges) {
    const Vec3 a = 100 * body.mesh.positions[e.vertices[0]], b = 100 * body.mesh.positions[e.vertices[1]];
    if ((a.z() < up) == (b.z() < up) || a.x() != 0 || b.x() != 0) continue;
    const double t = (up - a.z()) / (b.z() - a.z());
    forward = std::max(forward, -(a.y() + t * (b.y() - a.y())));
  }
  return forward;
}

// Heights of the features [cm] are those in the tables of the mannequin. Each feature is larger than the error of the
// triangles.
TEST(Mannequin, HasAFaceInProfileAndEarsAndFingers) {
  const Character& body = standard();
  const double root = profile(body, 164.5), tip = profile(body, 160.6), below = profile(body, 158.8),
               upper = profile(body, 157.8), lower = profile(body, 156.6), groove = profile(body, 155.7),
               chin = profile(body, 154.8);
  EXPECT_GT(tip, root + 1);
  EXPECT_GT(tip, below + 1);
  EXPECT_GT(upper, below);
  EXPECT_GT(lower, groove + 0.1);
  EXPECT_GT(chin, 6);
  // Ears project from the head, which is narrower above and below them.
  double ear = 0, temple = 0;
  for (const Vec3& p : body.mesh.positions) {
    if (p.y() < 0 || p.y() > 0.05) continue;
    if (std::abs(p.z() - 1.635) < 0.02) ear = std::max(ear, p.x());
    if (p.z() > 1.675 && p.z() < 1.75) temple = std::max(temple, p.x());
  }
  EXPECT_GT(ear, temple + 0.003);
  // The hand is thinner between two fingers than on them.
  const BlendedBody surface = mannequin_body({});
  const auto at = mannequin_joints({});
  const Vec3 along = (at[joint_index(Joint::left_hand)] - at[joint_index(Joint::left_lower_arm)]).normalized();
  const Vec3 out(-along.z(), 0, along.x());
  const auto back = [&](double forward) {  // height [m] of the back of the hand, 12 cm beyond the wrist
    const Vec3 middle = at[joint_index(Joint::left_hand)] + 0.12 * along - 0.01 * forward * Vec3::UnitY();
    for (double height = 0.03; height > -0.06; height -= 1e-4)
      if (surface(middle + height * out) < 0) return height;
    return -0.06;
  };
  // Counts a ridge where the back of the hand rises and then falls by at least half a millimetre.
  int ridges = 0;
  double high = 1, low = 1;
  for (double forward = -4; forward < 4; forward += 0.05) {
    const double here = back(forward);
    if (here < low) low = high = here;
    high = std::max(high, here);
    if (high > low + 5e-4 && here < high - 5e-4) {
      ++ridges;
      low = high = here;
    }
  }
  EXPECT_EQ(ridges, 4);
}

TEST(Mannequin, VerticesLieOnTheSurface) {
  const BlendedBody surface = mannequin_body({});
  for (const Vec3& p : standard().mesh.positions) {
    if (p.z() < 0.02) continue;  // soles are cut flat
    const double h = 1e-6;
    Vec3 slope;
    for (int k = 0; k < 3; ++k) slope[k] = (surface(p + h * Vec3::Unit(k)) - surface(p - h * Vec3::Unit(k))) / (2 * h);
    // Tolerance 1e-5 m: ten times the measured error. The mesher moves vertices by two Newton steps per round.
    EXPECT_LT(std::abs(surface(p)) / slope.norm(), 1e-5) << p.transpose();
  }
}

TEST(Mannequin, IsItsOwnMirrorImageToTheBit) {
  const Character& body = standard();
  const auto less = [](const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  std::vector<Vec3> here = body.mesh.positions, there;
  for (const Vec3& p : here) there.emplace_back(0.0 - p.x(), p.y(), p.z());
  std::sort(here.begin(), here.end(), less);
  std::sort(there.begin(), there.end(), less);
  EXPECT_EQ(here, there);
}

TEST(Mannequin, SkinWeightsAddUpAndAreSmoothAndMirrored) {
  const Character& body = standard();
  ASSERT_EQ(body.first_influence.size(), body.mesh.positions.size() + 1);
  std::vector<double> largest(kJointCount, 0);
  for (std::size_t v = 0; v < body.mesh.positions.size(); ++v) {
    const auto count = body.first_influence[v + 1] - body.first_influence[v];
    EXPECT_GE(count, 1);
    EXPECT_LE(count, 4);
    double sum = 0;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const double w = weight_of(body, v, static_cast<Joint>(j));
      EXPECT_GE(w, 0);
      sum += w;
      largest[j] = std::max(largest[j], w);
    }
    EXPECT_NEAR(sum, 1, 1e-12);
  }
  for (std::size_t j = 0; j < kJointCount; ++j) EXPECT_GT(largest[j], 0.9) << name(static_cast<Joint>(j));
  for (std::size_t j = 5; j < 13; ++j) EXPECT_EQ(largest[j], largest[j + kSideJointCount]);
  // The shortest distance over which a weight rises from 0 to 1 is 4 cm, at the toes: its slope is at most 1.875 / 0.04
  // per metre. Between the thighs, the distance is a quarter of that, so the test skips edges there.
  for (const auto& e : mesh::collect_edges(body.mesh.topology.triangles).edges) {
    const auto [a, b] = std::pair(static_cast<std::size_t>(e.vertices[0]), static_cast<std::size_t>(e.vertices[1]));
    const double length = (body.mesh.positions[a] - body.mesh.positions[b]).norm();
    const bool between_thighs = std::abs(body.mesh.positions[a].x()) < 0.04 && body.mesh.positions[a].z() < 0.84;
    if (between_thighs) continue;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const auto joint = static_cast<Joint>(j);
      EXPECT_LT(std::abs(weight_of(body, a, joint) - weight_of(body, b, joint)), 55 * length)
          << name(joint) << ' ' << body.mesh.positions[a].transpose();
    }
  }
}

TEST(Mannequin, LooksTheSameInTheClipThatKeepsItAtRest) {
  const Character& body = standard();
  Clip rest;
  rest.channels.resize(kJointCount);
  for (Channel& channel : rest.channels) channel.rotation.values = {Quat::Identity()};
  rest.channels[0].position.values = {Vec3(body.nodes[0].local.translation())};
  const auto posed = skinned(body, joints_at_key(body, rest, 0));
  for (std::size_t v = 0; v < posed.size(); ++v) EXPECT_LT((posed[v] - body.mesh.positions[v]).norm(), 1e-14);
}

TEST(Mannequin, IsTheSameEveryTime) {
  const Character& before = standard(0.03);
  make_mannequin({.edge_length = 0.1});  // the last build is kept
  const Character again = make_mannequin({.edge_length = 0.03});
  ASSERT_EQ(again.mesh.positions.size(), before.mesh.positions.size());
  EXPECT_EQ(std::memcmp(again.mesh.positions.data(), before.mesh.positions.data(),
                        again.mesh.positions.size() * sizeof(Vec3)),
            0);
  EXPECT_EQ(again.mesh.topology.triangles, before.mesh.topology.triangles);
}

}  // namespace
}  // namespace weft::character
