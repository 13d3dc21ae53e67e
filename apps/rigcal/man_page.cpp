#include <fmt/format.h>

#include "apps/rigcal/manual.hpp"
#include "report/store/provenance.hpp"
#include "report/text/escape.hpp"

namespace rigcal::app {
namespace {

/// Escapes text so that roff does not interpret it, and so that hyphens can be copied to a command
/// line.
std::string roff(std::string_view text) {
  using Row = std::pair<char, std::string_view>;
  const std::string escaped = report::replaced(
      text, std::array{Row{'\\', "\\e"}, Row{'-', "\\-"}, Row{'\'', "\\(aq"}, Row{'"', "\\(dq"}});
  return escaped.starts_with('.') ? "\\&" + escaped : escaped;
}

std::string bold(std::string_view text) { return "\\fB" + roff(text) + "\\fR"; }

std::string option_text(const CLI::Option& option) {
  std::string names;
  for (const std::string& name : option.get_snames()) names += bold("-" + name) + ", ";
  for (const std::string& name : option.get_lnames()) names += bold("--" + name) + ", ";
  if (option.get_positional()) names += bold(option.get_name(true)) + ", ";
  names.resize(names.size() - 2);
  if (!option.get_positional() && option.get_type_size() != 0) {
    const std::string type = option.get_type_name();
    names += " \\fI" + roff(type.substr(0, type.find(':'))) + "\\fR";
  }
  std::string meaning = roff(option.get_description());
  if (!option.get_default_str().empty()) {
    meaning += fmt::format(" [{}]", roff(option.get_default_str()));
  }
  return fmt::format(".TP\n{}\n{}\n", names, meaning);
}

std::string options_text(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* option : app.get_options()) text += option_text(*option);
  return text;
}

std::string verb_text(const CLI::App& verb) {
  std::string usage = "rigcal " + verb.get_name() + " [options]";
  for (const CLI::Option* option : verb.get_options()) {
    if (!option->get_positional()) continue;
    usage += " " + option->get_name(true) + (option->get_expected_max() > 1 ? "..." : "");
  }
  return fmt::format(".SS {}\n.B {}\n.PP\n{}.\n{}", roff(verb.get_name()), roff(usage),
                     roff(verb.get_description()), options_text(verb));
}

constexpr std::string_view kExitStatus =
    ".SH EXIT STATUS\n"
    ".TP\n.B 0\nDone: PASS, WARN, or no limits.\n"
    ".TP\n.B 1\nDone: the verdict is FAIL, or with \\fB\\-\\-strict\\fR WARN.\n"
    ".TP\n.B 2\nBad usage or bad input; standard error names file, line and key.\n"
    ".TP\n.B 3\nNo usable result.\n"
    ".TP\n.B 4\nStopped by a signal or a limit; the best so far is written.\n"
    ".TP\n.B 5\nA file could not be written, memory ran out, or a bug.\n";

constexpr std::string_view kEnvironment =
    ".SH ENVIRONMENT\n"
    ".TP\n.B NO_COLOR\nIf it is set, nothing is printed in colour.\n"
    ".TP\n.B UDUNITS2_XML_PATH\nThe unit database, if not the one that is installed.\n";

}  // namespace

std::vector<const CLI::App*> verbs_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

std::string man_page(const CLI::App& app) {
  std::string text = fmt::format(
      ".TH RIGCAL 1 \"\" \"rigcal {0}\" \"User Commands\"\n.SH NAME\nrigcal \\- {1}\n.SH "
      "SYNOPSIS\n.B rigcal\n\\fIVERB\\fR [\\fIoptions\\fR] \\fICAMPAIGN\\fR\n.br\n.B "
      "rigcal\n\\fIVERB\\fR \\fB\\-\\-help\\fR\n.SH DESCRIPTION\n{1}.\nOne campaign file contains "
      "all that a calibration depends on; results go to a folder.\n.SH OPTIONS\n{2}.TP\n.B "
      "\\-\\-man\\-page\nPrint this page in roff.\n.TP\n.B \\-\\-completion \\fISHELL\\fR\nPrint "
      "the completion script for bash, zsh or fish.\n.SH VERBS\n",
      report::version(), roff(app.get_description()), options_text(app));
  for (const CLI::App* verb : verbs_of(app)) text += verb_text(*verb);
  return text + std::string(kExitStatus) + std::string(kEnvironment);
}

}  // namespace rigcal::app
