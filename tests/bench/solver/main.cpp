// Linear solvers on systems of 10³ to 2·10⁵ particles, one thread, as CSV and Markdown tables:
//   bench_solver FILE.csv [MOST_PARTICLES [SOLVER]]
// The speed of CHOLMOD depends on its BLAS, which is named below the tables: the Debian package libopenblas0-serial is
// five times as fast as the reference BLAS. A solve is omitted if it would take more than 120 s, extrapolated from the
// smaller system.
#include <fmt/core.h>
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "bench/solver/solvers.hpp"
#include "core/parallel.hpp"
#include "core/timer.hpp"
#include "physics/solver/conjugate_gradient.hpp"

namespace weft::bench {
namespace {

constexpr double kMaxSeconds = 120;  // of one solve [s]
constexpr double kGrowth = 1.7;  // assumed exponent with which the time grows with the number of particles, to predict
                                 // the time of a larger system

double dot(std::span<const Vec3> a, std::span<const Vec3> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

/// Bytes that malloc has allocated.
double bytes_in_use() {
  const auto info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

struct Solution {
  int iterations = 0;
  double seconds = 0;
  bool reached = false;
  double residual = 0;  // computed from b and x, not by recurrence
};

// Conjugate gradients from zero. Returns for each tolerance the first solution with ‖b − A x‖₂ below the tolerance
// times ‖b‖₂.
std::vector<Solution> solve(const SheetSystem& sheet, Inverse& inverse, std::span<const double> tolerances) {
  const std::size_t n = sheet.b.size();
  std::vector<Vec3> x(n, Vec3::Zero()), r = sheet.b, z(n), p(n), q(n);
  std::vector<Solution> solutions(tolerances.size());
  Solution now;
  const double start = thread_cpu_seconds(), of_b = std::sqrt(dot(r, r));
  inverse.apply(r, z);
  p = z;
  double rz = dot(r, z);
  std::size_t next = 0;
  for (;;) {
    multiply(sheet.system, p, q);
    const double alpha = rz / dot(p, q);
    for (std::size_t i = 0; i < n; ++i) {
      x[i] += alpha * p[i];
      r[i] -= alpha * q[i];
    }
    ++now.iterations;
    now.seconds = thread_cpu_seconds() - start;
    now.residual = std::sqrt(dot(r, r)) / of_b;
    now.reached = true;
    while (next < tolerances.size() && now.residual <= tolerances[next]) solutions[next++] = now;
    now.reached = false;
    if (next == tolerances.size() || now.seconds > kMaxSeconds) break;
    inverse.apply(r, z);
    const double rz_next = dot(r, z);
    for (std::size_t i = 0; i < n; ++i) p[i] = z[i] + (rz_next / rz) * p[i];
    rz = rz_next;
  }
  for (; next < tolerances.size(); ++next) solutions[next] = now;
  multiply(sheet.system, x, q);
  for (std::size_t i = 0; i < n; ++i) q[i] = sheet.b[i] - q[i];
  solutions.back().residual = std::sqrt(dot(q, q)) / of_b;
  return solutions;
}

// solver::ConjugateGradient, with its own choice of precision and its own stopping test.
constexpr const char* kProgram = "the program";
constexpr const char* kDirect = "CHOLMOD, supernodal";

struct Entry {
  std::string name;
  std::function<std::unique_ptr<Inverse>()> make;
};

struct Row {
  std::string solver;
  Pose pose;
  double stiffness;
  int particles;
  double megabytes, analysis, setup;
  Solution loose, tight;
  // CPU time of a step [s]. Contacts change the pattern in each step; without contacts, a step reuses the analysis of
  // an earlier step, so the analysis does not count.
  double total(const Solution& s) const {
    return setup + (pose == Pose::lying && solver == kDirect ? analysis : 0) + s.seconds;
  }
};

constexpr double kTolerances[] = {0.1, 1e-6};
constexpr int kMostIterations = 20000;
constexpr int kSides[] = {32, 63, 127, 250, 447};

// Whether the previous system, of the same kind with fewer particles, predicts a solve within kMaxSeconds.
bool is_expected_in_time(std::span<const Row> rows, const Entry& entry, Pose pose, double stiffness, int particles) {
  const auto before = std::find_if(rows.rbegin(), rows.rend(), [&](const Row& r) {
    return r.solver == entry.name && r.pose == pose && r.stiffness == stiffness;
  });
  if (particles == kSides[0] * kSides[0]) return true;
  if (before == rows.rend() || !before->tight.reached) return false;
  return before->total(before->tight) * std::pow(static_cast<double>(particles) / before->particles, kGrowth) <
         kMaxSeconds;
}

const std::vector<Entry>& entries() {
  static const std::vector<Entry> kEntries{
      {"block Jacobi", block_jacobi},
      {"additive levels", additive_multilevel},
      {kProgram, {}},
      {"IC(0)", incomplete_cholesky},
      {"V-cycle, bilinear", geometric_multigrid},
      {"V-cycle, aggregates, 3", [] { return aggregation_multigrid(3); }},
      {"V-cycle, aggregates, 6", [] { return aggregation_multigrid(6); }},
      {kDirect, cholmod},
  };
  return kEntries;
}

Row measure_program(const SheetSystem& sheet, Pose pose, double stiffness) {
  Row row{kProgram, pose, stiffness, sheet.side * sheet.side, 0, 0, 0, {}, {}};
  solver::LinearSystem system = sheet.system;
  system.parts = {{0, system.matrix.rows()}};
  const double before = bytes_in_use();
  std::vector<Vec3> x(sheet.b.size()), q(sheet.b.size());
  solver::ConjugateGradient solver;
  for (Solution* solution : {&row.loose, &row.tight}) {
    const double tolerance = solution == &row.loose ? kTolerances[0] : kTolerances[1];
    // Sets up the multigrid levels of this precision, which later steps reuse.
    solver.prepare(system);
    solver.solve(sheet.b, {tolerance}, 1, x);
    // ConjugateGradient stops by error, not by residual: the loop lowers its tolerance until the residual is as
    // required, and the last solve counts.
    double relative_error = tolerance;
    do {
      ++system.parts.front().version;
      const double start = thread_cpu_seconds();
      solver.prepare(system);
      row.setup = thread_cpu_seconds() - start;
      const solver::LinearReport report = solver.solve(sheet.b, {relative_error}, kMostIterations, x);
      solution->seconds = thread_cpu_seconds() - start - row.setup;
      solution->iterations = report.iterations;
      multiply(sheet.system, x, q);
      for (std::size_t i = 0; i < q.size(); ++i) q[i] = sheet.b[i] - q[i];
      solution->residual = std::sqrt(dot(q, q) / dot(sheet.b, sheet.b));
      solution->reached = solution->residual <= tolerance;
      relative_error *= 0.7 * std::min(1.0, tolerance / solution->residual);
    } while (!solution->reached && solution->seconds < kMaxSeconds);
  }
  row.megabytes = (bytes_in_use() - before) / 1e6;
  return row;
}

// Measures one solver on one system. Memory is what the solver allocates in addition to the matrix.
Row measure(const Entry& entry, const SheetSystem& sheet, Pose pose, double stiffness) {
  Row row{entry.name, pose, stiffness, sheet.side * sheet.side, 0, 0, 0, {}, {}};
  if (!entry.make) return measure_program(sheet, pose, stiffness);
  const double before = bytes_in_use();
  const auto inverse = entry.make();
  const double start = thread_cpu_seconds();
  inverse->analyse(sheet);
  const double analysed = thread_cpu_seconds();
  inverse->factorise(sheet);
  row.analysis = analysed - start;
  row.setup = thread_cpu_seconds() - analysed;
  row.megabytes = (bytes_in_use() - before) / 1e6;
  const auto solutions = solve(sheet, *inverse, kTolerances);
  row.loose = solutions[0];
  row.tight = solutions[1];
  return row;
}

// Slope of log seconds over log particles by least squares, over the systems solved to 1e-6.
double exponent(std::span<const Row> rows, const std::string& solver, Pose pose, double stiffness) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const Row& row : rows) {
    if (row.solver != solver || row.pose != pose || row.stiffness != stiffness || !row.tight.reached) continue;
    const double u = std::log(row.particles), v = std::log(row.total(row.tight));
    n += 1, x += u, y += v, xx += u * u, xy += u * v;
  }
  return n < 3 ? std::nan("") : (n * xy - x * y) / (n * xx - x * x);
}

void print_tables(std::span<const Row> rows) {
  for (const Pose pose : {Pose::hanging, Pose::lying})
    for (const double k : {10.0, 1e3, 1e6}) {
      fmt::print("\n{}, {:g} N/m: CPU s to 1e-6, setup included (iterations; to 0.1)\n\n| solver |",
                 pose == Pose::hanging ? "Hanging" : "Lying", k);
      for (const int side : kSides) fmt::print(" {} |", side * side);
      fmt::print(" exponent | MB at most |\n|---|---|---|---|---|---|---|---|\n");
      for (const Entry& entry : entries()) {
        fmt::print("| {} |", entry.name);
        double megabytes = 0;
        for (const int side : kSides) {
          const auto row = std::find_if(rows.begin(), rows.end(), [&](const Row& r) {
            return r.solver == entry.name && r.pose == pose && r.stiffness == k && r.particles == side * side;
          });
          if (row == rows.end()) {
            fmt::print(" – |");
            continue;
          }
          megabytes = std::max(megabytes, row->megabytes);
          const auto seconds = [&](const Solution& s) {
            return s.reached ? fmt::format("{:.3g}", row->total(s)) : fmt::format("> {:.2g}", row->total(s));
          };
          fmt::print(" {} ({}; {}) |", seconds(row->tight), row->tight.iterations, seconds(row->loose));
        }
        fmt::print(" {:.2f} | {:.0f} |\n", exponent(rows, entry.name, pose, k), megabytes);
      }
    }
}

// Prints the BLAS library that the loader has mapped.
void print_blas() {
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);)
    if (const auto path = line.find('/');
        path != std::string::npos && line.find("libblas", path) != std::string::npos) {
      fmt::print("\nBLAS: {}\n", std::filesystem::canonical(line.substr(path)).string());
      return;
    }
}

