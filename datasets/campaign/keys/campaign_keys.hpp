#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "datasets/campaign/keys/key_form.hpp"

namespace rigcal::datasets {

/// Name of the schema file that `init` writes next to a drafted campaign.
inline constexpr const char* kSchemaFile = "campaign.schema.json";

/// Returns the keys of a campaign file, starting at its root table. The reader uses the same rows.
const std::vector<CampaignKey>& campaign_keys();

/// Returns the keys of the table at a path, such as "fit" or "rig.parameters.mass"; for a list of
/// tables, the keys of one item. Null if there is no such table.
const std::vector<CampaignKey>* find_campaign_table(std::string_view path);

/// Returns a JSON schema (draft 2020-12) for campaign files, for use in editors. The reader refuses
/// everything that the schema refuses, and more.
std::string campaign_schema();

/// Formats the keys of a table as the Markdown table used in the documents.
std::string markdown_of(const std::vector<CampaignKey>& keys);

/// Returns the line for a key in a drafted campaign: the key's example, with its hint as a comment.
///
/// @throws std::invalid_argument  if there is no such key or it has no example
std::string draft_line(std::string_view table, std::string_view key);

}  // namespace rigcal::datasets
