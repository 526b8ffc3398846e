// Output of `weft diff` for people, scripts and CI systems.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/compare/files.hpp"

namespace weft::cli {

using Json = nlohmann::ordered_json;

/// Describes the result in one line; marks each figure that exceeds its limit.
std::string describe(const compare::FileComparison& result, const compare::Limits& limits);

Json describe_json(const compare::Limits& limits);
/// `heatmap`: file of the heat map; empty: none.
Json describe_json(const compare::FileComparison& result, const compare::Limits& limits,
                   const std::filesystem::path& heatmap);

/// A workflow annotation of GitHub Actions, attached to the reference, or to the test if there is no reference. The
/// path is relative to GITHUB_WORKSPACE if the file lies inside. `description`: of describe().
std::string annotation(const compare::FileComparison& result, const std::string& description);

/// JUnit XML with one test case per pair: different or missing pictures are failures, unreadable files are errors.
/// `descriptions`: of describe(), one per result.
std::string junit_xml(const std::vector<compare::FileComparison>& results,
                      const std::vector<std::string>& descriptions);

}  // namespace weft::cli