void write_csv(std::span<const Row> rows, const std::string& file) {
  std::ofstream out(file);
  out << "pose,stiffness,particles,solver,megabytes,analysis_s,setup_s,iterations_0.1,solve_s_0.1,reached_0.1,"
         "iterations_1e-6,solve_s_1e-6,reached_1e-6,residual\n";
  for (const Row& r : rows)
    out << fmt::format("{},{:g},{},\"{}\",{:.2f},{:.5f},{:.5f},{},{:.5f},{},{},{:.5f},{},{:.2e}\n",
                       r.pose == Pose::hanging ? "hanging" : "lying", r.stiffness, r.particles, r.solver, r.megabytes,
                       r.analysis, r.setup, r.loose.iterations, r.loose.seconds, r.loose.reached, r.tight.iterations,
                       r.tight.seconds, r.tight.reached, r.tight.residual);
}

}  // namespace

void run(int max_particles, const std::string& only, const std::string& csv) {
  set_thread_count(1);
  mallopt(M_MMAP_THRESHOLD, 1 << 16);  // returns freed blocks to the system, so that bytes in use are bytes held
  std::vector<Row> rows;
  for (const int side : kSides)
    for (const Pose pose : {Pose::hanging, Pose::lying})
      for (const double k : {10.0, 1e3, 1e6}) {
        if (side * side > max_particles) continue;
        const SheetSystem sheet = sheet_system(side, k, pose);
        for (const Entry& entry : entries()) {
          if (entry.name.find(only) == std::string::npos) continue;
          if (!is_expected_in_time(rows, entry, pose, k, side * side)) continue;
          rows.push_back(measure(entry, sheet, pose, k));
          write_csv(rows, csv);
        }
      }
  print_tables(rows);
  print_blas();
}

}  // namespace weft::bench

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.empty() || words.size() > 3) {
    fmt::print(stderr, "expected: FILE.csv [MOST_PARTICLES [SOLVER]]\n");
    return EXIT_FAILURE;
  }
  weft::bench::run(words.size() > 1 ? std::stoi(words[1]) : 250000, words.size() > 2 ? words[2] : "", words[0]);
  return EXIT_SUCCESS;
}
