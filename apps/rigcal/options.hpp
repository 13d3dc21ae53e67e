#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "report/run/campaign_choice.hpp"
#include "report/store/folder.hpp"
#include "report/store/json.hpp"
#include "report/text/style.hpp"

namespace rigcal::app {

/// How a verb prints.
struct PrintOptions {
  bool quiet = false;
  bool json = false;
  bool verbose = false;  ///< print every row, however many lines it takes
};

/// Options of a verb that leaves a result.
struct JobOptions {
  std::filesystem::path out = "rigcal-out";
  bool force = false;
  int threads = 1;
  PrintOptions print;
};

/// Options of every verb that reads a campaign.
struct CampaignOptions : report::CampaignChoice, JobOptions {};

/// Refuses the empty path, which a script passes where a variable is not set.
CLI::Validator not_empty();

/// CLI11's own conversion turns numbers that are too large into the largest one.
CLI::Validator whole_number(std::uint64_t lowest, std::uint64_t highest);

/// Threads that this machine has.
int hardware_threads();

void add_print_options(CLI::App& verb, PrintOptions& options);
/// --force
void add_force_option(CLI::App& verb, bool& force);
void add_campaign_options(CLI::App& verb, CampaignOptions& options);

/// How a verb takes its folder of results.
report::Holding holding(std::string verb, bool force, const PrintOptions& print);

/// Columns of the terminal behind a stream; 0 if it is redirected.
std::size_t terminal_columns(int stream);

/// Colour on a terminal, unless NO_COLOR is set; tables as wide as it is.
report::Style terminal_style();
/// The same, with few lines unless all are asked for.
report::Style terminal_style(const PrintOptions& options);

/// Prints a result on stdout, as text or as JSON.
///
/// @throws WriteError  stdout does not take it
void print(const PrintOptions& options, const std::string& text, const report::Json& json);
/// @param json  as text
void print(const PrintOptions& options, const std::string& text, const std::string& json);

}  // namespace rigcal::app
