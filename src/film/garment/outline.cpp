#include "film/garment/outline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace weft::garment {
namespace {

// Maximum number of curves in path data. The outline of a panel usually has about twenty.
constexpr std::size_t kMaxCurves = 10000;
// Maximum absolute value of a number in path data; a larger number is reported as a mistake.
constexpr double kMaxCoordinate = 1e6;
// Maximum distance between start and end of a closed outline, as a fraction of its diagonal. Drawing programs round
// each relative coordinate to r = 0.1 to 0.001 mm. Errors up to r / 2, with a root mean square of r / √12 along each
// axis, add up over n curves to about r √(n / 6): for r = 0.01 mm and 20 curves to 0.02 mm, 4e-5 of the diagonal of a
// small panel, 0.5 m long. An edge of a 10,000th of the diagonal is shorter than any that is drawn.
constexpr double kMaxClosingGap = 1e-4;
// Number of straight pieces that approximate a curve to measure its length. The relative error for a quarter circle is
// 2e-6.
constexpr int kPiecesPerCurve = 256;
// Two consecutive curves meet at a corner if the angle between them is larger than this [rad]. Curves of one smooth
// line of a drawing meet at 1 or 2 degrees, seam and hem at 60 degrees or more.
constexpr double kMinCornerAngle = 25 * std::numbers::pi / 180;

Curve quadratic(const Vec2& from, const Vec2& control, const Vec2& to) {
  return {{from, from + 2.0 / 3 * (control - from), to + 2.0 / 3 * (control - to), to}, false};
}

double angle_between(const Vec2& a, const Vec2& b) {
  return std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
}

/// An elliptic arc in the endpoint parameterisation of SVG (1.1, appendix F.6.5).
struct Arc {
  Vec2 radii;
  double turn;  // angle of the ellipse's x axis [rad]
  bool large, sweep;
};

void append_arc(const Vec2& from, const Arc& arc, const Vec2& to, Outline& outline) {
  const Eigen::Rotation2Dd turn(arc.turn);
  Vec2 r = arc.radii.cwiseAbs();
  if (r.minCoeff() == 0) {
    outline.push_back(straight(from, to));
    return;
  }
  // In the frame of the ellipse, with its radii as units, the arc lies on a unit circle. If the radii are too small for
  // the ellipse to reach both end points, enlarges them.
  const Vec2 half = turn.inverse() * Vec2(0.5 * (from - to));
  const double radius_ratio = half.cwiseQuotient(r).norm();
  if (radius_ratio > 1) r *= radius_ratio;
  const Vec2 p = half.cwiseQuotient(r);
  const double off = std::sqrt(std::max(0.0, 1 / p.squaredNorm() - 1)) * (arc.large == arc.sweep ? -1 : 1);
  const Vec2 centre = off * Vec2(p.y(), -p.x());
  const Vec2 begin = p - centre, end = -p - centre;
  double sweep = angle_between(begin, end);
  if (arc.sweep && sweep < 0) sweep += 2 * std::numbers::pi;
  if (!arc.sweep && sweep > 0) sweep -= 2 * std::numbers::pi;
  const int pieces = std::max(1, static_cast<int>(std::ceil(std::abs(sweep) / (0.5 * std::numbers::pi) - kRoundoff)));
  const double each = sweep / pieces, handle_length = 4.0 / 3 * std::tan(0.25 * each);
  const Vec2 middle = 0.5 * (from + to) + turn * Vec2(r.cwiseProduct(centre));
  const auto placed = [&](const Vec2& unit) -> Vec2 { return middle + turn * Vec2(r.cwiseProduct(unit)); };
  Vec2 a = begin, at = from;
  for (int i = 1; i <= pieces; ++i) {
    const Vec2 b = Eigen::Rotation2Dd(each) * a;
    const Vec2 next = i == pieces ? to : placed(b);
    outline.push_back(
        {{at, placed(a + handle_length * Vec2(-a.y(), a.x())), placed(b - handle_length * Vec2(-b.y(), b.x())), next},
         i > 1});
    a = b, at = next;
  }
}

class PathReader {
 public:
  explicit PathReader(std::string_view data) : data_(data) {}

  ParsedPaths read() {
    while (result_.mistake.empty() && skip_space()) command();
    end_outline();
    return std::move(result_);
  }

