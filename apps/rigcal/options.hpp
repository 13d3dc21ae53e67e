#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <string>

#include "report/run/campaign_choice.hpp"
#include "report/store/folder.hpp"
#include "report/store/json.hpp"
#include "report/text/style.hpp"

namespace rigcal::app {

/// How a verb prints its result.
struct PrintOptions {
  bool quiet = false;
  bool json = false;
  bool verbose = false;  ///< print every row, however many lines that takes
};

/// Options of a verb that produces a result.
struct JobOptions {
  std::filesystem::path out = "rigcal-out";
  bool force = false;
  int threads = 1;
  PrintOptions print;
};

/// Options of every verb that reads a campaign.
struct CampaignOptions : report::CampaignChoice, JobOptions {};

/// Rejects an empty path, which a script passes if a variable is not set.
CLI::Validator not_empty();

/// Accepts whole numbers in a range. CLI11's own conversion would turn numbers that are too large
/// into the largest one.
CLI::Validator whole_number(std::uint64_t lowest, std::uint64_t highest);

int hardware_threads();

void add_print_options(CLI::App& verb, PrintOptions& options);
void add_force_option(CLI::App& verb, bool& force);
void add_campaign_options(CLI::App& verb, CampaignOptions& options);

/// Describes how a verb may use its results folder.
report::Holding holding(std::string verb, bool force, const PrintOptions& print);

/// Returns the width of the terminal that a stream writes to, or 0 if the stream is redirected.
std::size_t terminal_columns(int stream);

/// Returns the style for the terminal: in colour unless NO_COLOR is set, with tables as wide as the
/// terminal.
report::Style terminal_style();
/// Returns the style for the terminal with a limited number of lines, unless the user requests all
/// of them.
report::Style terminal_style(const PrintOptions& options);

/// Prints a result on stdout as text or as JSON.
///
/// @throws WriteError  if writing to stdout fails
void print(const PrintOptions& options, const std::string& text, const report::Json& json);
/// @param json  JSON that is already formatted as text
void print(const PrintOptions& options, const std::string& text, const std::string& json);

}  // namespace rigcal::app
