#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace rigcal::test {

/// Describes, in words, how a document violates docs/schema/<schema>.schema.json. Empty if it
/// conforms.
std::string violations(const nlohmann::json& document, const std::string& schema);

}  // namespace rigcal::test
