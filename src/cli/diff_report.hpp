// What weft diff says of its pairs: to people, to scripts, to CI systems.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare/files.hpp"

namespace weft::cli {

using Json = nlohmann::ordered_json;

/// One line; each figure that is past its limit says so.
std::string describe(const compare::FileComparison& result, const compare::Limits& limits);

Json describe_json(const compare::Limits& limits);
/// `heatmap` may be empty.
Json describe_json(const compare::FileComparison& result, const compare::Limits& limits,
                   const std::filesystem::path& heatmap);

/// A line that GitHub Actions, and what speaks its language, shows at the reference, or at the test where there is
/// none: paths from GITHUB_WORKSPACE on, if that is set. `description`: of the result.
std::string annotation(const compare::FileComparison& result, const std::string& description);

/// A test case for each pair, in the form of JUnit: what differs or is missing has failed, what cannot be read is an
/// error. `descriptions`: of each result.
std::string junit_xml(const std::vector<compare::FileComparison>& results,
                      const std::vector<std::string>& descriptions);

}  // namespace weft::cli