 private:
  void end_outline() {
    if (!closed_ && !outline_.empty() && is_at_start()) close();
    if (!closed_)
      fail("expected a closed outline, which ends with Z or where it starts, got one that is open at the end");
    std::erase_if(outline_, [](const Curve& c) {
      return c.control[1] == c.start() && c.control[2] == c.start() && c.end() == c.start();
    });
    if (outline_.size() < 2) fail("expected an outline of two curves or more, got fewer");
    result_.outlines.push_back(std::move(outline_));
  }
  void begin_outline() {
    outline_.clear();
    started_ = closed_ = false;
    bounds_.setEmpty();
  }
  void fail(std::string text) {
    if (result_.mistake.empty()) result_.mistake = std::move(text);
  }
  void fail_here(std::string_view expected) {
    const std::string got = at_ < data_.size() ? fmt::format("\"{}\"", printable(data_[at_])) : "the end";
    fail(fmt::format("expected {}, got {} at character {}", expected, got, at_ + 1));
  }
  static char printable(char c) { return c >= 0x20 && c < 0x7F ? c : '?'; }

  // Skips white space; returns whether text remains.
  bool skip_space() {
    while (at_ < data_.size() && std::string_view(" \t\r\n").find(data_[at_]) != std::string_view::npos) ++at_;
    return at_ < data_.size();
  }
  void skip_separator() {
    if (skip_space() && data_[at_] == ',') ++at_;
    skip_space();
  }
  bool number_follows() {
    return skip_space() && std::string_view("+-.0123456789").find(data_[at_]) != std::string_view::npos;
  }
  double number() {
    if (!number_follows()) {
      fail_here("a number");
      return 0;
    }
    double value = 0;
    const auto [end, error] = parse_number(data_.substr(at_), value);
    if (error != std::errc() || !(std::abs(value) <= kMaxCoordinate)) {
      fail_here(fmt::format("a number from -{0:g} to {0:g}", kMaxCoordinate));
      return 0;
    }
    at_ = static_cast<std::size_t>(end - data_.data());
    skip_separator();
    return value;
  }
  bool flag() {
    if (!skip_space() || (data_[at_] != '0' && data_[at_] != '1')) {
      fail_here("0 or 1");
      return false;
    }
    const bool value = data_[at_++] == '1';
    skip_separator();
    return value;
  }
  Vec2 point(bool relative) {
    const double x = number(), y = number();
    return relative ? Vec2(pen_ + Vec2(x, y)) : Vec2(x, y);
  }

  void command() {
    const char letter = data_[at_];
    const bool is_move = letter == 'M' || letter == 'm';
    if (closed_ && !is_move) return fail_here("M or nothing after the closed outline");
    if (started_ && is_move) end_outline(), begin_outline();
    if (std::string_view("MmLlHhVvCcSsQqTtAaZz").find(letter) == std::string_view::npos)
      return fail_here("a command of SVG paths");
    ++at_;
    const bool relative = letter >= 'a';
    const char kind = static_cast<char>(relative ? letter - 'a' + 'A' : letter);
    if (!started_ && !is_move) return fail("expected M at the start, got another command");
    if (kind == 'Z') return close();
    bool first = true;
    do {
      if (kind == 'M' && first) {
        pen_ = first_ = point(relative);
        started_ = true;
        last_ = 'M';  // if S or T follows, there is no control point to reflect
      } else {
        draw(kind == 'M' ? 'L' : kind, relative);
      }
      first = false;
      if (curves_ > kMaxCurves) fail(fmt::format("expected at most {} curves, got more", kMaxCurves));
    } while (result_.mistake.empty() && number_follows());
  }

  bool is_at_start() const {
    return (pen_ - first_).norm() <= kMaxClosingGap * std::max(kRoundoff, bounds_.sizes().norm());
  }

  void close() {
    closed_ = true;
    if (!is_at_start()) return add(straight(pen_, first_));
    // Moves the end exactly to the start, to remove the rounding error.
    if (!outline_.empty()) outline_.back().control[3] = first_;
    pen_ = first_;
  }

  void draw(char kind, bool relative) {
    const Vec2 from = pen_;
    Vec2 handle = from;  // control point that a following S or T reflects
    if (kind == 'L') {
      add(straight(from, point(relative)));
    } else if (kind == 'H') {
      add(straight(from, {number() + (relative ? from.x() : 0), from.y()}));
    } else if (kind == 'V') {
      add(straight(from, {from.x(), number() + (relative ? from.y() : 0)}));
    } else if (kind == 'C' || kind == 'S') {
      const Vec2 a = kind == 'C' ? point(relative) : reflected("CS");
      const Vec2 b = point(relative), end = point(relative);
      handle = b;
      add({{from, a, b, end}, false});
    } else if (kind == 'Q' || kind == 'T') {
      const Vec2 a = kind == 'Q' ? point(relative) : reflected("QT");
      handle = a;
      add(quadratic(from, a, point(relative)));
    } else {
      const Vec2 radii(number(), 0);
      Arc arc{{radii.x(), number()}, number() * std::numbers::pi / 180, flag(), flag()};
      const Vec2 end = point(relative);
      const std::size_t before = outline_.size();
      if (result_.mistake.empty() && end != from) append_arc(from, arc, end, outline_);
      for (std::size_t i = before; i < outline_.size(); ++i) extend_bounds(outline_[i]);
      pen_ = end;
    }
    handle_ = handle;
    last_ = kind;
  }

