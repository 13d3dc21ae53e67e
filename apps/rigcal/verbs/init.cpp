#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/verb.hpp"
#include "common/error.hpp"
#include "common/file.hpp"
#include "datasets/draft/draft_campaign.hpp"
#include "datasets/read/record_reader.hpp"
#include "report/store/folder.hpp"

namespace rigcal::app {
namespace {

struct InitRequest {
  std::vector<std::filesystem::path> files;
  std::filesystem::path out = "rigcal-out";
  bool force = false;
  PrintOptions print;
};

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++count;
  return count;
}

/// A folder means the recordings in it, in the order of their names.
std::vector<std::filesystem::path> with_folders_opened(
    const std::vector<std::filesystem::path>& paths) {
  std::vector<std::filesystem::path> files;
  std::error_code error;  // a link may lead nowhere
  for (const auto& path : paths) {
    if (!std::filesystem::is_directory(path, error)) {
      require_regular_file(path, fmt::format("a recording ({})", datasets::record_format_names()));
      files.push_back(path);
      continue;
    }
    const std::size_t before = files.size();
    const std::filesystem::directory_iterator entries(path, error);
    if (error)
      throw InputError(
          {path.string()},
          fmt::format("cannot be opened: {}; expected a folder of recordings", error.message()));
    std::vector<std::filesystem::path> unread;
    for (const auto& entry : entries) {
      if (!entry.is_regular_file(error)) continue;
      if (datasets::may_be_recording(entry.path())) files.push_back(entry.path());
      if (datasets::has_other_format_name(entry.path())) unread.push_back(entry.path());
    }
    // The reader of these formats explains what to do with them.
    if (files.size() == before) files.insert(files.end(), unread.begin(), unread.end());
    if (files.size() == before) {
      throw UsageError(fmt::format("{}: this folder holds no {} file; expected recordings",
                                   path.string(), datasets::record_extensions()));
    }
    std::sort(files.begin() + static_cast<std::ptrdiff_t>(before), files.end());
  }
  return files;
}

ExitCode run_init(const InitRequest& options) {
  const auto path = options.out / "campaign.toml";
  report::HeldFolder held(options.out, holding("init", options.force, options.print));
  held.plan({{"campaign.toml"}, {}});
  const datasets::Draft draft =
      datasets::draft_campaign(with_folders_opened(options.files), options.out);
  report::write_results(held, {{"campaign.toml", draft.text}}, {});
  // The first blank is in the head, which explains them.
  const std::size_t blanks = count_of(draft.text, datasets::kBlank) - 1;
  report::Json json;
  json["campaign"] = path.string();
  json["blanks"] = blanks;
  json["left_out"] = draft.left_out;
  std::string text;
  for (const std::string& file : draft.left_out)
    text += fmt::format("warning: left out: {}\n", file);
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
  add_force_option(verb, options->force);
  add_print_options(verb, options->print);
  return [options](const Invocation&) { return run_init(*options); };
}

}  // namespace rigcal::app
