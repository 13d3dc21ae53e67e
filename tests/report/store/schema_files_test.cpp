#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <string>

#include "common/compact_json.hpp"
#include "report/batch/batch.hpp"
#include "report/store/json.hpp"
#include "report/store/manifest.hpp"
#include "report/store/stored.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace rigcal::report;

namespace {

std::string schema_text(const std::string& file, const Json& rules) {
  Json schema = {
      {"$schema", "http://json-schema.org/draft-07/schema#"},
      {"title", file + " of rigcal"},
      {"description",
       "SI units unless a name says otherwise; a name ends in its unit. null where there "
       "is no number. Further keys may be added."}};
  schema.update(rules);
  return rigcal::compact_json(schema, "  ") + "\n";
}

void check_schema(const std::string& name, const Json& rules) {
  const std::string file = std::string(RIGCAL_SOURCE_DIR) + "/docs/schema/" + name + ".schema.json";
  const std::string text = schema_text(name + ".json", rules);
  if (std::getenv("RIGCAL_WRITE_SCHEMAS") != nullptr) std::ofstream(file) << text;
  INFO(file);
  CHECK((rigcal::test::text_of(file) == text));
}

template <typename T>
void check_schema(const std::string& name) {
  check_schema(name, schema_of<T>());
}

/// Returns the schema for a fit. A fit to published tables has a key that says so, and has no
/// records.
Json result_schema() {
  Json of_records = schema_of<StoredFit>();
  // A result without estimation has no cost, because zero would look like a perfect fit.
  of_records["anyOf"] = {{{"properties", {{"starts", {{"minItems", 1}}}}}},
                         {{"properties", {{"cost", {{"type", "null"}}}}}}};
  of_records["not"] = {{"required", Json::array({"of"})}};
  Json of_tables = schema_of<StoredTablesFit>();
  of_tables["properties"]["of"]["enum"] = Json::array({kOfTables});
  return {{"anyOf", Json::array({std::move(of_records), std::move(of_tables)})}};
}

}  // namespace

// To regenerate the files: RIGCAL_WRITE_SCHEMAS=1 build/release/tests/report_tests "schema: *"
TEST_CASE("schema: files in docs/schema are those of the types", "[report]") {
  check_schema("result", result_schema());
  check_schema<StoredAverage>("average");
  check_schema<StoredBatch>("batch");
  check_schema<StoredComparison>("comparison");
  check_schema<StoredDiagnosis>("diagnosis");
  check_schema<StoredLeakTable>("leak_table");
  check_schema<StoredManifest>("rigcal-manifest");
  check_schema<StoredParity>("parity");
  check_schema<StoredPlan>("plan");
}
