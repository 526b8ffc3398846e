// Block Jacobi, the program's preconditioner, and incomplete Cholesky.
#include <Eigen/Cholesky>
#include <algorithm>

#include "bench/solver/block_rows.hpp"
#include "bench/solver/solvers.hpp"
#include "physics/solver/preconditioner.hpp"

namespace weft::bench {
namespace {

class OfTheProgram final : public Inverse {
 public:
  explicit OfTheProgram(bool levels) : levels_(levels) {}
  void analyse(const SheetSystem& sheet) override {
    if (levels_) return;
    without_levels_ = sheet.system;
    without_levels_.aggregate_levels.clear();
  }
  void factorise(const SheetSystem& sheet) override {
    preconditioner_.prepare(levels_ ? sheet.system : without_levels_);
  }
  void apply(std::span<const Vec3> r, std::span<Vec3> z) override {
    const std::size_t all = 0;
    r_.clear();
    for (const Vec3& v : r) r_.push_back(solver::padded<double>(v));
    z_.resize(r.size());
    preconditioner_.apply(r_, z_, {&all, 1});
    for (std::size_t i = 0; i < z.size(); ++i) z[i] = solver::vec3_of(z_[i]);
  }

 private:
  bool levels_;
  solver::LinearSystem without_levels_;
  solver::Preconditioner<double> preconditioner_;
  std::vector<solver::PaddedVec3<double>> r_, z_;
};

// L Lᵀ with the pattern of the matrix, row by row; if a pivot fails, retries with a larger diagonal (Manteuffel, "An
// Incomplete Factorization Technique for Positive Definite Linear Systems", 1980).
class BlockIncompleteCholesky final : public Inverse {
 public:
  void factorise(const SheetSystem& sheet) override {
    const BlockRows<Mat3> a = assembled(sheet.system);
    system_ = &sheet.system;
    lower_ = {};
    lower_.columns = a.columns;
    for (std::size_t i = 0; i < static_cast<std::size_t>(a.rows()); ++i) {
      for (std::size_t s = a.start[i]; s < a.start[i + 1] && a.column[s] <= static_cast<Index>(i); ++s)
        lower_.column.push_back(a.column[s]);
      lower_.start.push_back(lower_.column.size());
    }
    lower_.value.resize(lower_.column.size());
    for (double shift = 0; !try_factorise(a, shift);) shift = shift == 0 ? 1e-3 : 4 * shift;
  }

  void apply(std::span<const Vec3> r, std::span<Vec3> z) override {
    const auto rows = static_cast<std::size_t>(lower_.rows());
    for (std::size_t i = 0; i < rows; ++i) {
      Vec3 sum = r[i];
      const std::size_t last = lower_.start[i + 1] - 1;
      for (std::size_t s = lower_.start[i]; s < last; ++s)
        sum -= lower_.value[s] * z[static_cast<std::size_t>(lower_.column[s])];
      z[i] = lower_.value[last] * sum;
    }
    for (std::size_t i = rows; i-- > 0;) {
      const std::size_t last = lower_.start[i + 1] - 1;
      z[i] = (lower_.value[last].transpose() * z[i]).eval();
      for (std::size_t s = lower_.start[i]; s < last; ++s)
        z[static_cast<std::size_t>(lower_.column[s])] -= lower_.value[s].transpose() * z[i];
    }
    for (const auto& c : system_->constraints) {
      Vec3& entry = z[static_cast<std::size_t>(c.particle)];
      entry = (c.free * entry).eval();
    }
  }

 private:
  bool try_factorise(const BlockRows<Mat3>& a, double shift) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(a.rows()); ++i) {
      const std::size_t last = lower_.start[i + 1] - 1;
      for (std::size_t s = lower_.start[i]; s <= last; ++s) {
        const auto j = static_cast<std::size_t>(lower_.column[s]);
        Mat3 sum = a.value[a.start[i] + s - lower_.start[i]];
        // Finds the columns that both rows have.
        std::size_t p = lower_.start[i], q = lower_.start[j];
        while (p < s && q + 1 < lower_.start[j + 1]) {
          if (lower_.column[p] == lower_.column[q])
            sum -= lower_.value[p++] * lower_.value[q++].transpose();
          else if (lower_.column[p] < lower_.column[q])
            ++p;
          else
            ++q;
        }
        if (s < last) {
          lower_.value[s] = sum * lower_.value[lower_.start[j + 1] - 1].transpose();
          continue;
        }
        sum += shift * a.value[a.start[i] + s - lower_.start[i]];
        const Eigen::LLT<Mat3> pivot(sum);
        if (pivot.info() != Eigen::Success) return false;
        lower_.value[s] = pivot.matrixL().solve(Mat3::Identity());  // diagonal blocks are stored inverted
      }
    }
    return true;
  }

  const solver::LinearSystem* system_ = nullptr;
  BlockRows<Mat3> lower_;
};

}  // namespace

std::unique_ptr<Inverse> block_jacobi() {
  return std::make_unique<OfTheProgram>(false);
}
std::unique_ptr<Inverse> additive_multilevel() {
  return std::make_unique<OfTheProgram>(true);
}
std::unique_ptr<Inverse> incomplete_cholesky() {
  return std::make_unique<BlockIncompleteCholesky>();
}

}  // namespace weft::bench
