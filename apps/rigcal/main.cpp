#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "apps/rigcal/interrupt.hpp"
#include "apps/rigcal/manual.hpp"
#include "apps/rigcal/options.hpp"
#include "apps/rigcal/processes.hpp"
#include "apps/rigcal/verb.hpp"
#include "common/error.hpp"
#include "common/file.hpp"
#include "common/memory.hpp"
#include "common/printable.hpp"
#include "common/suggest.hpp"
#include "common/uninterrupted.hpp"
#include "report/live/live_module.hpp"
#include "report/store/folder.hpp"
#include "report/store/provenance.hpp"

namespace {

using rigcal::ExitCode;
using rigcal::app::Invocation;
using rigcal::app::Run;

struct VerbRow {
  const char* name;
  const char* summary;
  Run (*add)(CLI::App&);
  bool uses_processes = false;  ///< whether the verb uses all processes that were started together
};

constexpr std::array kVerbs{
    VerbRow{"check", "Load and check everything; one line per record", rigcal::app::add_check},
    VerbRow{"average", "Mean, sd and count of the repeats, and the noise floor",
            rigcal::app::add_average},
    VerbRow{"simulate", "Run the model: all signals and flows", rigcal::app::add_simulate},
    VerbRow{"fit", "Estimate the free parameters and score the conditions", rigcal::app::add_fit,
            true},
    VerbRow{"validate", "Score the conditions with the parameters of a fit",
            rigcal::app::add_validate},
    VerbRow{"leak-table", "Leakage coefficients by share of the servo flow that leaks",
            rigcal::app::add_leak_table},
    VerbRow{"fit-tables", "Estimate unstated values from published tables",
            rigcal::app::add_fit_tables},
    VerbRow{"diagnose", "Leak, share of the servo flow and fault class per record",
            rigcal::app::add_diagnose},
    VerbRow{"parity", "Residuals against the healthy model, and alarms at a stated rate",
            rigcal::app::add_parity},
    VerbRow{"plan", "How precisely each record, recorded or planned, determines each parameter",
            rigcal::app::add_plan},
    VerbRow{"explore", "Write a page in which the rig runs: change values, see the curves",
            rigcal::app::add_explore},
    VerbRow{"export", "Write the calibrated rig for other simulators: an FMU",
            rigcal::app::add_export},
    VerbRow{"synthesize", "Make records of a known rig", rigcal::app::add_synthesize},
    VerbRow{"init", "Draft a campaign file from recordings", rigcal::app::add_init},
    VerbRow{"batch", "Fit every rig in a folder tree; one overview", rigcal::app::add_batch, true},
    VerbRow{"compare", "Fits side by side: what differs, and the leak's trend",
            rigcal::app::add_compare},
    VerbRow{"report", "Draw the report of a result folder again", rigcal::app::add_report},
    VerbRow{"params", "List every parameter", rigcal::app::add_params},
    VerbRow{"schema", "Print the JSON schema of campaign files, for editors",
            rigcal::app::add_schema},
};

std::vector<std::string> verb_names() {
  std::vector<std::string> names;
  for (const VerbRow& row : kVerbs) names.emplace_back(row.name);
  return names;
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

/// Quotes an argument so that a shell reads back exactly the same text.
std::string quoted(const std::string& argument) {
  const bool plain = !argument.empty() && std::all_of(argument.begin(), argument.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view("-_=+,./:@%").find(c) != std::string_view::npos;
  });
  if (plain) return argument;
  std::string text = "'";
  for (const char c : argument) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string command_line(int argc, char** argv) {
  std::string text = "rigcal";
  for (int i = 1; i < argc; ++i) text += " " + quoted(argv[i]);
  return text;
}

/// Checks that the first argument is a known verb, so that the message can name an unknown one.
void check_verb(int argc, char** argv) {
  const std::vector<std::string> known = verb_names();
  if (argc < 2) {
    throw rigcal::UsageError(fmt::format("no verb; expected one of {}", fmt::join(known, ", ")));
  }
  const std::string verb = argv[1];
  if (verb == "-h" || verb == "--help" || verb == "--version") return;
  if (!verb.empty() && verb.front() == '-') {
    throw rigcal::UsageError(
        fmt::format("found {}, expected a verb first: one of {}", verb, fmt::join(known, ", ")));
  }
  if (std::find(known.begin(), known.end(), verb) == known.end()) {
    throw rigcal::UsageError(rigcal::unknown_name_message("verb", verb, known));
  }
}

/// Prints the manual page or a completion script for packaging. Returns true if one was requested.
bool print_manual(const CLI::App& app, const std::vector<std::string>& arguments) {
  std::string text;
  if (arguments == std::vector<std::string>{"--man-page"}) {
    text = rigcal::app::man_page(app);
  } else if (!arguments.empty() && arguments.front() == "--completion") {
    text = rigcal::app::completion(app, arguments.size() == 2 ? arguments.back() : "");
  } else {
    return false;
  }
  rigcal::app::print({}, text, std::string());
  return true;
}

/// Runs the work of a process other than the first. The first process meets the same errors and
/// reports them.
ExitCode help(const VerbRow& row, const Run& action, const Invocation& invocation) {
  if (!row.uses_processes) return ExitCode::done;
  try {
    return action(invocation);
  } catch (const rigcal::FarmEnded&) {
    return ExitCode::done;
  } catch (const rigcal::InputError&) {
    return ExitCode::done;
  } catch (const rigcal::UsageError&) {
    return ExitCode::done;
  }
}

ExitCode run(int argc, char** argv) {
  CLI::App app{"Calibrates models of servo-hydraulic rigs from recorded runs", "rigcal"};
  app.set_version_flag(
      "--version",
      fmt::format("rigcal {} ({}{})", rigcal::report::version(), rigcal::report::revision(),
                  rigcal::report::live_module().empty()
                      ? "; no live pages: built without a WebAssembly compiler"
                      : ""));
  app.require_subcommand(1);
  app.fallthrough();
  std::vector<std::tuple<const VerbRow*, CLI::App*, Run>> verbs;
  for (const VerbRow& row : kVerbs) {
    CLI::App* verb = app.add_subcommand(row.name, row.summary);
    verbs.emplace_back(&row, verb, row.add(*verb));
  }
  if (print_manual(app, {argv + std::min(argc, 1), argv + argc})) return ExitCode::done;
  check_verb(argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    app.exit(help);
    return ExitCode::done;
  } catch (const CLI::ParseError& error) {
    const auto chosen = app.get_subcommands();
    throw rigcal::UsageError(chosen.empty()
                                 ? std::string(error.what())
                                 : fmt::format("{}: {}", chosen.front()->get_name(), error.what()));
  }
  const auto processes = rigcal::app::launched_processes();
  const Invocation invocation{command_line(argc, argv), rigcal::app::watch_signals(),
                              processes.get()};
  for (const auto& [row, verb, action] : verbs) {
    if (!verb->parsed()) continue;
    if (!invocation.leads()) return help(*row, action, invocation);
    return action(invocation);
  }
  throw std::logic_error("no verb was parsed");
}

ExitCode complain(ExitCode code, const std::string& message) {
  rigcal::say(fmt::format("rigcal: {}\n", message));
  return code;
}

[[noreturn]] void end(std::string_view words) {
  rigcal::FilesInWriting::remove_all();
  rigcal::report::HeldFolder::remove_if_empty();
  std::fputs(words.data(), stderr);
  std::_Exit(static_cast<int>(ExitCode::internal));
}

/// Ends the process when memory runs out. Unwinding would not be safe: freeing a JSON value
/// allocates memory itself, and some libraries are inconsistent after an exception. Incomplete
/// files are removed first.
void end_without_memory() {
  if (rigcal::Uninterrupted::any()) throw std::bad_alloc();
  end("rigcal: out of memory\n");
}

}  // namespace

int main(int argc, char** argv) {
  std::set_new_handler(end_without_memory);
  rigcal::keep_freed_memory();
  const ExitCode code = [&] {
    try {
      return run(argc, argv);
    } catch (const rigcal::Error& error) {
      return complain(error.code(), one_line(error.what()));
    } catch (const std::bad_alloc&) {
      return complain(ExitCode::internal, "out of memory");
    } catch (const std::exception& error) {
      return complain(ExitCode::internal, one_line(error.what()) + " (this is a bug)");
    }
  }();
  return static_cast<int>(code);
}
