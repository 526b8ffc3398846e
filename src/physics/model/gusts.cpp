#include "physics/model/gusts.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace weft::model {
namespace {

// k_e is the wave number that scales Von Kármán's spectrum; spectrum() has its maximum near it. The spectrum is divided
// into kShells shells of wave numbers k. The wave number of each shell is kRatio times that of the shell before;
// kShellsBelow shells are below k_e. 1 / k ranges from four integral lengths to a thirtieth of one. Waves with larger
// k, a tenth of the spectrum's energy, are left out.
constexpr int kShells = 13;
constexpr double kRatio = 1.5;
constexpr int kShellsBelow = 3;
// k_e times the integral length: (π/2 Σ E/k) / (2/3 Σ E), summed over these shells with energies E
// and wave numbers k (relative to k_e). For the whole spectrum, this product is 0.747.
constexpr double kLengthFactor = 0.836;
// Rate at which the phase of a wave changes for an observer that moves with the wind, relative to the turnover rate of
// eddies of its size (Fung et al., 1992, Section 2).
constexpr double kUnsteadiness = 0.5;

// Von Kármán's spectrum up to a factor; `k`: wave number relative to k_e.
double spectrum(double k) {
  return std::pow(k, 4) / std::pow(1 + k * k, 17.0 / 6);
}

}  // namespace

GustField::GustField(const Gusts& gusts, const Vec3& wind) {
  const double k_e = kLengthFactor / gusts.size;
  std::vector<double> wave_numbers, energies;
  double sum = 0;
  for (int shell = 0; shell < kShells; ++shell) {
    wave_numbers.push_back(std::pow(kRatio, shell - kShellsBelow));
    // The energy of a shell is the spectrum times the width of the shell, which is proportional to its wave number.
    energies.push_back(spectrum(wave_numbers.back()) * wave_numbers.back());
    sum += energies.back();
  }
  // The C++ standard specifies the output of this generator, but not that of its distributions, which therefore are not
  // used.
  std::mt19937_64 generator(static_cast<std::uint64_t>(gusts.seed));
  const auto random = [&] { return static_cast<double>(generator() >> 11) * 0x1p-53; };  // in [0, 1)
  for (int shell = 0; shell < kShells; ++shell) {
    const double k = wave_numbers[shell] * k_e;
    // Spectral density E(k). Its integral over k is 3/2 speed²; the width of the shell is k
    // ln(kRatio).
    const double energy = 1.5 * gusts.speed * gusts.speed * energies[shell] / sum / (k * std::log(kRatio));
    const double turnover = std::sqrt(k * k * k * energy);
    // Three waves along random perpendicular axes, the amplitude of each along the next axis: then
    // all components of the velocity have the same mean square.
    const double a = 2 * std::numbers::pi * random(), b = 2 * std::numbers::pi * random(), c = random();
    const Mat3 axes = Quat(std::sqrt(1 - c) * std::sin(a), std::sqrt(1 - c) * std::cos(a), std::sqrt(c) * std::sin(b),
                           std::sqrt(c) * std::cos(b))
                          .toRotationMatrix();  // Shoemake, "Uniform random rotations", 1992
    const double amplitude = gusts.speed * std::sqrt(2 * energies[shell] / sum);
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 wave_number = k * axes.col(axis);
      const double own = kUnsteadiness * turnover * (random() < 0.5 ? -1 : 1);
      waves_.push_back({wave_number, amplitude * axes.col((axis + 1) % 3), own - wave_number.dot(wind),
                        2 * std::numbers::pi * random()});
    }
  }
}

Vec3 GustField::at(const Vec3& x, double t) const {
  Vec3 sum = Vec3::Zero();
  for (const Wave& wave : waves_)
    sum += std::cos(wave.wave_number.dot(x) + wave.rate * t + wave.phase) * wave.amplitude;
  return sum;
}

}  // namespace weft::model
