#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <string>

#include "report/batch/batch.hpp"
#include "report/store/json.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace rigcal::report;

namespace {

template <typename T>
std::string schema_text(const std::string& file) {
  Json schema = {
      {"$schema", "http://json-schema.org/draft-07/schema#"},
      {"title", file + " of rigcal"},
      {"description",
       "SI units unless a name says otherwise; a name ends in its unit. null where there "
       "is no number. Further keys may be added."}};
  schema.update(schema_of<T>());
  return json_text(schema);
}

}  // namespace

// RIGCAL_WRITE_SCHEMAS=1 build/release/tests/report_tests "schema: *" writes them anew.
TEST_CASE("schema: files in docs/schema are those of the types", "[report]") {
  const std::string file = std::string(RIGCAL_SOURCE_DIR) + "/docs/schema/batch.schema.json";
  const std::string text = schema_text<StoredBatch>("batch.json");
  if (std::getenv("RIGCAL_WRITE_SCHEMAS") != nullptr) std::ofstream(file) << text;
  CHECK(rigcal::test::text_of(file) == text);
}
