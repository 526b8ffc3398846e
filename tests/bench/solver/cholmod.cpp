#include <suitesparse/cholmod.h>

#include <cstring>
#include <stdexcept>

#include "bench/solver/block_rows.hpp"
#include "bench/solver/solvers.hpp"

namespace weft::bench {
namespace {

class Cholmod final : public Inverse {
 public:
  Cholmod() {
    cholmod_start(&common_);
    common_.supernodal = CHOLMOD_SUPERNODAL;
    common_.final_ll = 1;
  }
  ~Cholmod() override {
    cholmod_free_dense(&y_, &common_);
    cholmod_free_dense(&e_, &common_);
    cholmod_free_dense(&solution_, &common_);
    cholmod_free_factor(&factor_, &common_);
    cholmod_free_sparse(&matrix_, &common_);
    cholmod_finish(&common_);
  }
  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;

  // Orders the particles by nested dissection (METIS). Each particle has three unknowns.
  void analyse(const SheetSystem& sheet) override {
    const BlockRows<Mat3> a = assembled(sheet.system);
    make_pattern(a);
    cholmod_sparse* particles =
        cholmod_allocate_sparse(static_cast<std::size_t>(a.rows()), static_cast<std::size_t>(a.rows()), a.column.size(),
                                1, 1, -1, CHOLMOD_PATTERN, &common_);
    std::size_t count = 0;
    for (Index i = 0; i < a.rows(); ++i) {
      static_cast<int*>(particles->p)[i] = static_cast<int>(count);
      for (std::size_t s = a.start[static_cast<std::size_t>(i)]; s < a.start[static_cast<std::size_t>(i) + 1]; ++s)
        if (a.column[s] >= i) static_cast<int*>(particles->i)[count++] = a.column[s];
    }
    static_cast<int*>(particles->p)[a.rows()] = static_cast<int>(count);
    std::vector<int> order(static_cast<std::size_t>(a.rows())), unknowns;
    if (!cholmod_metis(particles, nullptr, 0, 1, order.data(), &common_)) throw std::runtime_error("METIS failed");
    for (int particle : order)
      for (int k = 0; k < 3; ++k) unknowns.push_back(3 * particle + k);
    cholmod_free_sparse(&particles, &common_);
    common_.nmethods = 1;
    common_.method[0].ordering = CHOLMOD_GIVEN;
    common_.postorder = 1;
    factor_ = cholmod_analyze_p(matrix_, unknowns.data(), nullptr, 0, &common_);
  }

  void factorise(const SheetSystem& sheet) override {
    const BlockRows<Mat3> a = assembled(sheet.system);
    auto* value = static_cast<double*>(matrix_->x);
    for (Index i = 0; i < a.rows(); ++i)
      for (int k = 0; k < 3; ++k)
        for (std::size_t s = a.start[static_cast<std::size_t>(i)]; s < a.start[static_cast<std::size_t>(i) + 1]; ++s)
          for (int l = 0; l < 3; ++l)
            if (3 * a.column[s] + l >= 3 * i + k) *value++ = a.value[s](k, l);
    if (!cholmod_factorize(matrix_, factor_, &common_) || common_.status != CHOLMOD_OK)
      throw std::runtime_error("not positive definite");
  }

  void apply(std::span<const Vec3> r, std::span<Vec3> z) override {
    cholmod_dense b{};
    b.nrow = b.nzmax = b.d = 3 * r.size();
    b.ncol = 1;
    b.x = const_cast<double*>(r.data()->data());
    b.xtype = CHOLMOD_REAL;
    b.dtype = CHOLMOD_DOUBLE;
    cholmod_solve2(CHOLMOD_A, factor_, &b, nullptr, &solution_, nullptr, &y_, &e_, &common_);
    std::memcpy(z.data()->data(), solution_->x, 3 * r.size() * sizeof(double));
  }

 private:
  // Pattern of the lower triangle by columns. As the matrix is symmetric, it equals the upper triangle by rows.
  void make_pattern(const BlockRows<Mat3>& a) {
    const std::size_t size = 3 * static_cast<std::size_t>(a.rows());
    matrix_ = cholmod_allocate_sparse(size, size, (9 * a.column.size() + size) / 2, 1, 1, -1, CHOLMOD_REAL, &common_);
    int count = 0;
    for (Index i = 0; i < a.rows(); ++i)
      for (int k = 0; k < 3; ++k) {
        static_cast<int*>(matrix_->p)[3 * i + k] = count;
        for (std::size_t s = a.start[static_cast<std::size_t>(i)]; s < a.start[static_cast<std::size_t>(i) + 1]; ++s)
          for (int l = 0; l < 3; ++l)
            if (3 * a.column[s] + l >= 3 * i + k) static_cast<int*>(matrix_->i)[count++] = 3 * a.column[s] + l;
      }
    static_cast<int*>(matrix_->p)[size] = count;
  }

  cholmod_common common_{};
  cholmod_sparse* matrix_ = nullptr;
  cholmod_factor* factor_ = nullptr;
  cholmod_dense *solution_ = nullptr, *y_ = nullptr, *e_ = nullptr;
};

}  // namespace

std::unique_ptr<Inverse> cholmod() {
  return std::make_unique<Cholmod>();
}

}  // namespace weft::bench
