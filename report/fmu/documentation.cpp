#include "report/fmu/documentation.hpp"

#include <fmt/format.h>

#include "report/store/provenance.hpp"
#include "report/text/escape.hpp"

namespace rigcal::report {
namespace {

std::string row(std::initializer_list<std::string> cells) {
  std::string text = "<tr>";
  for (const std::string& cell : cells) text += "<td>" + escaped(cell) + "</td>";
  return text + "</tr>\n";
}

const char* role(const FmuVariable& variable) {
  if (variable.is_state) return variable.is_output() ? "state, output" : "state";
  switch (variable.causality) {
    case Causality::input:
      return "input";
    case Causality::output:
      return "output";
    case Causality::parameter:
      return variable.tunable ? "parameter" : "parameter, fixed";
    case Causality::local:
      break;
  }
  return "rate";
}

}  // namespace

std::string fmu_documentation(const FmuRequest& request, const std::vector<FmuVariable>& variables,
                              const std::string& compile) {
  std::string text =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>" +
      escaped(request.name) +
      "</title>\n<style>body { font: 16px/1.5 sans-serif; max-width: 60em; margin: 2em auto; "
      "padding: 0 1em } td, th { text-align: left; padding: 0.1em 1em 0.1em 0; vertical-align: top "
      "}</style>\n</head>\n<body>\n<h1>" +
      escaped(request.name) + "</h1>\n<p>A servo-hydraulic rig for FMI 2.0, model exchange and " +
      "co-simulation, written by rigcal. Its outputs are the quantities of the rig, without the " +
      "gains, offsets, lags and limits of sensors. All values are in SI.</p>\n" +
      "<h2>Where the values come from</h2>\n<table>\n";
  text += row({"written by", fmt::format("rigcal {} ({})", version(), revision())});
  for (const auto& [label, words] : request.origin) text += row({label, words});
  text +=
      "</table>\n<h2>Variables</h2>\n<table>\n<tr><th>name</th><th>role</th><th>start</th>"
      "<th>unit</th><th>meaning</th></tr>\n";
  for (const FmuVariable& variable : variables) {
    if (variable.derivative_of > 0) continue;
    text += row({variable.name, role(variable),
                 variable.start ? fmt::format("{}", *variable.start) : "", variable.unit,
                 variable.meaning});
  }
  return text + "</table>\n<h2>Sources</h2>\n<p>The folder sources/ contains the equations, the " +
         "solver and the FMI functions in C++20. They need nothing but a compiler:</p>\n<pre>" +
         escaped(compile) + "</pre>\n</body>\n</html>\n";
}

}  // namespace rigcal::report
