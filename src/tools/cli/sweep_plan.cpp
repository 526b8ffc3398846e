#include "tools/cli/sweep_plan.hpp"

#include <algorithm>
#include <cctype>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "core/error.hpp"
#include "core/input_file.hpp"
#include "core/toml.hpp"
#include "film/scene/document.hpp"
#include "tools/cli/option_values.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxSweepKeys = 200;  // per run; far more than a scene has
constexpr std::size_t kMaxNameBytes = 120;  // file systems allow 255

std::string trimmed(const std::string& text) {
  const auto blank = [](unsigned char c) { return std::isspace(c) != 0; };
  const auto first = std::find_if_not(text.begin(), text.end(), blank);
  const auto last = std::find_if_not(text.rbegin(), text.rend(), blank).base();
  return first < last ? std::string(first, last) : "";
}

std::vector<std::string> split_values(const std::string& text) {
  std::vector<std::string> values(1);
  int depth = 0;
  char quote = 0;
  for (const char c : text) {
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '[' || c == '{') {
      ++depth;
    } else if (c == ']' || c == '}') {
      --depth;
    } else if (c == ',' && depth == 0) {
      values.emplace_back();
      continue;
    }
    values.back() += c;
  }
  return values;
}

// Removes the byte order mark with which spreadsheets begin UTF-8 files. Throws if the text is UTF-16.
std::string without_byte_order_mark(const fs::path& file, const std::string& text) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    throw Error(ExitCode::asset_unreadable, "{}:1:1: expected UTF-8, got UTF-16; save the table as CSV UTF-8",
                file.string());
  return text.starts_with("\xEF\xBB\xBF") ? text.substr(3) : text;
}

// Fields of one row. Quoted fields may contain commas and line feeds; a doubled quote in them is a quote (RFC 4180).
std::vector<std::string> csv_fields(const std::string& row) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const char c = row[i];
    if (c == '"' && quoted && i + 1 < row.size() && row[i + 1] == '"') {
      fields.back() += row[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  for (std::string& field : fields) field = trimmed(field);
  return fields;
}

std::vector<Changes> read_csv(const fs::path& file, const std::string& text) {
  std::vector<std::string> keys;
  std::vector<Changes> rows;
  std::istringstream in(text);
  std::string whole;          // lines of the current row; several if a quoted field contains line feeds
  int number = 0, first = 1;  // number of the line, and of the first line of the row
  bool quoted = false;        // whether a quoted field continues on the next line; doubled quotes do not matter
  for (std::string line; std::getline(in, line);) {
    ++number;
    whole += line;
    if (std::ranges::count(line, '"') % 2 != 0) quoted = !quoted;
    if (quoted) {
      whole += '\n';
      continue;
    }
    const std::string row_text = std::exchange(whole, {});
    const int row_line = std::exchange(first, number + 1);
    if (trimmed(row_text).empty()) continue;
    const std::vector<std::string> fields = csv_fields(row_text);
    if (keys.empty()) {
      keys = fields;
      continue;
    }
    if (fields.size() != keys.size())
      throw Error(ExitCode::asset_unreadable, "{}:{}: expected {} values as in the first line, got {}", file.string(),
                  row_line, keys.size(), fields.size());
    Changes& row = rows.emplace_back();
    for (std::size_t k = 0; k < keys.size(); ++k)
      if (!fields[k].empty()) row.emplace_back(keys[k], fields[k]);  // an empty field keeps the value of the scene
  }
  if (quoted)
    throw Error(ExitCode::asset_unreadable, "{}:{}: expected a quote at the end of each quoted value, got none",
                file.string(), first);
  return rows;
}

// Collects the values of nested tables, such as `cloth.flag.size = [1, 1]`, under dotted keys.
void flatten(const toml::table& table, const std::string& above, Changes& changes) {
  for (const auto& [key, node] : table) {
    const std::string path = above.empty() ? std::string(key.str()) : above + "." + std::string(key.str());
    if (const toml::table* inner = node.as_table()) {
      flatten(*inner, path, changes);
      continue;
    }
    std::ostringstream text;
    if (const auto* number = node.as_floating_point())
      text << fmt::format("{}", number->get());  // shortest text that reads back exactly
    else
      node.visit([&](const auto& value) { text << value; });
    changes.emplace_back(path, text.str());
  }
}

std::vector<Changes> read_toml(const fs::path& file, const std::string& text) {
  try {
    const toml::table table = parse_toml(text, file.string());
    std::vector<Changes> rows;
    const toml::array* runs = table["run"].as_array();
    if (runs == nullptr || table.size() != 1 || !runs->is_array_of_tables())
      throw Error(ExitCode::asset_unreadable, "{}: expected a table [[run]] for each run, and nothing else",
                  file.string());
    for (const toml::node& run : *runs) flatten(*run.as_table(), "", rows.emplace_back());
    return rows;
  } catch (const toml::parse_error& error) {
    throw Error(ExitCode::asset_unreadable, "{}:{}:{}: {}", file.string(), error.source().begin.line,
                error.source().begin.column, error.description());
  }
}

// The last `parts` parts of a key: "a.b.bend" gives "bend" for 1, "b.bend" for 2, itself from 3 on.
std::string ending(const std::string& key, std::size_t parts) {
  std::size_t start = key.size();
  for (; parts > 0 && start != std::string::npos; --parts)
    start = start == 0 ? std::string::npos : key.rfind('.', start - 1);
  return start == std::string::npos ? key : key.substr(start + 1);
}

std::string short_name(const std::string& key, const std::set<std::string>& keys) {
  for (std::size_t parts = 1;; ++parts) {
    std::string name = ending(key, parts);
    const auto same = std::ranges::count_if(keys, [&](const std::string& k) { return ending(k, parts) == name; });
    if (same <= 1 || name == key) return name;
  }
}

// Removes or replaces characters that shells, file systems and name patterns interpret.
std::string safe_name(const std::string& text) {
  std::string name;
  for (const char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) || std::string_view("._+-,=").find(c) != std::string_view::npos)
      name += c;
    else if (std::string_view("[]{}\"' ").find(c) == std::string_view::npos)
      name += '-';
  }
  return name;
}

