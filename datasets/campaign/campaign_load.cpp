#include <fmt/format.h>

#include <map>

#include "datasets/campaign/campaign.hpp"
#include "datasets/campaign/campaign_parameters.hpp"
#include "datasets/campaign/campaign_sections.hpp"
#include "datasets/campaign/keys/campaign_keys.hpp"
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

Words<model::PlantKind> plant_words() {
  Words<model::PlantKind> words;
  for (const std::string& name : model::plant_names())
    words.emplace_back(name, *model::plant_from_name(name));
  return words;
}

Words<model::Feedback> feedback_words() {
  Words<model::Feedback> words;
  for (std::size_t i = 0; i < model::kFeedbackCount; ++i)
    words.emplace_back(model::kFeedbacks[i].name, static_cast<model::Feedback>(i));
  return words;
}

/// Keys of [rig.controller] that are not parameters.
const KeyTable<model::Rig>& controller_keys() {
  using Row = KeyRow<model::Rig>;
  using Kind = model::ControllerKind;
  static const KeyTable<model::Rig> keys({
      Row::word<Kind>("type", &model::Rig::controller, {{"pid", Kind::pid}, {"none", Kind::none}},
                      {.doc = "`\"pid\"`: the reference drives a closed loop; `\"none\"`: the "
                              "command drives the valve",
                       .needed = "\"pid\" or \"none\""}),
      Row::word<model::Feedback>(
          "feedback", &model::Rig::feedback, feedback_words(),
          {.doc = "The controlled quantity, which determines the gains and the channel of the "
                  "reference",
           .otherwise = "`\"position\"`; of a `\"linkage\"` `\"angle\"`"}),
  });
  return keys;
}

void read_controller(const TomlNode& node, Campaign& campaign) {
  using Kind = model::ControllerKind;
  controller_keys().read_rows(node, campaign.rig);
  const auto settings = read_settings(node, campaign.rig.plant, ParameterGroup::controller,
                                      controller_keys().names());
  if (campaign.rig.controller == Kind::none && !settings.empty()) {
    const std::string key(model::parameter_spec(campaign.rig.plant, settings.front().index).key);
    node.require(key, "a gain").fail("is given, but type is \"none\": expected type = \"pid\"");
  }
  const auto feedback = node.find("feedback");
  if (feedback && campaign.rig.controller == Kind::none)
    feedback->fail("is given, but type is \"none\": expected type = \"pid\"");
  const bool turns = campaign.rig.plant == model::PlantKind::linkage;
  if (!feedback && campaign.rig.controller == Kind::pid && turns)
    campaign.rig.feedback = model::Feedback::angle;
  if (feedback && !model::has_loop(campaign.rig.plant, campaign.rig.feedback))
    feedback->fail(turns
                       ? "the controller of a linkage controls the angle of the joint, its torque "
                         "or the pressure difference: expected \"angle\", \"torque\" or "
                         "\"load_pressure\""
                       : fmt::format("the plant {} has no joint: expected another quantity, or "
                                     "model = \"linkage\"",
                                     to_string(campaign.rig.plant)));
  campaign.parameters.insert(campaign.parameters.end(), settings.begin(), settings.end());
}

const KeyTable<model::Rig>& rig_keys() {
  using Row = KeyRow<model::Rig>;
  std::vector<CampaignKey> controller = controller_keys().keys();
  const auto gains = parameter_rows(ParameterGroup::controller, true);
  controller.insert(controller.end(), gains.begin(), gains.end());
  static const KeyTable<model::Rig> keys({
      Row::word<model::PlantKind>(
          "model", &model::Rig::plant, plant_words(),
          {.doc = "`\"load_pressure\"`; `\"two_chamber\"`: a cylinder with both chamber pressures; "
                  "`\"linkage\"`: such a cylinder moves an arm; quantities are angle and moment",
           .needed = "the plant, such as \"load_pressure\""}),
      Row::described(
          "parameters", table_form(parameter_rows(ParameterGroup::rig, true)),
          {.doc = "Every parameter but the controller's; `rigcal params` lists them with "
                  "units and limits",
           .otherwise = "none"}),
      Row::described("controller", table_form(std::move(controller)),
                     {.doc = "`type` and the controller's values", .otherwise = "no controller"}),
  });
  return keys;
}

void read_rig(const TomlNode& node, Campaign& campaign) {
  campaign.rig.controller = model::ControllerKind::none;
  rig_keys().read(node, campaign.rig);
  if (const auto parameters = node.find("parameters")) {
    campaign.parameters = read_settings(*parameters, campaign.rig.plant, ParameterGroup::rig);
  }
  const int pilot_gain = model::parameter_index(campaign.rig.plant, "pilot_gain");
  campaign.rig.pilot = pilot_gain >= 0 && campaign.setting(pilot_gain) != nullptr;
  if (const auto controller = node.find("controller")) read_controller(*controller, campaign);
}

const std::vector<CampaignKey>& level_rows() {
  static const std::vector<CampaignKey> keys{{"parameters",
                                              known_values_form(ParameterGroup::rig),
                                              "Known values of this level, over those of the rig",
                                              {},
                                              "none"}};
  return keys;
}