  Vec2 reflected(std::string_view after) const {
    return after.find(last_) == std::string_view::npos ? pen_ : Vec2(2 * pen_ - handle_);
  }
  void add(const Curve& curve) {
    outline_.push_back(curve);
    extend_bounds(curve);
    pen_ = curve.end();
  }
  void extend_bounds(const Curve& curve) {
    ++curves_;
    bounds_.extend(curve.start()).extend(curve.end());
  }

  std::string_view data_;
  std::size_t at_ = 0;
  ParsedPaths result_;
  Outline outline_;         // current outline
  std::size_t curves_ = 0;  // number of curves of all outlines
  bool started_ = false, closed_ = false;
  char last_ = 'M';
  Vec2 pen_ = Vec2::Zero(), first_ = Vec2::Zero(), handle_ = Vec2::Zero();
  Eigen::AlignedBox2d bounds_;  // around the end points of the curves of the current outline
};

}  // namespace

Vec2 Curve::at(double t) const {
  const double s = 1 - t;
  return s * s * s * control[0] + 3 * s * s * t * control[1] + 3 * s * t * t * control[2] + t * t * t * control[3];
}

Curve straight(const Vec2& from, const Vec2& to) {
  return {{from, from + (to - from) / 3, to - (to - from) / 3, to}, false};
}

std::from_chars_result parse_number(std::string_view text, double& value) {
  const bool has_plus = text.starts_with('+') && !text.starts_with("+-");
  return std::from_chars(text.data() + (has_plus ? 1 : 0), text.data() + text.size(), value);
}

ParsedPaths parse_paths(std::string_view data) {
  return PathReader(data).read();
}

ParsedPath parse_path(std::string_view data) {
  ParsedPaths parsed = parse_paths(data);
  if (parsed.outlines.size() > 1) parsed.mistake = "expected one outline, got a second M";
  return {std::move(parsed.outlines[0]), std::move(parsed.mistake)};
}

bool has_corner(const Curve& before, const Curve& after) {
  // Step of the curve parameter over which tangents are measured. The derivative at the end cannot be used, because it
  // is 0 if control points coincide there.
  constexpr double kEndOffset = 1e-3;
  const Vec2 in = before.end() - before.at(1 - kEndOffset), out = after.at(kEndOffset) - after.start();
  return std::abs(angle_between(in, out)) > kMinCornerAngle;
}

std::vector<std::size_t> edges_between_corners(const Outline& outline) {
  const std::size_t n = outline.size();
  std::vector<std::size_t> edge(n, 0);
  std::size_t first = 0, number = 0;
  while (first < n && !has_corner(outline[(first + n - 1) % n], outline[first])) ++first;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t k = (first + i) % n;
    if (i > 0 && has_corner(outline[(k + n - 1) % n], outline[k])) ++number;
    edge[k] = number;
  }
  return edge;
}

std::vector<Vec2> sample_points(const std::vector<Curve>& chain) {
  std::vector<Vec2> points;
  for (const Curve& curve : chain)
    for (int i = 0; i < kPointsPerCurve; ++i) points.push_back(curve.at(double(i) / kPointsPerCurve));
  return points;
}

Arclength::Arclength(const std::vector<Curve>& chain) {
  points_.push_back(chain.front().start());
  sums_.push_back(0);
  for (const Curve& curve : chain)
    for (int i = 1; i <= kPiecesPerCurve; ++i) {
      const Vec2 next = i == kPiecesPerCurve ? curve.end() : curve.at(double(i) / kPiecesPerCurve);
      sums_.push_back(sums_.back() + (next - points_.back()).norm());
      points_.push_back(next);
    }
}

Vec2 Arclength::at(double fraction) const {
  if (fraction <= 0) return points_.front();
  if (fraction >= 1) return points_.back();
  const double s = fraction * length();
  const auto i = static_cast<std::size_t>(std::upper_bound(sums_.begin(), sums_.end(), s) - sums_.begin());
  const double piece = sums_[i] - sums_[i - 1];
  return points_[i - 1] + (s - sums_[i - 1]) / piece * (points_[i] - points_[i - 1]);
}

}  // namespace weft::garment
