// Ranges of rows of 3×3 blocks (one row per particle or aggregate), divided into chunks for threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "physics/solver/padded_vec3.hpp"

namespace weft::solver {

struct RowRange {
  std::size_t begin = 0, end = 0;
};

/// Divides row ranges into chunks that do not depend on the number of threads, so that sums always have the same bits.
/// Each chunk lies in one range. A thread takes several chunks at a time if they are small, as for many small cloths.
class RowChunks {
 public:
  RowChunks() = default;
  /// `max_rows`: maximum number of rows per chunk; a task for a thread collects chunks until it has at least that many
  /// rows.
  RowChunks(std::span<const RowRange> ranges, std::size_t max_rows) : ranges_(ranges.size()) {
    std::size_t rows = 0;  // of the last task
    for (std::size_t r = 0; r < ranges.size(); ++r)
      for (std::size_t begin = ranges[r].begin; begin < ranges[r].end; begin += max_rows) {
        if (chunks_.empty() || rows >= max_rows) tasks_.push_back(chunks_.size()), rows = 0;
        chunks_.push_back({begin, std::min(begin + max_rows, ranges[r].end), r});
        rows += chunks_.back().end - begin;
      }
    tasks_.push_back(chunks_.size());
  }

  /// Calls body(begin, end) for all chunks, on several threads and in any order.
  template <class Body>
  void for_each(const Body& body) const {
    for_each_chunk([&](std::size_t c) { body(chunks_[c].begin, chunks_[c].end); });
  }

  /// Returns one sum per range: Σ body(begin, end) over its chunks, added in ascending order.
  template <class Body>
  std::vector<PaddedVec3<double>> sums(const Body& body) const {
    std::vector<PaddedVec3<double>> of_chunks(chunks_.size()), of_ranges(ranges_);
    for_each_chunk([&](std::size_t c) { of_chunks[c] = body(chunks_[c].begin, chunks_[c].end); });
    for (std::size_t c = 0; c < chunks_.size(); ++c) of_ranges[chunks_[c].range] += of_chunks[c];
    return of_ranges;
  }

 private:
  struct Chunk {
    std::size_t begin, end, range;
  };
  template <class Body>
  void for_each_chunk(const Body& body) const {
    if (chunks_.empty()) return;
    parallel_for(tasks_.size() - 1, 1, [&](std::size_t t, std::size_t) {
      for (std::size_t c = tasks_[t]; c < tasks_[t + 1]; ++c) body(c);
    });
  }

  std::size_t ranges_ = 0;
  std::vector<Chunk> chunks_;
  std::vector<std::size_t> tasks_;  // first chunk of each task, and the end
};

}  // namespace weft::solver
