#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "datasets/campaign/keys/key_form.hpp"

namespace rigcal::datasets {

/// Name of the schema beside a campaign that `init` drafts.
inline constexpr const char* kSchemaFile = "campaign.schema.json";

/// The keys of a campaign file, from its first table down. The reader reads by them.
const std::vector<CampaignKey>& campaign_keys();

/// The keys of a table by its path, such as "fit" or "rig.parameters.mass"; for a list of tables,
/// those of one of them. Null if there is no such table.
const std::vector<CampaignKey>* find_campaign_table(std::string_view path);

/// A JSON schema (draft 2020-12) of a campaign file, for editors. What it refuses the reader
/// refuses, too; the reader refuses more.
std::string campaign_schema();

/// The keys of a table, as the documents have them: a table in Markdown.
std::string markdown_of(const std::vector<CampaignKey>& keys);

/// The line of a key in the draft of a campaign: its example with its hint as comment.
///
/// @throws std::invalid_argument  there is no such key, or it has no example
std::string draft_line(std::string_view table, std::string_view key);

}  // namespace rigcal::datasets
