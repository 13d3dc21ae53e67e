#include <fmt/format.h>

#include <memory>
#include <utility>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/verb.hpp"
#include "report/page/page.hpp"
#include "report/store/folder.hpp"

namespace rigcal::app {
namespace {

struct Options {
  std::filesystem::path folder;
  bool figures = false;
  bool force = false;
  int threads = 1;
  PrintOptions print;
};

ExitCode run_report(const Options& options) {
  report::HeldFolder held(options.folder, holding("report", options.force, options.print));
  report::PlannedFiles planned{{"report.html"}, {}};
  if (options.figures) planned.folders.emplace_back("figures");
  held.plan(std::move(planned));
  const report::ReadFile read = report::files_in(options.folder);
  const std::string where = options.folder.string();
  std::vector<report::ResultFile> files;
  files.push_back({"report.html", report::result_page(read, where, options.threads)});
  if (options.figures) {
    for (auto& [path, text] : report::result_figures(read, where))
      files.push_back({path, std::move(text)});
  }
  report::write_results(held, files, {});
  report::Json json;
  json["files"] = report::Json::array();
  for (const report::ResultFile& file : files)
    json["files"].push_back((options.folder / file.path).string());
  std::string text = fmt::format("files: {}", (options.folder / "report.html").string());
  if (options.figures) text += fmt::format(" {}", (options.folder / "figures" / "").string());
  print(options.print, text + "\n", json);
  return ExitCode::done;
}

}  // namespace

Run add_report(CLI::App& verb) {
  const auto options = std::make_shared<Options>();
  options->threads = hardware_threads();
  verb.add_option("DIR", options->folder, "Folder of results")
      ->required()
      ->check(CLI::ExistingDirectory);
  verb.add_flag("--figures", options->figures,
                "Also write every picture as SVG and PDF into figures/");
  add_force_option(verb, options->force);
  add_print_options(verb, options->print);
  return [options](const Invocation&) { return run_report(*options); };
}

}  // namespace rigcal::app
