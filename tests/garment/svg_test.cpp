// Outlines from drawings: units, transforms, and files that are damaged.
#include "film/garment/svg.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include "film/garment/pattern.hpp"
#include "film/garment/triangulation.hpp"
#include "support/test_folder.hpp"

namespace weft::garment {
namespace {

// Distance of the ends of a curve [m].
double span_of(const Curve& curve) {
  return (curve.end() - curve.start()).norm();
}

class Drawings : public support::TestFolder {
 protected:
  Outline load(const std::string& svg, const std::string& id = "p") {
    support::write_bytes(folder_ / "d.svg", svg);
    return load_svg_panel(folder_ / "d.svg", id).outline;
  }
  void expect_corners(const std::string& svg, const std::vector<Vec2>& corners) {
    const Outline outline = load(svg);
    ASSERT_EQ(outline.size(), corners.size()) << svg;
    for (std::size_t k = 0; k < corners.size(); ++k)
      EXPECT_LT((outline[k].start() - corners[k]).norm(), 1e-12) << svg << ": " << outline[k].start().transpose();
  }
  void expect_refused(const std::string& svg, const std::string& words) {
    support::expect_error(ExitCode::asset_unreadable, words, [&] { load(svg); });
  }
};

TEST_F(Drawings, LengthsAreThoseOfTheSheet) {
  const std::string path = "<path id='p' d='M10 20h100v50z'/></svg>";
  // One unit is a millimetre, a tenth of an inch, or a pixel. In the file, y points down.
  expect_corners("<svg width='210mm' height='297mm' viewBox='0 0 210 297'>" + path,
                 {{0.01, -0.02}, {0.11, -0.02}, {0.11, -0.07}});
  expect_corners("<svg width='20in' viewBox='0 0 200 300'>" + path,
                 {{0.0254, -0.0508}, {0.2794, -0.0508}, {0.2794, -0.1778}});
  const double px = 0.0254 / 96;
  expect_corners("<svg>" + path, {{10 * px, -20 * px}, {110 * px, -20 * px}, {110 * px, -70 * px}});
  // If width and height give different scales, the smaller one is used.
  expect_corners("<svg width='420mm' height='297mm' viewBox='0 0 210 297'>" + path,
                 {{0.01, -0.02}, {0.11, -0.02}, {0.11, -0.07}});
}

TEST_F(Drawings, AreNotStretched) {
  const auto sheet = [](const std::string& width, const std::string& ratio) {
    return "<svg width='" + width + "' height='297mm' viewBox='0 0 210 297' preserveAspectRatio='" + ratio +
           "'><path id='p' d='M10 20h100v50z'/></svg>";
  };
  const std::vector<Vec2> corners{{0.01, -0.02}, {0.11, -0.02}, {0.11, -0.07}};
  expect_corners(sheet("420mm", "xMinYMin meet"), corners);
  expect_corners(sheet("210mm", "none"), corners);
  expect_refused(sheet("420mm", "none"), "preserveAspectRatio: expected meet");
  expect_refused(sheet("420mm", "xMidYMid slice"), "got \"xMidYMid slice\"");
}

TEST_F(Drawings, TransformsOfElementAndGroupsApply) {
  const std::string head = "<svg width='1000mm' viewBox='0 0 1000 1000'>";
  expect_corners(head +
                     "<g transform='translate(100 0) scale(2)'><polygon id='p' transform='rotate(90)' "
                     "points='0,0 10,0 10,5'/></g></svg>",
                 {{0.1, 0}, {0.1, -0.02}, {0.09, -0.02}});
  expect_corners(
      head + "<rect id='p' x='1' y='2' width='30' height='40' transform='matrix(1 0 0 1 4,5) skewX(45)'/></svg>",
      {{0.007, -0.007}, {0.037, -0.007}, {0.077, -0.047}, {0.047, -0.047}});
}

TEST_F(Drawings, RectanglesMayHaveRoundCorners) {
  const auto area = [&](const std::string& radii) {
    const Outline outline = load(
        "<svg width='1000mm' viewBox='0 0 1000 1000'><rect id='p' x='100' y='200' width='400' "
        "height='200' " +
        radii + "/></svg>");
    return std::abs(polygon_area(sample_points(outline)));
  };
  // Elliptic corners with radii a and b remove (4 - π) a b of the area.
  const double corner = 4 - std::numbers::pi;
  EXPECT_NEAR(area(""), 0.08, 1e-12);
  EXPECT_NEAR(area("rx='0' ry='50'"), 0.08, 1e-12);
  EXPECT_NEAR(area("rx='50'"), 0.08 - corner * 0.05 * 0.05, 1e-4);
  EXPECT_NEAR(area("rx='50' ry='20'"), 0.08 - corner * 0.05 * 0.02, 1e-4);
  EXPECT_NEAR(area("rx='900'"), 0.08 - corner * 0.2 * 0.1, 3e-4) << "an ellipse";
  expect_refused("<svg><rect id='p' width='1' height='1' rx='a'/></svg>", "rx and ry as numbers");
}

TEST_F(Drawings, CirclesAndEllipsesAreOneCurve) {
  const std::string head = "<svg width='1000mm' viewBox='0 0 1000 1000'>";
  for (const auto& [element, radii] :
       {std::pair("<circle id='p' cx='100' cy='200' r='50'/>", Vec2(0.05, 0.05)),
        std::pair("<ellipse id='p' cx='100' cy='200' rx='50' ry='20'/>", Vec2(0.05, 0.02))}) {
    const Outline outline = load(head + element + "</svg>");
    EXPECT_EQ(std::ranges::count(outline, false, &Curve::continues_arc), 1) << element;
    // An inscribed polygon of 64 sides has an area that is smaller by 5e-3 of the product of the radii.
    EXPECT_NEAR(std::abs(polygon_area(sample_points(outline))), std::numbers::pi * radii.prod(), 1e-2 * radii.prod());
    for (const Vec2& p : sample_points(outline))
      EXPECT_NEAR((p - Vec2(0.1, -0.2)).cwiseQuotient(radii).norm(), 1, 3e-4) << element;
    support::write_bytes(folder_ / "p.toml", "[[panel]]\nname = 'round'\nfile = 'd.svg'\nid = 'p'\nedges = 'rim'\n");
    EXPECT_EQ(load_pattern(folder_ / "p.toml", "a test").panels.at(0).edges.size(), 1U) << element;
  }
  const Vec2 start = load(head + "<circle cx='1' cy='1' r='9'/></svg>", "circle:1").front().start();
  EXPECT_LT((start - Vec2(0.01, -0.001)).norm(), 1e-12);
  expect_refused("<svg><circle id='p' cx='1'/></svg>", "the centre and radii > 0 as numbers");
  expect_refused("<svg><ellipse id='p' rx='1' ry='50%'/></svg>", "the centre and radii > 0 as numbers");
}

TEST_F(Drawings, PolylinesAreOutlinesIfTheyAreClosed) {
  const std::string head = "<svg width='10mm' viewBox='0 0 10 10'><polyline id='p' points='";
  expect_corners(head + "1,0 2,0 2,1 1,0'/></svg>", {{0.001, 0}, {0.002, 0}, {0.002, -0.001}});
  expect_refused(head + "1,0 2,0 2,1'/></svg>", "which ends with Z or where it starts, got one that is open");
}

// Buttons and notches are drawn as circles, too.
TEST_F(Drawings, CirclesInAGroupAreOutlinesIfThereIsNoOther) {
  const std::string head = "<svg><g id='p'>", circle = "<circle cx='1' cy='1' r='1'/>";
  EXPECT_NEAR(load(head + circle + "<polyline points='0,0 1,1 2,0'/></g></svg>").front().start().y(), -0.0254 / 96,
              1e-12);
  EXPECT_EQ(load(head + circle + circle + "<path d='M0 0L9 0L0 9Z'/></g></svg>").size(), 3U);
  expect_refused(head + circle + circle + "</g></svg>", "one closed outline, got 2");
}

TEST_F(Drawings, WhatIsNoneIsRefusedWithFileLineColumnAndElement) {
  expect_refused("<svg>\n  <path id='p' d='M0 0L1 x'/></svg>", "d.svg:2:4: path \"p\": expected a number, got \"x\"");
  expect_refused("<svg>\n\n<path id='q' d='M0 0L1 1L0 1Z'/></svg>", "the id or label \"p\"");
  expect_refused("<svg><line id='p' x2='1'/></svg>", "path, polygon, closed polyline, rect, circle or ellipse");
  expect_refused("<svg viewBox='0 0 0 1' width='1mm'><path id='p' d='M0 0L1 1L0 1Z'/></svg>", "viewBox");
  expect_refused("<svg>\n<path id='p' transform='spin(3)' d='M0 0L1 1L0 1Z'/></svg>", "transform");
  expect_refused("<svg><path id='p' d='M0 0", "expected valid XML");
  expect_refused("", "expected valid XML");
  expect_refused("<svg><rect id='p' width='a' height='1'/></svg>", "numbers");
  support::expect_error(ExitCode::asset_unreadable, "none that can be read",
                        [&] { load_svg_panel(folder_ / "absent.svg", "p"); });
}

TEST_F(Drawings, GroupsNameEdgesByTextsBesideThem) {
  // A bodice and another panel. The neck of the bodice consists of two pieces; its hem continues into the side without
  // a corner.
  const std::string sheet = R"(<svg width='1000mm' viewBox='0 0 1000 1000' xmlns:inkscape='x'>
    <g inkscape:label='front' transform='translate(100 0)'>
      <path class='fabric sa' d='M-10 -10H210V310H-10Z'/>
      <path class='grainline' d='M100 50V250'/>
      <path d='M0 0 C20 20 40 30 60 30 C80 30 100 20 120 0 L200 0 L200 240 Q200 300 140 300 L0 300 Z'/>
      <text x='60' y='20'>edge:neck</text>
      <text transform='translate(150 -5)' x='0' y='0'><tspan>edge: </tspan><tspan>shoulder</tspan></text>
      <text><tspan x='210' y='100'>edge: side</tspan></text>
      <text x='70' y='310'>edge: hem</text>
      <text x='100' y='150'>Front, cut 1 on fold</text>
      <text x='100' y='300'>origin</text>
    </g>
    <g id='back'><rect x='500' y='0' width='200' height='300'/></g>
    <g id='moved' transform='translate(7 9)'><rect x='1' y='2' width='200' height='300'/></g>
    <g id='both'><rect x='0' y='0' width='2' height='3'/><g><polygon points='0 0 1 0 1 1'/></g></g>
    <g id='odd'><rect x='0' y='0' width='2' height='3'/><text x='0' y='0'>edge: two words</text></g>
  </svg>)";
  support::write_bytes(folder_ / "d.svg", sheet);
  const DrawnPanel front = load_svg_panel(folder_ / "d.svg", "front");
  const std::vector<std::string> names{"neck", "neck", "shoulder", "side", "hem", "hem", "4"};
  ASSERT_EQ(front.names.size(), front.outline.size());
  EXPECT_EQ(front.names, names);
  EXPECT_LT((front.outline[0].start() - Vec2(-0.1, 0.3)).norm(), 1e-12) << "from the middle of the hem";
  EXPECT_TRUE(load_svg_panel(folder_ / "d.svg", "back").names.empty());
  const Vec2 corner = load_svg_panel(folder_ / "d.svg", "moved").outline[0].start();
  EXPECT_LT((corner - Vec2(0.001, -0.002)).norm(), 1e-12) << "from where the group has its own origin";
  const auto refused = [&](const std::string& id, const std::string& words) {
    support::expect_error(ExitCode::asset_unreadable, words, [&] { load_svg_panel(folder_ / "d.svg", id); });
  };
  refused("both", "d.svg:15:6: g \"both\": expected a group with one closed outline, got 2");
  refused("frnt", "got none; did you mean \"front\"?");
  refused("collar", "got none; it has \"front\", \"back\", \"moved\", \"both\", \"odd\"");
  refused("odd", "text: expected edge: and a name of letters");
}

// A long edge is near everywhere, also between the points at which other edges end.
TEST_F(Drawings, TextsNameTheNearestEdgeHoweverLongItIs) {
  std::string lower;  // the lower edge of a binding 20 mm wide, in 40 pieces
  for (int k = 0; k < 40; ++k) lower += "h-40 ";
  support::write_bytes(
      folder_ / "d.svg",
      "<svg width='2000mm' viewBox='0 0 2000 2000'><g id='p'><path d='M0 0H1600V20" + lower +
          "Z'/><text x='1250' y='2'>edge: upper</text><text x='1250' y='18'>edge: lower</text></g></svg>");
  const std::vector<std::string> names = load_svg_panel(folder_ / "d.svg", "p").names;
  ASSERT_EQ(names.size(), 43U);
  EXPECT_EQ(names[0], "upper");
  for (std::size_t k = 2; k < 42; ++k) EXPECT_EQ(names[k], "lower") << k;
}

// Coordinates of elements may have units, which do not depend on the viewBox: a unit of the drawing is a pixel.
TEST_F(Drawings, ElementsMayStateUnits) {
  const std::string head = "<svg width='96mm' viewBox='0 0 96 96'>";  // a pixel is drawn 1 mm long
  expect_corners(head + "<rect id='p' x='1in' y='2px' width='2.54cm' height='72pt'/></svg>",
                 {{0.096, -0.002}, {0.192, -0.002}, {0.192, -0.098}, {0.096, -0.098}});
  support::write_bytes(folder_ / "d.svg",
                       head + "<g id='p'><rect width='20' height='30'/><text x='20px' y='15px'>edge: side</text>" +
                           "<text x='10 12 14' y='30'>origin</text></g></svg>");
  const DrawnPanel panel = load_svg_panel(folder_ / "d.svg", "p");
  EXPECT_EQ(panel.names, (std::vector<std::string>{"1", "side", "3", "4"}));
  EXPECT_LT((panel.outline[0].start() - Vec2(-0.01, 0.03)).norm(), 1e-12);
  expect_refused(head + "<rect id='p' width='50%' height='1'/></svg>", "numbers");
}

// Illustrator places texts by a transform, without x and y.
TEST_F(Drawings, TextsWithoutCoordinatesStandAtTheirOrigin) {
  const auto load_with = [&](const std::string& texts) {
    support::write_bytes(folder_ / "d.svg",
                         "<svg width='1000mm' viewBox='0 0 1000 1000'><g id='p'><rect width='200' height='300'/>" +
                             texts + "</g></svg>");
    return load_svg_panel(folder_ / "d.svg", "p");
  };
  const DrawnPanel panel = load_with(
      "<text transform='matrix(1 0 0 1 190 150)'>edge: side</text>"
      "<text x='90'><tspan y='290'>edge: hem</tspan></text>"
      "<text transform='translate(100 300)'>origin</text>");
  EXPECT_EQ(panel.names, (std::vector<std::string>{"1", "side", "hem", "4"}));
  EXPECT_LT((panel.outline[0].start() - Vec2(-0.1, 0.3)).norm(), 1e-12);
  support::expect_error(ExitCode::asset_unreadable, "x and y where a label stands",
                        [&] { load_with("<text><textPath>edge: hem</textPath></text>"); });
}

TEST_F(Drawings, SeamAllowancesOfAnyShapeDoNotCount) {
  const std::string allowance = "x='-1' y='-1' width='4' height='5'";
  for (const std::string& sa :
       {"<rect class='fabric sa' " + allowance + "/>", std::string("<polygon class='sa' points='-1,-1 3,-1 3,4'/>"),
        "<g class='sa'><rect " + allowance + "/></g>"})
    EXPECT_EQ(load("<svg><g id='p'>" + sa + "<path d='M0 0L1 0L0 1Z'/></g></svg>").size(), 3u) << sa;
}

TEST_F(Drawings, NumbersHaveOneSign) {
  expect_corners("<svg width='+10mm' viewBox='0 0 +10 10'><polygon id='p' points='+1,-0 +2,0 2,+1'/></svg>",
                 {{0.001, 0}, {0.002, 0}, {0.002, -0.001}});
  expect_refused("<svg viewBox='+-5 0 10 10'><path id='p' d='M0 0L1 0L0 1Z'/></svg>", "viewBox");
  expect_refused("<svg><rect id='p' x='+-5' width='1' height='1'/></svg>", "numbers");
}

// Valentina and Seamly write paths without ids, and without Z.
TEST_F(Drawings, WithoutIdsGiveTheirPathsByNumber) {
  support::write_bytes(
      folder_ / "d.svg",
      "<svg width='10mm' viewBox='0 0 10 10'><g><path d='M0 0L1 0L0 1Z'/></g><path d='M5,0 L7,0 L5,2 L5,0'/>"
      "<rect x='1' y='2' width='3' height='4'/></svg>");
  EXPECT_LT((load_svg_panel(folder_ / "d.svg", "path:2").outline[0].start().cwiseAbs() - Vec2(0.005, 0)).norm(), 1e-12);
  EXPECT_EQ(load_svg_panel(folder_ / "d.svg", "rect:1").outline.size(), 4u);
  for (const char* id : {"path:3", "path:0", "path:x", "front", ""})
    support::expect_error(ExitCode::asset_unreadable,
                          "got none; none of its 2 paths has one: \"path:1\" is the first of them",
                          [&] { load_svg_panel(folder_ / "d.svg", id); });
}

TEST_F(Drawings, CountOnlyWhatIsDrawn) {
  support::write_bytes(folder_ / "d.svg",
                       "<svg width='10mm' viewBox='0 0 10 10'><defs><marker><path d='M0 0L1 0L0 1Z'/></marker></defs>"
                       "<clipPath><path d='M0 0L2 0L0 1Z'/></clipPath><g><path d='M0 0L5 0L0 1Z'/></g></svg>");
  EXPECT_NEAR(span_of(load_svg_panel(folder_ / "d.svg", "path:1").outline[0]), 0.005, 1e-12);
  support::expect_error(ExitCode::asset_unreadable, "none of its 1 paths",
                        [&] { load_svg_panel(folder_ / "d.svg", "path:2"); });
}

TEST_F(Drawings, OfOldVersionsOfInkscapeHaveNinetyUnitsPerInch) {
  const auto width = [&](const std::string& attributes) {
    return span_of(load("<svg " + attributes + "><rect id='p' width='90' height='90'/></svg>")[0]);
  };
  EXPECT_NEAR(width("width='744.09' inkscape:version='0.48.4 r9939'"), 0.0254, 1e-12);
  for (const char* other : {"width='744.09'", "inkscape:version='0.92.3'", "inkscape:version='1.2'",
                            "inkscape:version='0.48.4' viewBox='0 0 96 96' width='1in'"})
    EXPECT_NEAR(width(other), 0.0254 * 90 / 96, 1e-12) << other;
}

// Valentina and Seamly write such outlines.
TEST_F(Drawings, WithAnAllowanceAroundTheSeamLineGiveTheSeamLine) {
  const std::string head = "<svg width='1000mm' viewBox='0 0 1000 1000'><path id='p' d='", tail = "'/></svg>";
  const std::string seam_line = "M100,100 L400,100 L400,600 L100,600 L100,100 ";
  const std::vector<Vec2> corners{{0.1, -0.1}, {0.4, -0.1}, {0.4, -0.6}, {0.1, -0.6}};
  const std::string around = "M90,90 L410,90 L410,640 L90,640 L90,90 ";
  expect_corners(head + seam_line + around + tail, corners);
  expect_corners(head + around + seam_line + tail, corners);
  expect_corners(head + "M100,90h310v520h-310z " + seam_line + tail, corners);       // no allowance along a fold
  expect_refused(head + seam_line + "M0,0h900v900h-900z" + tail, "got 2 outlines");  // a panel with a hole
  expect_refused(head + seam_line + "M500,100h300v500h-300z" + tail, "got 2 outlines");
  expect_refused(head + seam_line + around + around + tail, "got 3 outlines");
}

TEST_F(Drawings, MayBeNested) {
  const double px = 0.0254 / 96;
  const std::string path = "<path id='p' d='M5 5h50v10z'/></svg></svg>";
  // The inner drawing is enlarged by two, and centred in its height of 300.
  expect_corners("<svg><svg x='10' y='20' width='100' height='300' viewBox='5 5 50 100'>" + path,
                 {{10 * px, -70 * px}, {110 * px, -70 * px}, {110 * px, -90 * px}});
  expect_corners("<svg><svg y='20'>" + path, {{5 * px, -25 * px}, {55 * px, -25 * px}, {55 * px, -35 * px}});
  expect_refused("<svg><svg viewBox='5 5 50 100' width='50%' height='9'>" + path, "width, height");
}

TEST_F(Drawings, WithoutASizeAreRefused) {
  const std::string path = "<path id='p' d='M5 5h50v10z'/></svg>";
  for (const char* width : {"", "width='100%' height='100%'"})
    expect_refused("<svg viewBox='0 0 210 297' " + std::string(width) + ">" + path,
                   "width: expected the size of the sheet, such as 210mm, beside a viewBox");
}

TEST_F(Drawings, OfFreeSewingHaveMarksThatDoNotCount) {
  const std::string mark = "d='M0 0h9v9h-9z'/>";
  EXPECT_EQ(load("<svg><g id='p'><path class='scalebox metric fill-bg' " + mark + "<path class='lining help' " + mark +
                 "<path class='note' " + mark + "<path class='fabric' d='M0 0h900v900z'/></g></svg>")
                .size(),
            3u);
}

TEST_F(Drawings, DamagedFilesAreRefusedOrRead) {
  const std::string good =
      "<?xml version='1.0'?><svg width='210mm' height='297mm' viewBox='0 0 210 297'><g transform='rotate(3 1 2)'><path "
      "id='p' d='M10 20C1 2 3 4 5 60A3 3 0 0 1 70 80z'/></g></svg>";
  std::mt19937 engine(3);
  int read = 0;
  for (int round = 0; round < 500; ++round) {
    std::string damaged = good;
    for (int k = 0; k < 1 + round % 4; ++k) {
      const std::size_t at = engine() % damaged.size();
      if (engine() % 3 == 0)
        damaged.resize(std::max<std::size_t>(at, 1));
      else
        damaged[at] = static_cast<char>(engine() % 256);
    }
    try {
      for (const Curve& curve : load(damaged)) ASSERT_TRUE(curve.at(0.5).allFinite());
      ++read;
    } catch (const Error& error) {
      ASSERT_EQ(error.code(), ExitCode::asset_unreadable);
    }
  }
  EXPECT_GT(read, 20);
}

}  // namespace
}  // namespace weft::garment
