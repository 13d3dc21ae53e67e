#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/outcome.hpp"
#include "apps/rigcal/verb.hpp"
#include "common/error.hpp"
#include "common/file.hpp"
#include "report/comparison/comparison.hpp"
#include "report/comparison/comparison_curves.hpp"
#include "report/page/page_parts.hpp"
#include "report/run/result_page.hpp"
#include "report/store/folder.hpp"
#include "report/store/json.hpp"
#include "report/store/result_files.hpp"

namespace rigcal::app {
namespace {

struct CompareOptions {
  std::vector<std::filesystem::path> folders;
  std::filesystem::path out = "rigcal-out";
  bool force = false;
  PrintOptions print;
};

ExitCode run_compare(const CompareOptions& options, const Invocation& invocation) {
  if (options.folders.size() < 2)
    throw UsageError("compare: expected two result folders or more, the one to compare with first");
  for (auto folder = options.folders.begin(); folder != options.folders.end(); ++folder) {
    const auto same = [&](const auto& other) {
      return std::filesystem::equivalent(*folder, other);
    };
    if (std::any_of(options.folders.begin(), folder, same))
      throw UsageError(fmt::format("compare: {} is given twice", folder->string()));
  }
  const std::vector<report::Compared> results = report::load_compared(options.folders);
  report::HeldFolder held(options.out, holding("compare", options.force, options.print));
  held.plan({{"comparison.json", "report.html"}, {"overlay"}});
  report::Provenance provenance;
  provenance.command = invocation.command;
  for (const report::Compared& each : results)
    provenance.inputs.push_back({each.file.string(), sha256_of_file(each.file)});
  report::StoredComparison comparison = report::compared(results, provenance);
  std::vector<report::ResultFile> files = report::comparison_curves(results);
  report::name_files(files, comparison.provenance);
  const report::Json json = report::json_of(comparison);
  files.push_back({"comparison.json", report::json_text(json)});
  add_page(options.out, hardware_threads(), files);
  report::write_results(held, files, provenance.inputs);
  print(options.print,
        {report::comparison_headline(comparison), report::comparison_sections(comparison)},
        options.out, {"comparison.json", "report.html"}, json);
  return comparison.status == "done" ? ExitCode::done : ExitCode::no_result;
}

}  // namespace

Run add_compare(CLI::App& verb) {
  const auto options = std::make_shared<CompareOptions>();
  verb.add_option("DIR", options->folders,
                  "Folders of fits or validations; the first is what the others are compared with")
      ->required()
      ->check(CLI::ExistingDirectory);
  verb.add_option("--out", options->out, "Folder of the results")
      ->check(not_empty())
      ->capture_default_str();
  add_force_option(verb, options->force);
  add_print_options(verb, options->print);
  return [options](const Invocation& invocation) { return run_compare(*options, invocation); };
}

}  // namespace rigcal::app
