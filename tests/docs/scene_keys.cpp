#include "docs/scene_keys.hpp"

#include <fmt/format.h>

#include <map>
#include <regex>

#include "film/garment/pattern.hpp"
#include "film/scene/rule.hpp"

namespace weft::docs {
namespace {

using scene::Need;
using scene::Rule;
using scene::Table;
using scene::Type;
using scene::Variant;

bool holds_tables(const Rule& rule) {
  return rule.type == Type::table || rule.type == Type::list || rule.type == Type::keys;
}

std::string default_text(const Rule& rule, void* defaults) {
  if (rule.need == Need::required) return "must be given";
  if (rule.need == Need::here_or_in_first_key) return "here or in the first of `keys`";
  if (!rule.default_note.empty()) return rule.default_note;
  const scene::Value value = rule.get(defaults);
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* text = std::get_if<std::string>(&value)) return text->empty() ? "none" : *text;
  const auto* numbers = std::get_if<std::vector<double>>(&value);
  if (numbers == nullptr) return "none";
  if (rule.components.empty() && rule.type == Type::number) return fmt::format("{}", numbers->at(0));
  return fmt::format("[{}]", fmt::join(*numbers, ", "));
}

// Prints a table, then each table inside it.
class Printer {
 public:
  std::string text;

  void print(const Table& table, const std::string& path, const std::string& heading) {
    known_[&table] = heading;
    text += fmt::format("## {}\n\n{}\n\n", heading, table.documentation);
    print_rules(table.rules, table.make(), "");
    for (const Variant& variant : table.variants) {
      const auto defaults = table.make();
      table.find(table.selector)->set(defaults.get(), variant.name);
      print_rules(variant.rules, defaults, fmt::format("With `{} = \"{}\"`:\n\n", table.selector, variant.name));
    }
    print_inner(table.rules, path);
    for (const Variant& variant : table.variants) print_inner(variant.rules, path);
  }

 private:
  void print_rules(const std::vector<Rule>& rules, const std::shared_ptr<void>& defaults, const std::string& before) {
    std::string rows;
    for (const Rule& rule : rules) {
      if (holds_tables(rule)) continue;
      const std::string beside = rule.excludes.empty() ? "" : fmt::format("; not beside `{}`", rule.excludes);
      rows += fmt::format("| `{}` | {}{} | {} | {} |\n", rule.key, rule.documentation, beside, expectation(rule),
                          default_text(rule, defaults.get()));
    }
    if (rows.empty()) return;
    text += before + "| key | | accepts | default |\n|---|---|---|---|\n";
    text += std::regex_replace(rows, std::regex("<"), "&lt;") + "\n";
  }

  void print_inner(const std::vector<Rule>& rules, const std::string& path) {
    for (const Rule& rule : rules) {
      if (!holds_tables(rule)) continue;
      const std::string inner = path.empty() ? rule.key : path + "." + rule.key;
      const char* form = rule.type == Type::list ? "[[{}]]" : rule.type == Type::keys ? "{} = [{{...}}, ...]" : "[{}]";
      const std::string heading = fmt::format(fmt::runtime(form), inner);
      if (known_.contains(rule.table)) {
        if (known_.at(rule.table) == heading) continue;
        text += fmt::format("## {}\n\n{}: as {}.\n\n", heading, rule.documentation, known_.at(rule.table));
      } else {
        print(*rule.table, inner, heading);
      }
    }
  }

  std::map<const Table*, std::string> known_;  // tables that are printed already, with their heading
};

}  // namespace

std::string scene_keys() {
  Printer printer;
  printer.print(scene::scene_rules(), "", "The scene itself");
  return printer.text;
}

std::string pattern_keys() {
  Printer printer;
  printer.print(garment::pattern_rules(), "", "The pattern itself");
  return printer.text;
}

}  // namespace weft::docs
