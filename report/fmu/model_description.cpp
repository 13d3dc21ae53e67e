#include "report/fmu/model_description.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

#include "report/fmu/units.hpp"
#include "report/store/provenance.hpp"
#include "report/text/escape.hpp"

namespace rigcal::report {
namespace {

std::string attribute(const char* name, const std::string& value) {
  return fmt::format(" {}=\"{}\"", name, escaped(value));
}
std::string attribute(const char* name, const std::optional<double>& value) {
  return value ? fmt::format(" {}=\"{}\"", name, *value) : "";
}

std::string source_files(const std::vector<std::string>& sources) {
  std::string text = "    <SourceFiles>\n";
  for (const std::string& name : sources)
    text += fmt::format("      <File{}/>\n", attribute("name", name));
  return text + "    </SourceFiles>\n";
}

std::string interfaces(const FmuRequest& request, const std::vector<std::string>& sources) {
  const std::string common =
      attribute("modelIdentifier", request.identifier) +
      " canNotUseMemoryManagementFunctions=\"true\" canGetAndSetFMUstate=\"true\"";
  const std::string files = source_files(sources);
  return "  <ModelExchange" + common + " completedIntegratorStepNotNeeded=\"true\">\n" + files +
         "  </ModelExchange>\n  <CoSimulation" + common +
         " canHandleVariableCommunicationStepSize=\"true\" canInterpolateInputs=\"true\">\n" +
         files + "  </CoSimulation>\n";
}

std::string exponent(const char* name, int power) {
  return power == 0 ? "" : fmt::format(" {}=\"{}\"", name, power);
}

std::string unit_definitions(const std::vector<FmuVariable>& variables) {
  std::set<std::string> units;
  for (const FmuVariable& variable : variables) units.insert(variable.unit);
  std::string text = "  <UnitDefinitions>\n";
  for (const std::string& unit : units) {
    const BaseUnits& base = base_units(unit);
    text += fmt::format("    <Unit{}><BaseUnit{}{}{}{}{}{}/></Unit>\n", attribute("name", unit),
                        exponent("kg", base.kg), exponent("m", base.m), exponent("s", base.s),
                        exponent("A", base.A), exponent("K", base.K), exponent("rad", base.rad));
  }
  return text + "  </UnitDefinitions>\n";
}

const char* causality(const FmuVariable& variable) {
  switch (variable.causality) {
    case Causality::input:
      return "input";
    case Causality::output:
      return "output";
    case Causality::local:
      return "local";
    case Causality::parameter:
      return "parameter";
  }
  return "";
}

/// Omits `initial`. Its default in the standard follows from causality and variability: exact for
/// parameters, calculated for outputs and local variables.
std::string scalar_variable(const FmuVariable& variable) {
  const char* variability = variable.causality != Causality::parameter ? "continuous"
                            : variable.tunable                         ? "tunable"
                                                                       : "fixed";
  std::string text =
      fmt::format("    <ScalarVariable{}{}{} causality=\"{}\" variability=\"{}\">",
                  attribute("name", variable.name),
                  attribute("valueReference", fmt::format("{}", variable.reference)),
                  attribute("description", variable.meaning), causality(variable), variability);
  text += "<Real" + attribute("unit", variable.unit) + attribute("min", variable.lower) +
          attribute("max", variable.upper) + attribute("nominal", variable.nominal) +
          attribute("start", variable.start);
  if (variable.derivative_of > 0) text += fmt::format(" derivative=\"{}\"", variable.derivative_of);
  if (variable.changes_at_ticks) text += " reinit=\"true\"";
  return text + "/></ScalarVariable>\n";
}

std::string model_structure(const std::vector<FmuVariable>& variables) {
  std::string outputs;
  std::string derivatives;
  std::string initial;
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const FmuVariable& variable = variables[i];
    const std::string unknown = fmt::format("      <Unknown index=\"{}\"", i + 1);
    if (variable.is_output()) {
      outputs += unknown;
      if (variable.is_state)
        outputs += fmt::format(" dependencies=\"{}\" dependenciesKind=\"constant\"", i + 1);
      outputs += "/>\n";
    }
    if (variable.derivative_of > 0) derivatives += unknown + "/>\n";
    if (variable.is_output() || variable.is_state || variable.derivative_of > 0)
      initial += unknown + "/>\n";
  }
  return "  <ModelStructure>\n    <Outputs>\n" + outputs + "    </Outputs>\n    <Derivatives>\n" +
         derivatives + "    </Derivatives>\n    <InitialUnknowns>\n" + initial +
         "    </InitialUnknowns>\n  </ModelStructure>\n";
}

}  // namespace

std::string model_description(const FmuRequest& request, const std::vector<FmuVariable>& variables,
                              std::size_t indicators, const std::vector<std::string>& sources) {
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  text += fmt::format(
      "<fmiModelDescription fmiVersion=\"2.0\"{}{}{}{} variableNamingConvention=\"structured\" "
      "numberOfEventIndicators=\"{}\">\n",
      attribute("modelName", request.name), attribute("guid", request.rig.guid),
      attribute("description", "servo-hydraulic rig, calibrated by rigcal"),
      attribute("generationTool", fmt::format("rigcal {}", version())), indicators);
  text += interfaces(request, sources);
  text += unit_definitions(variables);
  text +=
      "  <LogCategories>\n    <Category name=\"logStatusError\" description=\"why a function "
      "returned fmi2Error\"/>\n  </LogCategories>\n";
  text += fmt::format(
      "  <DefaultExperiment startTime=\"{}\" stopTime=\"{}\" tolerance=\"{}\" stepSize=\"{}\"/>\n",
      request.start_s, request.stop_s, request.rig.tolerance, request.step_s);
  text += "  <ModelVariables>\n";
  for (std::size_t i = 0; i < variables.size(); ++i) {
    text += fmt::format("    <!-- {} -->\n", i + 1);
    text += scalar_variable(variables[i]);
  }
  return text + "  </ModelVariables>\n" + model_structure(variables) + "</fmiModelDescription>\n";
}

}  // namespace rigcal::report
