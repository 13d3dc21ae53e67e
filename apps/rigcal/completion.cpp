#include <fmt/format.h>

#include <string>

#include "apps/rigcal/manual.hpp"
#include "common/error.hpp"

namespace rigcal::app {
namespace {

/// Returns the options of a verb: "--out --json -h".
std::vector<std::string> option_names(const CLI::App& verb) {
  std::vector<std::string> names;
  for (const CLI::Option* option : verb.get_options()) {
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

/// Replaces characters that cannot appear inside single quotes in every shell.
std::string quotable(std::string text) {
  for (char& c : text) {
    if (c == '\'' || c == '\\') c = ' ';
  }
  return text;
}

std::string bash(const CLI::App& app) {
  std::string verbs;
  std::string cases;
  for (const CLI::App* verb : verbs_of(app)) {
    verbs += verb->get_name() + " ";
    cases += fmt::format("    {}) words='{}' ;;\n", verb->get_name(),
                         fmt::join(option_names(*verb), " "));
  }
  return fmt::format(R"(# bash completion of rigcal
_rigcal() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} words=
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    mapfile -t COMPREPLY < <(compgen -W '{}{}' -- "$current")
    return
  fi
  case ${{COMP_WORDS[1]}} in
{}  esac
  case $current in
    -*) mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current") ;;
    *) compopt -o filenames; mapfile -t COMPREPLY < <(compgen -f -- "$current") ;;
  esac
}}
complete -F _rigcal rigcal
)",
                     verbs, fmt::join(option_names(app), " "), cases);
}

/// Returns the options in the syntax of zsh: '--out[Folder of the results]:path:_files'.
std::string zsh_options(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* option : app.get_options()) {
    std::string meaning = quotable(option->get_description());
    for (char& c : meaning) {
      if (c == '[' || c == ']' || c == ':') c = ' ';
    }
    const std::string value = option->get_type_size() != 0 ? ":value:_files" : "";
    for (const std::string& name : option->get_snames()) {
      text += fmt::format(" \\\n        '-{}[{}]{}'", name, meaning, value);
    }
    for (const std::string& name : option->get_lnames()) {
      text += fmt::format(" \\\n        '*--{}[{}]{}'", name, meaning, value);
    }
  }
  return text;
}

std::string zsh(const CLI::App& app) {
  std::string verbs;
  std::string cases;
  for (const CLI::App* verb : verbs_of(app)) {
    verbs += fmt::format("    '{}:{}'\n", verb->get_name(), quotable(verb->get_description()));
    cases += fmt::format("    {})\n      _arguments{} \\\n        '*:file:_files' ;;\n",
                         verb->get_name(), zsh_options(*verb));
  }
  return fmt::format(R"(#compdef rigcal
# zsh completion of rigcal
local -a verbs
verbs=(
{}  )
if (( CURRENT == 2 )); then
  _describe verb verbs
  _values option {}
else
  local verb=$words[2]
  shift words
  (( CURRENT-- ))
  case $verb in
{}  esac
fi
)",
                     verbs, fmt::join(option_names(app), " "), cases);
}

std::string fish_options(const CLI::App& app, const std::string& condition) {
  std::string text;
  for (const CLI::Option* option : app.get_options()) {
    const std::string rest = fmt::format("{} -d '{}'\n", option->get_type_size() != 0 ? " -r" : "",
                                         quotable(option->get_description()));
    for (const std::string& name : option->get_snames()) {
      text += fmt::format("complete -c rigcal -n '{}' -s {}{}", condition, name, rest);
    }
    for (const std::string& name : option->get_lnames()) {
      text += fmt::format("complete -c rigcal -n '{}' -l {}{}", condition, name, rest);
    }
  }
  return text;
}

std::string fish(const CLI::App& app) {
  std::string text = "# fish completion of rigcal\n" + fish_options(app, "__fish_use_subcommand");
  for (const CLI::App* verb : verbs_of(app)) {
    text += fmt::format("complete -c rigcal -f -n __fish_use_subcommand -a {} -d '{}'\n",
                        verb->get_name(), quotable(verb->get_description()));
    text += fish_options(*verb, "__fish_seen_subcommand_from " + verb->get_name());
  }
  return text;
}

}  // namespace

std::string completion(const CLI::App& app, std::string_view shell) {
  if (shell == "bash") return bash(app);
  if (shell == "zsh") return zsh(app);
  if (shell == "fish") return fish(app);
  throw UsageError(
      fmt::format("--completion: found '{}', expected {}", shell, fmt::join(kShells, ", ")));
}

}  // namespace rigcal::app
