#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <string>

#include "report/batch/batch.hpp"
#include "report/store/json.hpp"
#include "report/store/stored.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace rigcal::report;

namespace {

/// JSON with what fits on a line on one.
std::string compact(const Json& json, const std::string& indent = "") {
  constexpr std::size_t kLine = 110;
  const std::string line = json.dump();
  if (!json.is_structured() || indent.size() + line.size() <= kLine) return line;
  const std::string deeper = indent + "  ";
  std::string text;
  for (const auto& [key, value] : json.items()) {
    text += (text.empty() ? "\n" : ",\n") + deeper;
    if (json.is_object()) text += Json(key).dump() + ": ";
    text += compact(value, deeper);
  }
  text += "\n" + indent;
  return json.is_object() ? "{" + text + "}" : "[" + text + "]";
}

template <typename T>
std::string schema_text(const std::string& file, const Json& more) {
  Json schema = {
      {"$schema", "http://json-schema.org/draft-07/schema#"},
      {"title", file + " of rigcal"},
      {"description",
       "SI units unless a name says otherwise; a name ends in its unit. null where there "
       "is no number. Further keys may be added."}};
  schema.update(schema_of<T>());
  schema.update(more);
  return compact(schema) + "\n";
}

/// @param more  what a result obeys that no member of its type says
template <typename T>
void check_schema(const std::string& name, const Json& more = Json::object()) {
  const std::string file = std::string(RIGCAL_SOURCE_DIR) + "/docs/schema/" + name + ".schema.json";
  const std::string text = schema_text<T>(name + ".json", more);
  if (std::getenv("RIGCAL_WRITE_SCHEMAS") != nullptr) std::ofstream(file) << text;
  INFO(file);
  CHECK((rigcal::test::text_of(file) == text));
}

}  // namespace

// RIGCAL_WRITE_SCHEMAS=1 build/release/tests/report_tests "schema: *" writes them anew.
TEST_CASE("schema: files in docs/schema are those of the types", "[report]") {
  // Where nothing was estimated there is no cost: zero would look like a perfect fit.
  check_schema<StoredFit>("result", {{"anyOf",
                                      {{{"properties", {{"starts", {{"minItems", 1}}}}}},
                                       {{"properties", {{"cost", {{"type", "null"}}}}}}}}});
  check_schema<StoredAverage>("average");
  check_schema<StoredBatch>("batch");
  check_schema<StoredComparison>("comparison");
  check_schema<StoredDiagnosis>("diagnosis");
  check_schema<StoredLeakTable>("leak_table");
  check_schema<StoredParity>("parity");
  check_schema<StoredPlan>("plan");
}
