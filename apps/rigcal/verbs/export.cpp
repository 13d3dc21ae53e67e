#include <fmt/format.h>

#include <memory>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/verb.hpp"
#include "common/suggest.hpp"
#include "report/fmu/zip.hpp"
#include "report/job/export_choices.hpp"
#include "report/store/folder.hpp"

namespace rigcal::app {
namespace {

struct ExportOptions : report::ExportRequest {
  CampaignOptions common;
  std::string format;
};

ExitCode run_export(const ExportOptions& options) {
  if (options.format != "fmu")
    throw UsageError("export: " + unknown_name_message("format", options.format, {"fmu"}));
  const report::ExportChoice choice =
      report::choose_export(load(options.common), options.common, options);
  const std::filesystem::path& out = options.common.out;
  report::HeldFolder held(out, holding("export", options.common.force, options.common.print));
  const std::string name = choice.fmu.identifier + ".fmu";
  held.plan({{name}, {}});
  report::write_results(held, {{name, report::zipped(report::fmu_files(choice.fmu))}},
                        choice.inputs);
  std::string text;
  for (const auto& [label, words] : choice.fmu.origin) {
    if (label != "made from") text += fmt::format("{}: {}\n", label, words);
  }
  text += fmt::format("files: {}\n", (out / name).string());
  report::Json json;
  json["file"] = (out / name).string();
  json["model_identifier"] = choice.fmu.identifier;
  json["warnings"] = choice.warnings;
  print(options.common.print, text, json);
  return ExitCode::done;
}

}  // namespace

Run add_export(CLI::App& verb) {
  const auto options = std::make_shared<ExportOptions>();
  verb.add_option("FORMAT", options->format, "fmu: FMI 2.0 model exchange and co-simulation")
      ->required();
  add_campaign_options(verb, options->common);
  verb.add_option("--fit", options->fit.file,
                  "fit.json of a fit of the rig (default: the campaign's own values)")
      ->check(not_empty());
  verb.add_option("--condition", options->condition,
                  "Leak level, start and duration as in this condition");
  verb.add_option("--level", options->level,
                  "Leak level whose values are exported (default: the only one)");
  verb.add_flag("--without-delay", options->without_delay,
                "Leave out transport_delay, which an FMU cannot contain");
  return [options](const Invocation&) { return run_export(*options); };
}

}  // namespace rigcal::app
