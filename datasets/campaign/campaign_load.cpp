#include <fmt/format.h>

#include <map>

#include "datasets/campaign/campaign.hpp"
#include "datasets/campaign/campaign_parameters.hpp"
#include "datasets/campaign/campaign_sections.hpp"
#include "datasets/campaign/leak_table_settings.hpp"
#include "datasets/campaign/reading_root.hpp"
#include "datasets/campaign/toml/toml_reader.hpp"

namespace rigcal::datasets {
namespace {

constexpr std::string_view kSchema = "rigcal.campaign/1";

void check_schema(const TomlNode& root) {
  const std::string expected = fmt::format("schema = \"{}\"", kSchema);
  const TomlNode schema = root.require("schema", expected);
  if (schema.string(expected) != kSchema) schema.fail_type(expected);
}

model::PlantKind read_plant(const TomlNode& rig) {
  std::vector<std::pair<std::string, model::PlantKind>> choices;
  for (const std::string& name : model::plant_names()) {
    choices.emplace_back(name, *model::plant_from_name(name));
  }
  return rig.require("model", "the plant, such as \"load_pressure\"").choice(choices);
}

model::Feedback read_feedback(const TomlNode& node) {
  std::vector<std::pair<std::string, model::Feedback>> choices;
  for (std::size_t i = 0; i < model::kFeedbackCount; ++i)
    choices.emplace_back(model::kFeedbacks[i].name, static_cast<model::Feedback>(i));
  return node.choice(choices);
}

void read_controller(const TomlNode& node, Campaign& campaign) {
  using Kind = model::ControllerKind;
  campaign.rig.controller = node.require("type", "\"pid\" or \"none\"")
                                .choice<Kind>({{"pid", Kind::pid}, {"none", Kind::none}});
  if (const auto feedback = node.find("feedback")) campaign.rig.feedback = read_feedback(*feedback);
  const auto settings =
      read_settings(node, campaign.rig.plant, ParameterGroup::controller, {"type", "feedback"});
  if (campaign.rig.controller == Kind::none && !settings.empty()) {
    const std::string key(spec_of(campaign.rig.plant, settings.front().index).key);
    node.require(key, "a gain").fail("is given, but type is \"none\": expected type = \"pid\"");
  }
  if (const auto feedback = node.find("feedback");
      feedback && campaign.rig.controller == Kind::none)
    feedback->fail("is given, but type is \"none\": expected type = \"pid\"");
  campaign.parameters.insert(campaign.parameters.end(), settings.begin(), settings.end());
}

void read_rig(const TomlNode& node, Campaign& campaign) {
  node.allow_only({"model", "parameters", "controller"});
  campaign.rig.plant = read_plant(node);
  campaign.rig.controller = model::ControllerKind::none;
  if (const auto parameters = node.find("parameters")) {
    campaign.parameters = read_settings(*parameters, campaign.rig.plant, ParameterGroup::rig);
  }
  const int pilot_gain = model::parameter_index(campaign.rig.plant, "pilot_gain");
  campaign.rig.pilot = pilot_gain >= 0 && campaign.setting(pilot_gain) != nullptr;
  if (const auto controller = node.find("controller")) read_controller(*controller, campaign);
}

void read_leak_levels(const TomlNode& node, Campaign& campaign) {
  for (const auto& [level, entry] : node.entries()) {
    entry.allow_only({"parameters"});
    if (level.empty()) entry.fail("a leak level needs a name: expected a text that is not empty");
    const auto values = entry.find("parameters");
    campaign.leak_levels[level] =
        values ? read_overrides(*values, campaign.rig.plant, ParameterGroup::rig) : Overrides{};
  }
}

std::string lower_case(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

void read_conditions(const TomlNode& node, Campaign& campaign) {
  if (!node.is_array()) node.fail_type("[[condition]], in double brackets");
  std::map<std::string, std::string> ids;
  for (const TomlNode& item : node.items()) {
    const Condition condition = read_condition(item, campaign);
    const auto [entry, is_new] = ids.emplace(lower_case(condition.id), condition.id);
    if (!is_new) {
      item.require("id", "a name")
          .fail(entry->second == condition.id
                    ? fmt::format("there is a condition \"{}\" already: expected an id of its own",
                                  condition.id)
                    : fmt::format("\"{}\" differs from \"{}\" by case only, and ids name files: "
                                  "expected another id",
                                  condition.id, entry->second));
    }
    campaign.conditions.push_back(condition);
  }
}

/// Sets duration and sample rate from [synthetic] in conditions that have neither these nor a
/// record.
void fill_times(Campaign& campaign) {
  if (!campaign.synthetic_settings) return;
  const SyntheticSettings& synthetic = *campaign.synthetic_settings;
  for (Condition& condition : campaign.conditions) {
    if (condition.has_record()) continue;
    if (!condition.duration_s && synthetic.duration_s > 0.0) {
      condition.duration_s = synthetic.duration_s;
    }
    if (!condition.sample_rate_hz && synthetic.sample_rate_hz > 0.0) {
      condition.sample_rate_hz = synthetic.sample_rate_hz;
    }
  }
}

/// Reads `synthetic`. The value `true` marks records as synthetic; a table [synthetic] describes
/// how to make them.
void read_synthetic_entry(const TomlNode& node, Campaign& campaign) {
  if (node.is_table()) {
    campaign.synthetic_settings = read_synthetic(node, campaign.rig.plant);
  } else {
    campaign.synthetic = node.boolean();
  }
}

void read_averaging(const TomlNode& node, Campaign& campaign) {
  node.allow_only({"align", "outliers"});
  if (const auto align = node.find("align")) {
    campaign.alignment =
        align->choice<Alignment>({{"correlate", Alignment::correlate}, {"none", Alignment::none}});
  }
  if (const auto outliers = node.find("outliers"))
    campaign.leave_out_outliers = outliers->choice<bool>({{"keep", false}, {"leave_out", true}});
}

}  // namespace

Campaign load_campaign(const std::filesystem::path& file, const std::filesystem::path& data_dir,
                       const std::filesystem::path& reading_root) {
  require_within(reading_root, file);
  if (!data_dir.empty()) require_within(reading_root, data_dir);
  const FileState file_state = state_of_file(file);
  const toml::table parsed = parse_toml_file(file);
  const TomlNode root(parsed, file.string(), "");
  check_schema(root);
  root.allow_only({"schema", "name", "synthetic", "rig", "leak_level", "recording", "averaging",
                   "acceptance", "fit", "considered", "between_days", "simulation", "leak_table",
                   "diagnosis", "report", "design", "condition"});
  Campaign campaign;
  campaign.file = file;
  campaign.file_state = file_state;
  campaign.data_dir = data_dir.empty() ? file.parent_path() : data_dir;
  campaign.root = reading_root;
  campaign.name = file.stem().string();
  if (const auto name = root.find("name")) campaign.name = name->name();
  read_rig(root.require("rig", "a table [rig] with model and parameters"), campaign);
  // The order matters: the later sections are checked against the earlier ones.
  if (const auto node = root.find("leak_level")) read_leak_levels(*node, campaign);
  if (const auto node = root.find("recording")) read_recording(*node, campaign);
  if (const auto node = root.find("averaging")) read_averaging(*node, campaign);
  if (const auto node = root.find("acceptance")) read_acceptance(*node, campaign);
  if (const auto node = root.find("fit")) campaign.fit = read_fit(*node, campaign);
  if (const auto node = root.find("considered"))
    campaign.considered = read_considered(*node, campaign);
  if (const auto node = root.find("between_days"))
    campaign.between_days = read_between_days(*node, campaign);
  if (const auto node = root.find("report")) campaign.report = read_report(*node);
  apply_sensors(root, campaign);
  if (const auto node = root.find("simulation")) campaign.simulation = read_simulation(*node);
  if (const auto node = root.find("diagnosis")) campaign.diagnosis = read_diagnosis(*node);
  if (const auto node = root.find("synthetic")) read_synthetic_entry(*node, campaign);
  if (const auto node = root.find("condition")) read_conditions(*node, campaign);
  if (const auto node = root.find("diagnosis")) check_duty(*node, campaign);
  if (const auto node = root.find("design")) campaign.design = read_design(*node, campaign);
  fill_times(campaign);
  // Only `leak-table` and `fit-tables` use this section, but loading a campaign must check it, too.
  if (const auto node = root.find("leak_table")) read_leak_table(*node, campaign);
  check_campaign(campaign, {file.string(), 1, 0});
  return campaign;
}

}  // namespace rigcal::datasets
