#include <memory>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/verb.hpp"
#include "report/text/terminal.hpp"

namespace rigcal::app {
namespace {

ExitCode run_params(const PrintOptions& options) {
  std::string text;
  report::Json json = report::Json::object();
  for (const std::string& name : model::plant_names()) {
    const model::PlantKind plant = model::plant_from_name(name).value();
    text += "model \"" + name + "\" (SI units)\n" +
            report::parameter_table_text(plant, terminal_style());
    json[name] = report::parameters_json(plant);
  }
  print(options, text, json);
  return ExitCode::done;
}

}  // namespace

Run add_params(CLI::App& verb) {
  const auto options = std::make_shared<PrintOptions>();
  add_print_options(verb, *options);
  return [options](const Invocation&) { return run_params(*options); };
}

}  // namespace rigcal::app
