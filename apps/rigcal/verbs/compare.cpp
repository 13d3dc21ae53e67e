#include <memory>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/outcome.hpp"
#include "apps/rigcal/verb.hpp"

namespace rigcal::app {
namespace {

struct CompareOptions : JobOptions {
  std::vector<std::filesystem::path> folders;
};

}  // namespace

Run add_compare(CLI::App& verb) {
  const auto options = std::make_shared<CompareOptions>();
  verb.add_option("DIR", options->folders,
                  "Folders of fits or validations; the others are compared with the first")
      ->required()
      ->check(CLI::ExistingDirectory);
  verb.add_option("--out", options->out, "Folder of the results")
      ->check(not_empty())
      ->capture_default_str();
  add_force_option(verb, options->force);
  add_print_options(verb, options->print);
  options->threads = hardware_threads();
  return [options](const Invocation& invocation) {
    return run_job("compare", *options, invocation, [&](const report::JobTerms& terms) {
      return report::comparison_job(options->folders, terms);
    });
  };
}

}  // namespace rigcal::app
