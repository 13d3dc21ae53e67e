// Measures the cost of the phases of a fit, and how fast its files are read:
//
//   rigcal_job phases CAMPAIGN ROUNDS
//
// Alternatively, measures the CPU time of each bootstrap replicate, except for a first one that is
// not counted:
//
//   rigcal_job replicates CAMPAIGN DATA COUNT
//
// Prints JSON, which scripts/performance-job converts to tables.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bench/clock.hpp"
#include "calib/fit.hpp"
#include "calib/problem/problem.hpp"
#include "calib/score/scorecard.hpp"
#include "calib/search/evaluator.hpp"
#include "calib/search/multi_start.hpp"
#include "common/memory.hpp"
#include "datasets/prepare/load_record.hpp"
#include "datasets/read/csv/load_csv.hpp"

namespace rigcal::bench {
namespace {

/// Returns all files that a fit reads, with the columns that it needs from each.
std::map<std::string, std::vector<std::string>> files_of(const datasets::Campaign& campaign) {
  std::map<std::string, std::vector<std::string>> files;
  for (const datasets::Condition& condition : campaign.conditions) {
    if (condition.use != datasets::Use::fit && condition.use != datasets::Use::validate) continue;
    for (const auto& source : datasets::repeat_sources(campaign, condition)) {
      std::vector<std::string>& columns = files[source.path.string()];
      columns = {campaign.time_column};
      for (const auto& [channel, column] : source.columns) columns.push_back(column);
    }
  }
  return files;
}

void print_phases(const datasets::Campaign& campaign, int rounds) {
  const auto files = files_of(campaign);
  std::uintmax_t bytes = 0;
  for (const auto& [path, columns] : files) bytes += std::filesystem::file_size(path);

  std::vector<datasets::Record> records;
  calib::FitOptions options;
  options.starts = campaign.fit.starts;
  std::vector<const datasets::Condition*> fitted;
  std::vector<const datasets::Condition*> all;
  for (const datasets::Condition& each : campaign.conditions) {
    if (each.use == datasets::Use::fit) fitted.push_back(&each);
    if (each.use == datasets::Use::fit || each.use == datasets::Use::validate) all.push_back(&each);
  }
  calib::MultiStart found;
  const std::vector<std::pair<std::string, std::function<void()>>> phases{
      {"parse",
       [&] {
         for (const auto& [path, columns] : files)
           datasets::load_csv_record(path, {columns, campaign.time_column, campaign.separator});
       }},
      {"read and average",
       [&] {
         records = datasets::load_records(campaign, {datasets::Use::fit, datasets::Use::validate},
                                          1, true);
       }},
      {"search",
       [&] {
         const auto problem = calib::make_problem(campaign, records, fitted, false, nullptr);
         calib::Budget budget;
         calib::Evaluator evaluator(problem, budget);
         found = calib::multi_start(problem, evaluator, options);
       }},
      {"scores",
       [&] {
         const auto problem = calib::make_problem(campaign, records, all, false, nullptr);
         calib::score_conditions(problem, found.optimum.z, 1);
       }},
      {"fit", [&] { calib::fit(campaign, records, options); }}};
  std::map<std::string, std::vector<double>> taken;
  for (int round = 0; round <= rounds; ++round) {
    for (const auto& [name, run] : phases) {
      const double before = cpu_ms();
      run();
      if (round > 0) taken[name].push_back(cpu_ms() - before);  // the first round warms the caches
    }
  }
  fmt::print("{{\"bytes\": {}, \"files\": {}", bytes, files.size());
  for (const auto& [name, run] : phases) fmt::print(", \"{}\": {:.2f}", name, median(taken[name]));
  fmt::print("}}\n");
}

void print_replicates(const datasets::Campaign& campaign, int count) {
  const auto records =
      datasets::load_records(campaign, {datasets::Use::fit, datasets::Use::validate}, 1, true);
  calib::FitOptions options;
  options.starts = campaign.fit.starts;
  options.bootstrap = count + 1;
  const double began = cpu_ms();
  std::vector<double> ends;
  options.beside = [&](const char* what, int, int) {
    if (std::string_view(what) == "replicates of the bootstrap") ends.push_back(cpu_ms());
  };
  const calib::Fit fit = calib::fit(campaign, records, options);
  const double whole = cpu_ms() - began;
  std::vector<double> taken;
  for (std::size_t b = 1; b < ends.size(); ++b) taken.push_back(ends[b] - ends[b - 1]);
  fmt::print(
      "{{\"unknowns\": {}, \"residuals\": {}, \"whole_ms\": {:.1f}, \"replicates_ms\": "
      "[{:.1f}]}}\n",
      std::count_if(fit.parameters.begin(), fit.parameters.end(),
                    [](const auto& each) { return each.fitted; }),
      fit.residual_count, whole, fmt::join(taken, ", "));
}

}  // namespace
}  // namespace rigcal::bench

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  rigcal::keep_freed_memory();
  if (words.size() == 3 && words[0] == "phases") {
    rigcal::bench::print_phases(rigcal::datasets::load_campaign(words[1]), std::stoi(words[2]));
  } else if (words.size() == 4 && words[0] == "replicates") {
    rigcal::bench::print_replicates(rigcal::datasets::load_campaign(words[1], words[2]),
                                    std::stoi(words[3]));
  } else {
    fmt::print(stderr,
               "usage: rigcal_job phases CAMPAIGN ROUNDS\n"
               "       rigcal_job replicates CAMPAIGN DATA COUNT\n");
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
