#include "tools/cli/manual.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <sstream>
#include <vector>

#include "core/version.hpp"
#include "tools/cli/child_process.hpp"

namespace weft::cli {
namespace {

struct Option {
  std::vector<std::string> names;    ///< with dashes, short names first; for an argument, its name alone
  std::string value;                 ///< placeholder of the value, such as `FILE.mp4`; empty: the option has no value
  std::vector<std::string> choices;  ///< allowed values; empty: any value
  std::string meaning;
};

bool is_word(const std::string& text) {
  return !text.empty() &&
         std::ranges::all_of(text, [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; });
}

// The choices in a text such as `draft|preview|final`; empty if one part is a placeholder such as FILE.
std::vector<std::string> choices_of(const std::string& value) {
  std::vector<std::string> choices;
  std::istringstream parts(value);
  for (std::string part; std::getline(parts, part, '|');) {
    if (!is_word(part)) return {};
    choices.push_back(part);
  }
  return choices;
}

Option described(const CLI::Option& option) {
  Option entry;
  for (const std::string& name : option.get_snames()) entry.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) entry.names.push_back("--" + name);
  if (entry.names.empty()) entry.names.push_back(option.get_name());
  if (option.get_items_expected_max() > 0) entry.value = option.get_type_name();
  entry.choices = choices_of(entry.value);
  entry.meaning = option.get_description();
  return entry;
}

std::vector<Option> options_of(const CLI::App& command) {
  std::vector<Option> options;
  for (const CLI::Option* option : command.get_options())
    if (option->nonpositional()) options.push_back(described(*option));
  return options;
}

std::vector<Option> arguments_of(const CLI::App& command) {
  std::vector<Option> arguments;
  for (const CLI::Option* option : command.get_options())
    if (!option->nonpositional()) arguments.push_back(described(*option));
  return arguments;
}

/// The allowed words of the first argument; empty if it is a file.
std::vector<std::string> first_words(const CLI::App& command) {
  const std::vector<Option> arguments = arguments_of(command);
  return arguments.empty() ? std::vector<std::string>{} : arguments.front().choices;
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

std::string names_of(const std::vector<const CLI::App*>& commands) {
  std::vector<std::string> names;
  for (const CLI::App* command : commands) names.push_back(command->get_name());
  return fmt::format("{}", fmt::join(names, " "));
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

std::string bash_completion(const CLI::App& app) {
  std::string values, names;
  for (const CLI::App* command : commands_of(app)) {
    if (const auto words = first_words(*command); !words.empty())
      values += fmt::format("      {0}:{0}) words='{1}' ;;\n", command->get_name(), fmt::join(words, " "));
    std::string all;
    for (const Option& option : options_of(*command)) {
      for (const std::string& name : option.names) all += (all.empty() ? "" : " ") + name;
      if (option.choices.empty()) continue;
      values += fmt::format("      {}:{}) words='{}' ;;\n", command->get_name(), option.names.back(),
                            fmt::join(option.choices, " "));
    }
    names += fmt::format("      {}) words='{}' ;;\n", command->get_name(), all);
  }
  return fmt::format(
      "# bash completion for weft: source <(weft completion bash)\n_weft() {{\n"
      "  local current=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} words=\n  COMPREPLY=()\n"
      // Bash splits --quality=draft into three words.
      "  if [ \"$current\" = = ]; then current=; elif [ \"$before\" = = ]; then before=${{COMP_WORDS[COMP_CWORD - "
      "2]}}; "
      "fi\n"
      "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n    words='{} --help --version'\n  else\n"
      "    case $current in\n    -*) case ${{COMP_WORDS[1]}} in\n{}    esac ;;\n"
      "    *) case ${{COMP_WORDS[1]}}:$before in\n{}    esac ;;\n    esac\n  fi\n"
      "  if [ -n \"$words\" ]; then mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$current\"); fi\n}}\n"
      "complete -o default -F _weft weft\n",
      names_of(commands_of(app)), names, values);
}

std::string zsh_completion(const CLI::App& app) {
  // Escapes brackets, colons and backslashes, since brackets and colons separate the fields of a
  // specification.
  const auto field = [](const std::string& text) {
    std::string result;
    for (const char c : text)
      result += (std::string("[]:\\").find(c) != std::string::npos ? "\\" : "") + std::string(1, c);
    return result;
  };
  std::string list, cases;
  for (const CLI::App* command : commands_of(app)) {
    list += fmt::format("    {}\n", quoted(command->get_name() + ":" + field(command->get_description())));
    cases += fmt::format("    {}) _arguments", command->get_name());
    if (const auto words = first_words(*command); !words.empty())
      cases += fmt::format(" \\\n      '1:what:({})'", fmt::join(words, " "));
    for (const Option& option : options_of(*command)) {
      const std::string value =
          option.value.empty()
              ? ""
              : fmt::format(":{}:{}", field(option.value),
                            option.choices.empty() ? "_files" : fmt::format("({})", fmt::join(option.choices, " ")));
      for (const std::string& name : option.names)
        cases +=
            " \\\n      " + quoted(fmt::format("*{}{}[{}]{}", name, !value.empty() && name.starts_with("--") ? "=" : "",
                                               field(option.meaning), value));
    }
    cases += " \\\n      '*:file:_files' ;;\n";
  }
  return fmt::format(
      "#compdef weft\n# zsh completion for weft: source <(weft completion zsh), after compinit\n_weft() {{\n"
      "  local -a commands=(\n{}  )\n"
      "  if (( CURRENT == 2 )); then _describe command commands; return; fi\n"
      "  shift words\n  (( CURRENT-- ))\n  case $words[1] in\n{}  esac\n}}\ncompdef _weft weft\n",
      list, cases);
}

std::string fish_completion(const CLI::App& app) {
  std::string text = "# fish completion for weft: weft completion fish | source\n";
  const auto out = std::back_inserter(text);
  const auto word = [](const std::string& of) { return "'" + replaced(replaced(of, "\\", "\\\\"), "'", "\\'") + "'"; };
  for (const CLI::App* command : commands_of(app)) {
    fmt::format_to(out, "complete -c weft -f -n __fish_use_subcommand -a {} -d {}\n", command->get_name(),
                   word(command->get_description()));
    if (const auto words = first_words(*command); !words.empty())
      fmt::format_to(out,
                     "complete -c weft -n '__fish_seen_subcommand_from {0}; and not __fish_seen_subcommand_from {1}' "
                     "-xa '{1}'\n",
                     command->get_name(), fmt::join(words, " "));
    for (const Option& option : options_of(*command)) {
      fmt::format_to(out, "complete -c weft -n '__fish_seen_subcommand_from {}'", command->get_name());
      for (const std::string& name : option.names)
        fmt::format_to(out, " {} {}", name.starts_with("--") ? "-l" : "-s", name.substr(name.find_first_not_of('-')));
      if (!option.choices.empty())
        fmt::format_to(out, " -xa '{}'", fmt::join(option.choices, " "));
      else if (!option.value.empty())
        text += " -r";
      fmt::format_to(out, " -d {}\n", word(option.meaning));
    }
  }
  return text;
}

// Escapes characters that troff interprets. Quotes, ^ and ~ must stay ASCII, so that commands can be copied to a shell.
std::string roff(const std::string& text) {
  std::string result;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    line = replaced(replaced(line, "\\", "\\e"), "-", "\\-");
    for (const auto& [plain, name] : {std::pair("'", "\\(aq"), {"`", "\\(ga"}, {"^", "\\(ha"}, {"~", "\\(ti"}})
      line = replaced(line, plain, name);
    if (line.starts_with('.')) line.insert(0, "\\&");
    result += line + "\n";
  }
  return result;
}

// The text below the options of --help, such as examples; its line breaks are kept.
std::string footer(const CLI::App& command) {
  const std::string text = command.get_footer();
  if (text.empty()) return "";
  return ".PP\n.nf\n" + roff(text.substr(text.find_first_not_of('\n'))) + ".fi\n";
}

std::string usage(const CLI::App& command) {
  std::istringstream lines(command.help());
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("Usage: ")) return line.substr(7);
  return command.get_name();
}

}  // namespace

