#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <vector>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/verb.hpp"
#include "datasets/draft_campaign.hpp"
#include "report/folder.hpp"

namespace rigcal::app {
namespace {

struct InitRequest {
  std::vector<std::filesystem::path> files;
  std::filesystem::path out = "rigcal-out";
  PrintOptions print;
};

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++count;
  return count;
}

ExitCode run_init(const InitRequest& options) {
  const auto path = options.out / "campaign.toml";
  if (std::filesystem::exists(path)) {
    throw UsageError(fmt::format("--out {}: {} is there already; choose another folder",
                                 options.out.string(), path.string()));
  }
  const std::string draft = datasets::draft_campaign(options.files, options.out);
  report::write_results(options.out, {{"campaign.toml", draft}}, {});
  // The first blank is in the head, which explains them.
  const std::size_t blanks = count_of(draft, datasets::kBlank) - 1;
  report::Json json;
  json["campaign"] = path.string();
  json["blanks"] = blanks;
  print(options.print,
        fmt::format("files: {}\n{} blanks marked \"{}\"; then: rigcal check {}\n", path.string(),
                    blanks, datasets::kBlank, path.string()),
        json);
  return ExitCode::done;
}

}  // namespace

Run add_init(CLI::App& verb) {
  const auto options = std::make_shared<InitRequest>();
  verb.add_option("FILE", options->files, "Recordings, CSV or MAT")->required();
  verb.add_option("--out", options->out, "Folder of the draft")->capture_default_str();
  add_print_options(verb, options->print);
  return [options](const Invocation&) { return run_init(*options); };
}

}  // namespace rigcal::app