std::string file_name(const Changes& difference) {
  std::string name;
  for (const auto& [key, value] : difference)
    name += (name.empty() ? "" : "_") + safe_name(key) + "=" + safe_name(value);
  return name.substr(0, kMaxNameBytes);
}

std::vector<Changes> combine(std::vector<Changes> rows, const std::vector<Axis>& axes) {
  if (rows.empty()) rows.emplace_back();
  for (const Axis& axis : axes) {
    std::vector<Changes> longer;
    for (const Changes& row : rows) {
      for (const std::string& value : axis.values) {
        longer.push_back(row);
        longer.back().emplace_back(axis.key, value);
      }
      if (longer.size() > kMaxRuns) throw Error(ExitCode::usage, "expected at most {} runs, got more", kMaxRuns);
    }
    rows = std::move(longer);
  }
  return rows;
}

}  // namespace

Axis parse_axis(const std::string& text) {
  check_override(text);
  const std::size_t equals = text.find('=');
  Axis axis{text.substr(0, equals), {}};
  for (const std::string& value : split_values(text.substr(equals + 1))) axis.values.push_back(trimmed(value));
  if (std::ranges::any_of(axis.values, &std::string::empty))
    throw Error(ExitCode::usage, "--set: expected values such as {}=1,2,3, got {}", axis.key, text);
  return axis;
}

std::vector<Changes> read_list(const fs::path& file) {
  return parse_list(file, read_file(file, scene::kMaxFileSize));
}

std::vector<Changes> parse_list(const fs::path& file, const std::string& raw) {
  const std::string text = without_byte_order_mark(file, raw);
  std::vector<Changes> rows = file.extension() == ".toml" ? read_toml(file, text) : read_csv(file, text);
  if (rows.empty()) throw Error(ExitCode::asset_unreadable, "{}: names no run", file.string());
  if (rows.size() > kMaxRuns)
    throw Error(ExitCode::asset_unreadable, "{}: expected at most {} runs, got {}", file.string(), kMaxRuns,
                rows.size());
  for (const Changes& row : rows)
    if (row.size() > kMaxSweepKeys)
      throw Error(ExitCode::asset_unreadable, "{}: expected at most {} keys of a run, got {}", file.string(),
                  kMaxSweepKeys, row.size());
  return rows;
}

std::vector<SweepRun> plan_sweep(const std::vector<Changes>& list, const std::vector<Axis>& axes) {
  std::vector<SweepRun> runs;
  std::set<Changes> known;
  std::map<std::string, std::set<std::string>> values;  // by key: all values that runs set
  for (Changes& changes : combine(list, axes)) {
    std::set<std::string> keys;
    for (const auto& [key, value] : changes)
      if (!keys.insert(key).second)
        throw Error(ExitCode::usage, "{}: expected its values once, in --set or in --list, got them twice", key);
    if (!known.insert(changes).second) continue;
    for (const auto& [key, value] : changes) values[key].insert(value);
    runs.push_back({std::move(changes), {}, {}});
  }
  std::set<std::string> differing;
  for (const auto& [key, those] : values) {
    const auto has_it = [&key = key](const SweepRun& run) {
      return std::ranges::any_of(run.changes, [&](const auto& change) { return change.first == key; });
    };
    if (those.size() > 1 || runs.size() == 1 || !std::ranges::all_of(runs, has_it)) differing.insert(key);
  }
  std::map<std::string, std::string> short_names;
  for (const std::string& key : differing) short_names[key] = short_name(key, differing);
  std::set<std::string> names;
  std::map<std::string, int> copies;  // number of runs so far with the same name; makes numbering linear in time
  for (SweepRun& run : runs) {
    for (const auto& [key, value] : run.changes)
      if (differing.contains(key)) run.difference.emplace_back(short_names[key], value);
    const std::string name = run.difference.empty() ? "as_it_is" : file_name(run.difference);
    int& copy = copies[name];
    do {
      run.name = ++copy == 1 ? name : fmt::format("{}~{}", name, copy);
    } while (!names.insert(run.name).second);
  }
  return runs;
}

}  // namespace weft::cli
