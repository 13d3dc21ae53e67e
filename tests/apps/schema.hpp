#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace rigcal::test {

/// What a document lacks by docs/schema/<schema>.schema.json, in words; empty if it is as that
/// says.
std::string violations(const nlohmann::json& document, const std::string& schema);

}  // namespace rigcal::test
