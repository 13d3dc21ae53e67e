#include "report/json/json_node.hpp"

#include <algorithm>

#include "common/suggest.hpp"

namespace rigcal::report {

int parameter_row(const JsonNode& name, model::PlantKind plant) {
  const auto table = model::parameter_table(plant);
  const std::string text = name.string();
  const auto found = std::find_if(table.begin(), table.end(),
                                  [&](const model::ParameterSpec& s) { return s.name == text; });
  if (found == table.end()) {
    std::vector<std::string> known;
    for (const model::ParameterSpec& spec : table) known.emplace_back(spec.name);
    const std::string near = nearest_name(text, known);
    name.fail(fmt::format("a parameter of the plant {}{}", to_string(plant),
                          near.empty() ? "" : " such as " + near));
  }
  return static_cast<int>(found - table.begin());
}

}  // namespace rigcal::report
