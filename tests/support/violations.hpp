#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

namespace rigcal::test {

/// A JSON schema, read once for many documents. The validator keeps the patterns that it has
/// compiled, which otherwise takes most of the time of a validation.
class Rules {
 public:
  explicit Rules(const nlohmann::json& rules) {
    valijson::SchemaParser().populateSchema(valijson::adapters::NlohmannJsonAdapter(rules),
                                            schema_);
  }

  /// Describes how a document violates the schema; empty if it conforms.
  std::string violations(const nlohmann::json& document) const {
    valijson::ValidationResults results;
    validator_.validate(schema_, valijson::adapters::NlohmannJsonAdapter(document), &results);
    std::string text;
    valijson::ValidationResults::Error error;
    while (results.popError(error)) {
      for (const std::string& part : error.context) text += part;
      text += ": " + error.description + "\n";
    }
    return text;
  }

 private:
  valijson::Schema schema_;
  mutable valijson::Validator validator_;
};

}  // namespace rigcal::test