void read_leak_levels(const TomlNode& node, Campaign& campaign) {
  for (const auto& [level, entry] : node.entries()) {
    entry.allow_only(names_of(level_rows()));
    if (level.empty()) entry.fail("a leak level needs a name: expected text that is not empty");
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
                    ? fmt::format("there is already a condition \"{}\": expected another id",
                                  condition.id)
                    : fmt::format(
                          "\"{}\" differs from \"{}\" only in case, and files are named after ids: "
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

const KeyTable<Campaign>& averaging_keys() {
  using Row = KeyRow<Campaign>;
  static const KeyTable<Campaign> keys({
      Row::word<Alignment>("align", &Campaign::alignment,
                           {.doc = "`\"correlate\"` shifts each repeat to match the others, and "
                                   "reports the shifts; `\"none\"` makes no shifts",
                            .example = "\"correlate\"",
                            .hint = "or \"none\" if all repeats share one trigger"}),
      Row::word<bool>("outliers", &Campaign::leave_out_outliers,
                      {{"keep", false}, {"leave_out", true}},
                      {.doc = "Treatment of a repeat that is three times as far from the median of "
                              "all as is typical: kept in the mean, with a warning, or left out"}),
  });
  return keys;
}

/// Returns the keys of the root table with their readers. Their order matters, because later
/// sections are checked against earlier ones.
const KeyTable<Campaign>& root_keys() {
  using Row = KeyRow<Campaign>;
  const auto section = [](std::string_view key, KeyForm form, Row::Read read, std::string doc) {
    return Row::custom(key, std::move(form), std::move(read),
                       {.doc = std::move(doc), .otherwise = "none"});
  };
  KeyForm schema = word_form({std::string(kSchema)});
  const KeyForm synthetic = either_form(
      {plain_form(KeyForm::Kind::flag), table_form(synthetic_keys().keys())}, "boolean or table");
  static const KeyTable<Campaign> keys({
      Row::described("schema", std::move(schema),
                     {.doc = "Version of the keys of this file",
                      .needed = fmt::format("schema = \"{}\"", kSchema)}),
      Row::text("name", &Campaign::name, "text in quotes",
                {.doc = "Title of reports", .otherwise = "name of the file"}),
      Row::custom("rig", table_form(rig_keys().keys()), read_rig,
                  {.doc = "The rig: its model, parameters and controller",
                   .needed = "a table [rig] with model and parameters"}),
      section("leak_level", entries_form(table_form(level_rows())), read_leak_levels,
              "Known values by leak level"),
      section("recording", table_form(recording_keys().keys()), read_recording,
              "The columns of the recordings, and how they were recorded"),
      section(
          "averaging", table_form(averaging_keys().keys()),
          [](const TomlNode& node, Campaign& campaign) { averaging_keys().read(node, campaign); },
          "How repeats are averaged"),
      section("acceptance", table_form(acceptance_keys()), read_acceptance, "What PASS means"),
      section(
          "fit", table_form(fit_keys().keys()),
          [](const TomlNode& node, Campaign& campaign) { campaign.fit = read_fit(node, campaign); },
          "How `rigcal fit` estimates"),
      section(
          "considered", considered_form(),
          [](const TomlNode& node, Campaign& campaign) {
            campaign.considered = read_considered(node, campaign);
          },
          "Small effects that the model leaves out: their sizes, or `false`"),
      section(
          "between_days", between_days_form(),
          [](const TomlNode& node, Campaign& campaign) {
            campaign.between_days = read_between_days(node, campaign);
          },
          "Day-to-day variation of the rig, or `false`"),
      section(
          "report", table_form(report_keys()),
          [](const TomlNode& node, Campaign& campaign) { campaign.report = read_report(node); },
          "Details of the test report"),
      section(
          "simulation", table_form(simulation_keys().keys()),
          [](const TomlNode& node, Campaign& campaign) {
            campaign.simulation = read_simulation(node);
          },
          "How the model is simulated"),
      section(
          "diagnosis", table_form(diagnosis_keys().keys()),
          [](const TomlNode& node, Campaign& campaign) {
            campaign.diagnosis = read_diagnosis(node);
          },
          "How `rigcal diagnose` classifies"),
      Row::custom("synthetic", synthetic, read_synthetic_entry,
                  {.doc = "`true`: the records were made by `rigcal synthesize`. As a table "
                          "`[synthetic]` it states how to make them",
                   .otherwise = "`false`"}),
      section("condition", list_form(table_form(condition_keys().keys()), "tables", 0),
              read_conditions,
              "The recordings: one table `[[condition]]` per signal and leak level"),
      section(
          "design", table_form(design_keys().keys()),
          [](const TomlNode& node, Campaign& campaign) {
            campaign.design = read_design(node, campaign);
          },
          "The test that `rigcal plan --design` looks for"),
      // Only a few verbs use this section, but a check of the campaign must cover it.
      section(
          "leak_table", table_form(leak_table_keys()),
          [](const TomlNode& node, Campaign& campaign) { read_leak_table(node, campaign); },
          "Settings and published values for `rigcal leak-table` and `rigcal fit-tables`"),
  });
  return keys;
}

}  // namespace

const std::vector<CampaignKey>& campaign_keys() { return root_keys().keys(); }

Campaign load_campaign(const std::filesystem::path& file, const std::filesystem::path& data_dir,
                       const std::filesystem::path& reading_root) {
  require_within(reading_root, file);
  if (!data_dir.empty()) require_within(reading_root, data_dir);
  const FileState file_state = state_of_file(file);
  const toml::table parsed = parse_toml_file(file);
  const TomlNode root(parsed, file.string(), "");
  check_schema(root);
  Campaign campaign;
  campaign.file = file;
  campaign.file_state = file_state;
  campaign.data_dir = data_dir.empty() ? file.parent_path() : data_dir;
  campaign.root = reading_root;
  campaign.name = file.stem().string();
  root_keys().read(root, campaign);
  apply_sensors(root, campaign);
  if (const auto node = root.find("diagnosis")) check_duty(*node, campaign);
  fill_times(campaign);
  check_campaign(campaign, {file.string(), 1, 0});
  return campaign;
}

}  // namespace rigcal::datasets