std::string completion(const CLI::App& app, const std::string& shell) {
  if (shell == "bash") return bash_completion(app);
  return shell == "zsh" ? zsh_completion(app) : fish_completion(app);
}

std::string manual(const CLI::App& app) {
  std::string text = fmt::format(
      ".TH WEFT 1 {} \"Weft {}\"\n.SH NAME\nweft \\- cloth scenes to video\n.SH SYNOPSIS\n.B weft\n"
      "COMMAND [OPTIONS] ...\n.SH DESCRIPTION\n{}{}",
      kVersionDate, kVersion, roff(app.get_description()), footer(app));
  for (const CLI::App* command : commands_of(app)) {
    text += fmt::format(".SH {}\n{}.PP\n.B weft {}", command->get_name(), roff(command->get_description() + "."),
                        roff(usage(*command)));
    std::vector<Option> all = arguments_of(*command);
    std::ranges::copy(options_of(*command), std::back_inserter(all));
    for (const Option& option : all) {
      const std::string names = fmt::format("{}", fmt::join(option.names, ", "));
      text += fmt::format(".TP\n.B {}{}", roff(option.value.empty() ? names : names + " " + option.value),
                          roff(option.meaning));
    }
    text += footer(*command);
  }
  return text;
}

}  // namespace weft::cli
