#include "docs/generated.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "architecture/source_tree.hpp"
#include "core/input_file.hpp"
#include "core/version.hpp"
#include "docs/markdown.hpp"
#include "docs/scene_keys.hpp"
#include "film/scene/fabrics.hpp"
#include "lab/bench/report.hpp"
#include "tools/cli/options.hpp"

namespace weft::docs {
namespace {

namespace fs = std::filesystem;

// Escapes the text of a table cell: a bar would end the cell, and text between < and > would be invisible.
std::string in_cell(const std::string& text) {
  return std::regex_replace(std::regex_replace(text, std::regex(R"(\|)"), R"(\|)"), std::regex("<"), "&lt;");
}

// --- The command line, as printed by its help.

std::vector<std::string> help(const std::vector<std::string>& words) {
  std::vector<std::string> arguments = words;
  arguments.push_back("--help");
  std::istringstream text(std::get<cli::PrintText>(cli::parse_command_line(arguments)).text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

struct Entry {
  std::string name, meaning;
};

// The entries below `heading`, up to an empty line. The meaning of a long name is on the next line.
std::vector<Entry> section(const std::vector<std::string>& lines, const std::string& heading) {
  std::vector<Entry> entries;
  auto line = std::find(lines.begin(), lines.end(), heading);
  if (line == lines.end()) return {};
  const std::regex entry(R"(  (\S.*?)(?:  +(.*))?)"), meaning(R"( {3,}(.*))");
  for (++line; line != lines.end() && !line->empty(); ++line) {
    std::smatch match;
    if (std::regex_match(*line, match, meaning)) {
      entries.back().meaning = match[1];
    } else if (std::regex_match(*line, match, entry)) {
      entries.push_back({match[1], match[2]});
    }
  }
  return entries;
}

std::vector<Entry> commands_of_help() {
  std::vector<Entry> commands = section(help({}), "Subcommands:");
  for (Entry& command : commands)
    command.name = command.name.substr(0, command.name.find(','));  // the other names are aliases
  return commands;
}

std::string commands() {
  std::string table = "| command | |\n|---|---|\n";
  for (const Entry& command : commands_of_help()) {
    std::string usage = command.name;
    for (const std::string& line : help({command.name})) {
      if (line.starts_with("Usage: weft ")) usage = line.substr(std::string("Usage: weft ").size());
    }
    usage = std::regex_replace(usage, std::regex(R"( \[OPTIONS\])"), "");
    table += fmt::format("| `weft {}` | {} |\n", in_cell(usage), in_cell(command.meaning));
  }
  return table;
}

// One row for each option and meaning, sorted by name, with the commands that accept it.
std::string options() {
  std::vector<std::pair<std::string, std::vector<std::string>>> rows;
  for (const Entry& command : commands_of_help()) {
    for (const Entry& option : section(help({command.name}), "Options:")) {
      if (option.name == "-h,--help") continue;
      const std::string name = std::regex_replace(option.name, std::regex(R"( REQUIRED| \.\.\.)"), "");
      const std::string row = fmt::format("| `{}` | {} |", in_cell(name), in_cell(option.meaning));
      auto same = std::find_if(rows.begin(), rows.end(), [&](const auto& other) { return other.first == row; });
      if (same == rows.end()) same = rows.insert(rows.end(), {row, {}});
      same->second.push_back(command.name);
    }
  }
  std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) {
    const auto name = [](const std::string& row) { return row.substr(0, row.find(' ', 2)); };
    return name(a.first) < name(b.first);
  });
  std::string table = "| option | | commands |\n|---|---|---|\n";
  for (const auto& [row, names] : rows) table += fmt::format("{} {} |\n", row, fmt::join(names, ", "));
  return table;
}

// --- Tables in the sources.

std::string exit_codes(const fs::path& root) {
  const std::string text = read_file(root / "src/core/error.hpp");
  const std::regex code(R"(\n  \w+ = (\d+), +///< (.*))");
  std::string table = "| exit code | |\n|---|---|\n";
  for (std::sregex_iterator match(text.begin(), text.end(), code), end; match != end; ++match)
    table += fmt::format("| {} | {} |\n", (*match)[1].str(), (*match)[2].str());
  return table;
}

std::string fabrics() {
  std::string table =
      "| fabric | | `density` kg/m² | `stretch` weft, warp N/m | `max_stretch` | `shear` N/m | `bend` N·m | "
      "`bend_friction` N | `thickness` m | `friction` |\n|---|---|---|---|---|---|---|---|---|---|\n";
  for (const scene::Fabric& fabric : scene::fabrics()) {
    const scene::Material& m = fabric.material;
    table += fmt::format("| {} | {} | {} | {}, {} | {} | {} | {:.2g} | {:.2g} | {} | {} |\n", m.fabric, fabric.what,
                         m.density, m.stretch_weft, m.stretch_warp, m.max_stretch, m.shear, m.bend, m.bend_friction,
                         m.thickness, m.friction);
  }
  return table;
}

// Table of the fabrics; estimates are marked with ~.
std::string fabric_measurements() {
  std::string table =
      "| fabric | g/m² | extension at 490 N/m, weft, warp % | shear G N/m | B weft, warp µN·m | HB/B 1/m | mm | drape "
      "% | "
      "source |\n|---|---|---|---|---|---|---|---|---|\n";
  const auto text = [](const scene::MeasuredValue& figure, double unit) {
    return fmt::format("{}{:.3g}", figure.estimated ? "~" : "", unit * figure.value);
  };
  for (const scene::Fabric& fabric : scene::fabrics()) {
    const scene::Measurements& m = fabric.measured;
    std::string drape;
    if (m.drape) drape = fmt::format("{:.3g}", 100 * m.drape->first);
    if (m.drape && m.drape->second > m.drape->first) drape += fmt::format(" to {:.3g}", 100 * m.drape->second);
    table += fmt::format("| {} | {} | {}, {} | {} | {}, {} | {} | {} | {} | {} |\n", fabric.material.fabric,
                         text(m.density, 1e3), text(m.extension_weft, 100), text(m.extension_warp, 100),
                         text(m.shear, 1), text(m.bend_weft, 1e6), text(m.bend_warp, 1e6), text(m.hysteresis, 1),
                         text(m.thickness, 1e3), drape, fabric.source);
  }
  return table;
}

// "[mesh](src/physics/mesh/README.md)", or only the name if the module has no page.
std::string link_to(const architecture::Module& module, const fs::path& root, const std::string& to_root) {
  const std::string page = fmt::format("src/{}/README.md", module.folder().generic_string());
  return fs::exists(root / page) ? fmt::format("[{}]({}{})", module.name, to_root, page) : module.name;
}

// The rooms of src/, each with its modules; for a page at the top level.
std::string rooms(const fs::path& root) {
  std::string table = "| room of `src/` | holds | modules |\n|---|---|---|\n";
  const std::vector<architecture::Module> all = architecture::read_modules(root);
  const auto add = [&](const std::string& room, const std::string& does) {
    std::string links;
    for (const architecture::Module& module : all)
      if (module.room == room) links += (links.empty() ? "" : ", ") + link_to(module, root, "");
    table += fmt::format("| {} | {} | {} |\n", room.empty() ? "" : "`" + room + "/`", does, links);
  };
  add("", "what all use");
  for (const architecture::Room& room : architecture::read_rooms(root)) add(room.name, room.does);
  return table;
}

// Table of what each module does and may use; for a page one level below the top.
std::string modules(const fs::path& root) {
  std::string table = "| module | does | may use |\n|---|---|---|\n";
  for (const architecture::Module& module : architecture::read_modules(root))
    table += fmt::format("| {} | {} | {} |\n", link_to(module, root, "../"), module.does,
                         module.name == "cli" ? "all above" : fmt::format("{}", fmt::join(module.uses, " ")));
  return table;
}

// --- Measurements: tables as the programs of tests/bench printed them.

bench::Table printed_table(const fs::path& file) {
  std::istringstream text(read_file(file));
  bench::Table rows;
  for (std::string line; std::getline(text, line);) {
    if (!line.starts_with("| ")) {
      if (rows.empty() || line.starts_with("|-")) continue;
      break;
    }
    rows.emplace_back();
    std::istringstream cells(line.substr(1));
    for (std::string cell; std::getline(cells, cell, '|');)
      rows.back().push_back(std::regex_replace(cell, std::regex("^ +| +$"), ""));
  }
  return rows;
}

// The cells of a row in the named columns.
std::vector<std::string> select_cells(const std::vector<std::string>& row, const std::vector<std::string>& head,
                                      const std::vector<std::string>& columns) {
  std::vector<std::string> cells;
  for (const std::string& column : columns) {
    const auto at = std::find(head.begin(), head.end(), column);
    if (at == head.end()) throw std::runtime_error("no column is named " + column);
    cells.push_back(row[at - head.begin()]);
  }
  return cells;
}

// Returns the origin of a measured file: its first line (a heading with the command), and the line with program,
// machine and date.
std::string origin(const fs::path& file) {
  static const std::regex kOrigin(
      R"(^# (`[^`]+`[^\n]*)\n\nweft ([0-9.]+) of commit ([0-9a-f]{7,40}), ([^\n]+), (20\d\d-\d\d-\d\d)\n\n)");
  const std::string text = read_file(file);
  std::smatch match;
  if (!std::regex_search(text, match, kOrigin))
    throw std::runtime_error(
        file.string() +
        ": expected '# `COMMAND`' and 'weft VERSION of commit HASH, MACHINE, YYYY-MM-DD' above the "
        "table");
  if (match[2] != kVersion)
    throw std::runtime_error(fmt::format("{}: expected figures of weft {}, got those of {}: measure again",
                                         file.string(), kVersion, match[2].str()));
  return fmt::format("{} \\\nweft {} of commit {}, {}, {}", match[1].str(), match[2].str(), match[3].str(),
                     match[4].str(), match[5].str());
}

// The rows that the first tables of all files have in common, side by side.
bench::Table side_by_side(const fs::path& folder, const std::string& arguments) {
  const auto colon = arguments.find(": ");
  std::istringstream files(arguments.substr(0, colon)), names(arguments.substr(colon + 2));
  std::vector<std::string> columns;
  for (std::string name; std::getline(names >> std::ws, name, ',');) columns.push_back(name);
  bench::Table table;
  const bool several = arguments.find(' ') < colon;
  bool first = true;
  for (std::string file; files >> file; first = false) {
    const bench::Table rows = printed_table(folder / file);
    std::map<std::string, std::vector<std::string>> cells;
    for (const auto& row : rows) cells[row[0]] = select_cells(row, rows[0], columns);
    for (std::string& cell : cells[rows[0][0]]) cell = (several ? fs::path(file).stem().string() + ": " : "") + cell;
    if (first) {
      for (const auto& row : rows) table.push_back({row[0]});
    }
    std::erase_if(table, [&](const auto& line) { return !cells.contains(line[0]); });
    for (auto& line : table) {
      const std::vector<std::string>& more = cells[line[0]];
      line.insert(line.end(), more.begin(), more.end());
    }
  }
  return table;
}

// Arguments: "FILE" or "FILE FILE ...: COLUMN, COLUMN". Prints the origin of each file, then a table: without columns,
// the first table of the file; with columns, side_by_side().
std::string measured(const fs::path& folder, const std::string& arguments) {
  const auto colon = arguments.find(": ");
  std::istringstream files(arguments.substr(0, colon));
  std::string text;
  for (std::string file; files >> file;) text += origin(folder / file) + "\n\n";
  return text + bench::markdown(colon == std::string::npos ? printed_table(folder / arguments)
                                                           : side_by_side(folder, arguments));
}

std::string print(const fs::path& root, const fs::path& file, const std::string& name) {
  if (name == "commands") return commands();
  if (name == "options") return options();
  if (name == "exit codes") return exit_codes(root);
  if (name == "fabrics") return fabrics();
  if (name == "fabric measurements") return fabric_measurements();
  if (name == "modules") return modules(root);
  if (name == "rooms") return rooms(root);
  if (name == "scene keys") return scene_keys();
  if (name == "pattern keys") return pattern_keys();
  const std::string prefix = "measured ";
  if (name.starts_with(prefix)) return measured(root / file.parent_path(), name.substr(prefix.size()));
  throw std::runtime_error(file.string() + ": nothing prints '" + name + "'");
}

}  // namespace

std::string regenerated(const fs::path& root, const fs::path& file, const std::string& text) {
  const std::regex begin("<!-- generated: (.*) -->\n");
  const std::string end = "<!-- end -->";
  std::string result;
  auto at = text.begin();
  for (std::smatch match; std::regex_search(at, text.end(), match, begin);) {
    result.append(at, match.suffix().first);
    const auto stop = text.find(end, static_cast<std::size_t>(match.suffix().first - text.begin()));
    if (stop == std::string::npos) throw std::runtime_error(file.string() + ": no end of '" + match[1].str() + "'");
    result += "\n" + print(root, file, match[1]) + "\n";
    at = text.begin() + static_cast<std::ptrdiff_t>(stop);
  }
  return result.append(at, text.end());
}

}  // namespace weft::docs
