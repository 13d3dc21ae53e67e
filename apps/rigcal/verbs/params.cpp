#include <fmt/format.h>

#include <memory>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/verb.hpp"
#include "report/store/json.hpp"
#include "report/text/text_table.hpp"

namespace rigcal::app {
namespace {

std::string parameter_table_text(model::PlantKind plant, const report::Style& style) {
  using report::TextTable;
  using Align = TextTable::Align;
  TextTable table({{"key"},
                   {"symbol", Align::left, 1},
                   {"unit"},
                   {"default", Align::right, 4},
                   {"lowest", Align::right, 5},
                   {"highest", Align::right, 6},
                   {"kind", Align::left, 2},
                   {"meaning"},
                   {"source", Align::left, 3}});
  for (const model::ParameterSpec& spec : model::parameter_table(plant)) {
    table.add({std::string(spec.key), std::string(spec.symbol), std::string(spec.unit),
               spec.default_value ? fmt::format("{:g}", *spec.default_value) : "-",
               fmt::format("{:g}", spec.lower), fmt::format("{:g}", spec.upper),
               std::string(to_string(spec.kind)), std::string(spec.meaning),
               std::string(spec.source)});
  }
  return table.text(style.columns);
}

ExitCode run_params(const PrintOptions& options) {
  std::string text;
  report::Json json = report::Json::object();
  for (const std::string& name : model::plant_names()) {
    const model::PlantKind plant = model::plant_from_name(name).value();
    text += "model \"" + name + "\" (SI units)\n" + parameter_table_text(plant, terminal_style());
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
