#include "physics/forces/ties.hpp"

#include <algorithm>
#include <cmath>

#include "core/archive.hpp"

namespace weft::forces {
namespace {

// Fraction of its full strength (0 to 1) that a sewn tie has at the scene time t. If
// `closed` < `open`, the tie starts open, closes and opens again; else it starts closed, opens and
// closes again.
double closed_ratio(const mesh::Tie& tie, double t) {
  const bool reopens = tie.closed < tie.open;
  const bool closed = reopens ? t >= tie.closed && t < tie.open : t < tie.open || t >= tie.closed;
  if (!closed) return 0;
  if (t < tie.closed) return 1;  // closed from the start
  const double s = std::clamp((t - tie.closed) / Ties::kClosing, 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

}  // namespace

Ties::Ties(const mesh::Sheet& sheet, Index first, double time_tolerance) : tearing_seams_(sheet.tearing_seams.size()) {
  for (mesh::Tie tie : sheet.ties) {
    tie.a += first, tie.b += first;
    tie.open -= time_tolerance;
    pieces_.push_back({tie});
  }
}

void Ties::set_strengths(double t, double progress) {
  for (Piece& piece : pieces_)
    piece.strength = piece.state == State::torn ? 0 : piece.tie.strength * progress * closed_ratio(piece.tie, t);
}

bool Ties::are_constant_between(double t0, double t1) const {
  return std::ranges::all_of(
      pieces_, [&](const Piece& piece) { return closed_ratio(piece.tie, t0) == closed_ratio(piece.tie, t1); });
}

void Ties::accept(std::span<const Vec3> x) {
  for (Piece& piece : pieces_) {
    if (piece.tie.tearing < 0) continue;
    if (piece.strength == 0 && piece.state == State::can_tear) piece.state = State::open;
    if (piece.strength < piece.tie.strength) continue;
    const bool is_full_pull = (x[piece.tie.b] - x[piece.tie.a]).norm() >= 2 * kRest;
    if (piece.state == State::open && !is_full_pull) piece.state = State::can_tear;
    if (piece.state == State::can_tear && is_full_pull) piece.state = State::torn, piece.strength = 0;
  }
}

std::vector<Ties::SeamLoad> Ties::measure_seams(std::span<const Vec3> x) const {
  std::vector<SeamLoad> loads(tearing_seams_);
  for (const Piece& piece : pieces_) {
    if (piece.tie.tearing < 0) continue;
    SeamLoad& seam = loads[static_cast<std::size_t>(piece.tie.tearing)];
    seam.load += pull(piece, (x[piece.tie.b] - x[piece.tie.a]).norm()).force;
    seam.is_closed |= piece.strength > 0;
  }
  return loads;
}

void Ties::copy_state_from(const Ties& there) {
  for (std::size_t k = 0; k < pieces_.size(); ++k) pieces_[k].state = there.pieces_[k].state;
}

template <class Archive>
void Ties::serialize(Archive& archive) {
  if (tearing_seams_ == 0) return;
  for (Piece& piece : pieces_) {
    archive.value(piece.state);
    if constexpr (Archive::kReads) require(piece.state <= State::torn, "a tie");
  }
}

template void Ties::serialize(ByteWriter&);
template void Ties::serialize(ByteReader&);

void Ties::append_couplings(std::vector<std::pair<Index, Index>>& pairs) const {
  for (const Piece& piece : pieces_) pairs.emplace_back(piece.tie.a, piece.tie.b);
}

void Ties::attach(const solver::Assembly& assembly) {
  for (Piece& piece : pieces_) {
    const auto [i, j] = std::minmax(piece.tie.a, piece.tie.b);
    piece.block = assembly.block(i, j);
  }
}

Ties::Pull Ties::pull(const Piece& piece, double length) {
  if (length <= kRest) return {};
  if (length >= 2 * kRest) return {piece.strength, 0};
  return {piece.strength * (length / kRest - 1), piece.strength / kRest};
}

// Stiffness between the ends [N/m]: positive semidefinite, as ties only pull.
Mat3 Ties::stiffness(const Piece& piece, const Vec3& along) {
  const double length = along.norm();
  const Pull now = pull(piece, length);
  if (now.force == 0) return Mat3::Zero();
  const Vec3 n = along / length;
  const double lateral = now.force / length;
  return (now.axial - lateral) * n * n.transpose() + lateral * Mat3::Identity();
}

void Ties::add(const Evaluation& at) const {
  for (const Piece& piece : pieces_) {
    const Vec3 along = solver::vec3_of(at.x[piece.tie.b] - at.x[piece.tie.a]);
    const double length = along.norm();
    const Pull now = pull(piece, length);
    if (now.force == 0) continue;
    const Vec3 force = now.force / length * along;
    const auto padded_force = solver::padded<double>(force);
    at.force.add(piece.tie.a, padded_force);
    at.force.subtract(piece.tie.b, padded_force);
    if (at.assembly) at.assembly.add(piece.block, Mat3(-stiffness(piece, along)));
  }
}

void Ties::add_jacobian(std::span<const Vec3> x, std::span<const Vec3> /*v*/, double /*rate*/,
                        solver::BlockMatrix& jacobian) const {
  for (const Piece& piece : pieces_)
    jacobian.add_spring(piece.tie.a, piece.tie.b, stiffness(piece, x[piece.tie.b] - x[piece.tie.a]));
}

double Ties::energy(std::span<const Vec3> x) const {
  double sum = 0;
  for (const Piece& piece : pieces_) {
    const double strain = (x[piece.tie.b] - x[piece.tie.a]).norm() / kRest - 1;
    if (strain <= 0) continue;
    sum += piece.strength * kRest * (strain < 1 ? 0.5 * strain * strain : strain - 0.5);
  }
  return sum;
}

}  // namespace weft::forces
