#include "apps/rigcal/options.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "apps/rigcal/processes.hpp"
#include "common/error.hpp"
#include "common/printable.hpp"
#include "report/run/fit_choices.hpp"
#include "report/text/text_table.hpp"

namespace rigcal::app {

using report::kMostThreads;

CLI::Validator not_empty() {
  return CLI::Validator(
      [](std::string& text) { return text.empty() ? std::string("found an empty path") : ""; },
      "PATH");
}

CLI::Validator whole_number(std::uint64_t lowest, std::uint64_t highest) {
  return CLI::Validator(
      [=](std::string& text) {
        std::uint64_t value = 0;
        const char* end = text.data() + text.size();
        const auto [rest, error] = std::from_chars(text.data(), end, value);
        const bool valid =
            error == std::errc{} && rest == end && value >= lowest && value <= highest;
        return valid ? std::string()
                     : fmt::format("found {}, expected a whole number from {} to {}", text, lowest,
                                   highest);
      },
      "INTEGER");
}

int hardware_threads() {
  const unsigned count =
      std::thread::hardware_concurrency() / static_cast<unsigned>(processes_on_this_machine());
  return count > 0 ? static_cast<int>(std::min<unsigned>(count, kMostThreads)) : 1;
}

void add_print_options(CLI::App& verb, PrintOptions& options) {
  verb.add_flag("--quiet", options.quiet, "Print nothing but errors");
  verb.add_flag("--json", options.json, "Print JSON instead of text");
  verb.add_flag("-v,--verbose", options.verbose,
                "Print every section of the result, and every row even on a terminal");
}

void add_force_option(CLI::App& verb, bool& force) {
  verb.add_flag("--force", force,
                "Replace files that rigcal did not write, or that were changed since");
}

report::Holding holding(std::string verb, bool force, const PrintOptions& print) {
  report::Holding holding{std::move(verb), force};
  if (!print.quiet) {
    holding.warn = [](const std::string& text) { say(fmt::format("warning: {}\n", text)); };
  }
  return holding;
}

void add_campaign_options(CLI::App& verb, CampaignOptions& options) {
  options.threads = hardware_threads();
  verb.add_option("CAMPAIGN", options.campaign, "Campaign file")->required()->check(not_empty());
  verb.add_option("--data", options.data,
                  "Where relative record paths start (default: the campaign file's folder)")
      ->check(not_empty());
  verb.add_option("--root", options.root,
                  "Read no campaign and no recording outside this folder, wherever links lead")
      ->check(not_empty());
  verb.add_option("--out", options.out, "Folder of the results")
      ->check(not_empty())
      ->capture_default_str();
  add_force_option(verb, options.force);
  // Each --set takes exactly one value; otherwise it would consume the campaign file.
  verb.add_option("--set", options.set, "Change a value: name=\"value unit\"; repeatable")
      ->allow_extra_args(false);
  verb.add_option("--free", options.free, "Fit exactly these parameters: a,b")
      ->delimiter(',')
      ->allow_extra_args(false);
  verb.add_option("--threads", options.threads, "Number of threads; does not affect the results")
      ->check(CLI::Range(1, kMostThreads))
      ->default_str("all");
  add_print_options(verb, options.print);
}

std::size_t terminal_columns(int stream) {
  winsize size{};
  if (::isatty(stream) != 1 || ::ioctl(stream, TIOCGWINSZ, &size) != 0) return 0;
  return size.ws_col;
}

namespace {

/// Returns the value of COLUMNS, as other programs do, or else the width of the terminal.
std::size_t output_columns() {
  constexpr std::size_t kFewest = 20;
  constexpr std::size_t kMost = 10'000;
  const char* const text = std::getenv("COLUMNS");
  if (text != nullptr) {
    const std::string_view wanted(text);
    std::size_t columns = 0;
    const auto [end, error] =
        std::from_chars(wanted.data(), wanted.data() + wanted.size(), columns);
    if (error == std::errc() && end == wanted.data() + wanted.size() && columns >= kFewest &&
        columns <= kMost)
      return columns;
  }
  return terminal_columns(STDOUT_FILENO);
}

}  // namespace

report::Style terminal_style() {
  const char* no_colour = std::getenv("NO_COLOR");
  const bool wanted = no_colour == nullptr || std::strlen(no_colour) == 0;
  return {wanted && ::isatty(STDOUT_FILENO) == 1, output_columns()};
}

report::Style terminal_style(const PrintOptions& options) {
  report::Style style = terminal_style();
  style.everything = options.verbose;
  // Redirected output is for programs and logs, so its length is not limited.
  if (::isatty(STDOUT_FILENO) == 1 && !options.verbose) style.lines = report::kTerminalLines;
  return style;
}

void print(const PrintOptions& options, const std::string& text, const report::Json& json) {
  print(options, text, report::json_text(json));
}

void print(const PrintOptions& options, const std::string& text, const std::string& json) {
  if (options.quiet) return;
  // The JSON writer leaves a few characters unescaped. The escapes that printable() writes for them
  // are valid JSON.
  const std::string shown =
      options.json
          ? printable(json)
          : report::wrapped_lines(printable(text, terminal_style().colour), output_columns());
  const bool written = std::fwrite(shown.data(), 1, shown.size(), stdout) == shown.size();
  if (!written || std::fflush(stdout) != 0) {
    throw WriteError("standard output: cannot be written: " +
                     std::generic_category().message(errno));
  }
}

}  // namespace rigcal::app
