#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/verb.hpp"
#include "datasets/campaign/keys/campaign_keys.hpp"
#include "datasets/draft/draft_campaign.hpp"
#include "datasets/draft/recordings_in.hpp"
#include "datasets/read/record_reader.hpp"
#include "report/json/read_json.hpp"
#include "report/run/missing_terms.hpp"
#include "report/store/folder.hpp"
#include "report/store/stored.hpp"
#include "report/store/stored/stored_fit.hpp"

namespace rigcal::app {
namespace {

struct InitRequest {
  std::vector<std::filesystem::path> files;
  std::filesystem::path out = "rigcal-out";
  std::filesystem::path fit;
  bool force = false;
  PrintOptions print;
};

/// Counts the blanks of a draft. Those in lines of comments need not be filled in.
std::size_t blanks_in(const std::string& draft) {
  std::size_t count = 0;
  std::istringstream lines(draft);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('#')) continue;
    const std::string_view blank = datasets::kBlank;
    for (std::size_t at = line.find(blank); at != std::string::npos; at = line.find(blank, at + 1))
      ++count;
  }
  return count;
}

/// Returns the terms that the residuals of an earlier fit call for.
std::vector<report::MissingTerm> terms_of(const std::filesystem::path& file) {
  const report::Json json = report::read_json(file, "the fit.json of an earlier fit");
  const auto fit = report::as<report::StoredFit>(json, "", file.string());
  const std::optional<model::PlantKind> plant = fit.model;
  if (!plant || !fit.considered) return {};
  return report::missing_terms(*plant, *fit.considered);
}

ExitCode run_init(const InitRequest& options) {
  const auto path = options.out / "campaign.toml";
  report::HeldFolder held(options.out, holding("init", options.force, options.print));
  held.plan({{"campaign.toml", datasets::kSchemaFile}, {}});
  const datasets::Draft draft =
      datasets::draft_campaign(datasets::recordings_in(options.files), options.out);
  const auto terms =
      options.fit.empty() ? std::vector<report::MissingTerm>() : terms_of(options.fit);
  report::write_results(held,
                        {{"campaign.toml", report::with_terms(draft.text, terms)},
                         {datasets::kSchemaFile, datasets::campaign_schema()}},
                        {});
  const std::size_t blanks = blanks_in(draft.text);
  report::Json json;
  json["campaign"] = path.string();
  json["blanks"] = blanks;
  json["left_out"] = draft.left_out;
  json["terms"] = terms.size();
  std::string text;
  for (const std::string& file : draft.left_out)
    text += fmt::format("warning: left out: {}\n", file);
  for (const report::MissingTerm& each : terms)
    text += fmt::format("the residuals of the earlier fit indicate: {}\n", each.line);
  print(options.print,
        text + fmt::format("files: {}\n{} blanks marked \"{}\"; then: rigcal check {}\n",
                           path.string(), blanks, datasets::kBlank, path.string()),
        json);
  return ExitCode::done;
}

}  // namespace

Run add_init(CLI::App& verb) {
  const auto options = std::make_shared<InitRequest>();
  verb.add_option("FILE", options->files,
                  "Recordings (" + datasets::record_format_names() + "), or folders of them")
      ->required();
  verb.add_option("--out", options->out, "Folder of the draft")
      ->check(not_empty())
      ->capture_default_str();
  verb.add_option("--fit", options->fit,
                  "fit.json of an earlier fit: the draft estimates the missing terms that its "
                  "residuals indicate");
  add_force_option(verb, options->force);
  add_print_options(verb, options->print);
  return [options](const Invocation&) { return run_init(*options); };
}

}  // namespace rigcal::app
