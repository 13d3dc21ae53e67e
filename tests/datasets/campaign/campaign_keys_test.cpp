#include "datasets/campaign/keys/campaign_keys.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "datasets/campaign/toml/toml_reader.hpp"
#include "model/plant/parameter.hpp"
#include "tests/datasets/campaign_fixture.hpp"
#include "tests/support/violations.hpp"

using namespace rigcal;
using namespace rigcal::datasets;
using nlohmann::json;
using rigcal::test::load_text;
using rigcal::test::Rules;

namespace {

namespace fs = std::filesystem;
using FormKind = KeyForm::Kind;

const Rules& rules() {
  static const Rules schema(json::parse(campaign_schema()));
  return schema;
}

/// A TOML table as an editor validates it, with dates as texts.
json as_json(const toml::table& table) {
  std::ostringstream text;
  text << toml::json_formatter{table};
  return json::parse(text.str());
}

/// A value as TOML in one line. Texts that look like dates are written as dates.
std::string as_toml(const json& value) {
  if (value.is_object()) {
    std::string text;
    for (const auto& [key, each] : value.items())
      text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", toml_key(key), as_toml(each));
    return "{ " + text + " }";
  }
  if (value.is_array()) {
    std::string text;
    for (const json& each : value) text += (text.empty() ? "" : ", ") + as_toml(each);
    return "[" + text + "]";
  }
  if (value.is_number_float()) return toml_number(value.get<double>());
  if (!value.is_string()) return value.dump();
  const auto text = value.get<std::string>();
  return text == "2026-03-01" ? text : toml_quoted(text);
}

/// A small campaign that the reader and the schema accept.
json small_campaign() {
  return json::parse(R"({
    "schema": "rigcal.campaign/1",
    "rig": {
      "model": "load_pressure",
      "parameters": {
        "supply_pressure": "6.2 MPa", "damping": "1000 N s/m", "mass": {"start": "60 kg"},
        "leakage_coefficient": 0.3, "stiffness": "0 N/m", "piston_area": "633 mm2",
        "total_volume": "468 cm3", "density": "850 kg/m3", "bulk_modulus": "689 MPa",
        "discharge_coefficient": 0.6, "area_gradient": "25 mm", "valve_gain": "0.0254 mm/V",
        "leakage_area": "3 mm2"},
      "controller": {"type": "pid", "kp": "78.74 V/m"}},
    "recording": {"channels": {
      "time": {"column": "t", "unit": "s"},
      "reference": {"column": "r", "unit": "mm"},
      "position": {"column": "x", "unit": "mm"}}},
    "condition": [{"id": "sine", "waveform": "sine", "frequency": "1 Hz", "amplitude": "5 mm",
                   "repeats": ["a.csv"]}]
  })");
}

/// For a key, the other keys that a campaign then needs, as a merge patch (RFC 7396). In
/// `condition`, `report.sensor`, `leak_table.signal` and `leak_table.features.row`, it applies to
/// one table.
const std::map<std::string, json>& companions() {
  static const std::map<std::string, json> patches = [] {
    const json chirp = {{"condition", {{"waveform", "chirp"}, {"end_frequency", "2 Hz"}}}};
    const json averaged = {{"condition", {{"repeats", nullptr}, {"averaged", "a.csv"}}}};
    const json planned = {
        {"condition", {{"repeats", nullptr}, {"duration", "1 s"}, {"sample_rate", "1 kHz"}}}};
    const json repeat = {
        {"condition", {{"repeats", json::array({{{"file", "a_{n}.csv"}, {"n", "1..2"}}})}}}};
    const auto leak_table = [](json section) { return json{{"leak_table", std::move(section)}}; };
    const json fitted = {
        {"fit", true}, {"start", "60 kg"}, {"lower", "10 kg"}, {"upper", "500 kg"}};
    const json signal = {{"targets", json::array({50})},
                         {"signal", {{"printed", json::array({"0.25"})}}}};
    std::map<std::string, json> all{
        {"recording.initial_window", {{"recording", {{"initial", "record"}}}}},
        {"recording.holes", {{"recording", {{"longest_hole", nullptr}}}}},
        {"recording.longest_hole", {{"recording", {{"holes", "bridge"}}}}},
        {"report.revision", {{"report", {{"number", "17"}}}}},
        {"report.replaces", {{"report", {{"number", "17"}}}}},
        {"report.approver_function", {{"report", {{"approver", "A. Head"}}}}},
        {"condition.sweep", chirp},
        {"condition.end_frequency", chirp},
        {"condition.sweep_time", chirp},
        {"condition.averaged", averaged},
        {"condition.repeats_averaged", averaged},
        {"condition.planned_repeats", planned},
        {"condition.repeats.n", repeat},
        {"condition.repeats.columns", repeat},
        {"rig.parameters.mass.prior",
         {{"rig", {{"parameters", {{"mass", {{"prior_sd", "6 kg"}}}}}}}}},
        {"rig.parameters.mass.prior_sd",
         {{"rig", {{"parameters", {{"mass", {{"prior", "60 kg"}}}}}}}}},
        {"leak_table.signal.printed", leak_table(signal)},
        {"leak_table.signal.notes", leak_table(signal)},
        {"leak_table.features.row.left_out",
         leak_table({{"features", {{"row", {{"reason", "a misprint"}, {"std", 1.0}}}}}})},
        {"leak_table.features.row.reason",
         leak_table({{"features", {{"row", {{"left_out", json::array({"std"})}}}}}})},
    };
    for (const char* key : {"fit", "start", "lower", "upper"})
      all[fmt::format("leak_table.assumptions.mass.{}", key)] =
          leak_table({{"assumptions", {{"mass", fitted}}}});
    return all;
  }();
  return patches;
}

/// Returns a valid value for a form.
json example_of(const KeyForm& form) {
  switch (form.kind) {
    case FormKind::quantity:
      return "1 " + (form.units.empty() ? std::string("mm") : form.units[0]);
    case FormKind::number:
      return std::clamp(0.5, form.lower, form.upper);
    case FormKind::whole:
      return static_cast<long>(form.lower);
    case FormKind::flag:
      return false;
    case FormKind::text:
      return "text";
    case FormKind::date:
      return "2026-03-01";
    case FormKind::word:
      return form.words.at(0);
    case FormKind::list: {
      json list = json::array();
      for (std::size_t i = 0; i < std::max<std::size_t>(form.least, 1); ++i)
        list.push_back(example_of(form.forms.at(0)));
      return list;
    }
    case FormKind::entries:
      return {{"a name", example_of(form.forms.at(0))}};
    case FormKind::either:
      return example_of(form.forms.at(0));
    case FormKind::table:
      break;
  }
  json table = json::object();
  for (const CampaignKey& row : form.keys)
    if (row.needed)
      table[row.key] = row.example.empty() ? example_of(row.form) : json::parse(row.example);
  return table;
}

json example_of(const CampaignKey& row) {
  const std::string& known = row.example.empty() ? row.standard : row.example;
  if (known.empty()) return example_of(row.form);
  return as_json(toml::parse("x = " + known)).at("x");
}

/// A key, and where it is in the campaign.
struct Place {
  std::string path;  ///< "recording.initial"
  const CampaignKey* row;
  std::vector<std::string> tables;  ///< "recording"
};

/// Whether the test visits a key. Of the tables whose keys are channels or parameters, it visits
/// only a few representative keys.
bool is_walked(const Place& place) {
  static const std::set<std::string> kOne{"mass", "type",      "feedback",
                                          "time", "reference", "position"};
  static const std::set<std::string> kMany{"rig.parameters", "rig.controller", "recording.channels",
                                           "leak_table.assumptions"};
  static const std::set<std::string> kNone{"considered",           "between_days",
                                           "leak_level",           "condition.parameters",
                                           "condition.controller", "acceptance.negligible",
                                           "condition.acceptance", "synthetic.parameters",
                                           "synthetic.leak_level", "synthetic.noise",
                                           "synthetic.ar1_noise",  "synthetic.quantisation",
                                           "synthetic.drift",      "synthetic.variation",
                                           "design.noise",         "condition.repeats.columns"};
  std::string parent;
  for (const std::string& part : place.tables) {
    parent += (parent.empty() ? "" : ".") + part;
    if (kNone.contains(parent)) return false;
  }
  if (parent == "acceptance" && channel_from_key(place.row->key))
    return place.row->key == "position";
  return !kMany.contains(parent) || kOne.contains(place.row->key);
}

const std::vector<CampaignKey>* table_of(const std::string& path) {
  return path.empty() ? &campaign_keys() : find_campaign_table(path);
}

void walk(const std::string& path, const std::vector<std::string>& tables,
          std::vector<Place>& places) {
  const auto* keys = table_of(path);
  if (keys == nullptr) return;
  for (const CampaignKey& row : *keys) {
    const std::string name = path.empty() ? row.key : path + "." + row.key;
    const Place place{name, &row, tables};
    if (!is_walked(place)) continue;
    places.push_back(place);
    std::vector<std::string> deeper = tables;
    deeper.push_back(row.key);
    walk(name, deeper, places);
  }
}

const std::vector<Place>& key_places() {
  static const std::vector<Place> all = [] {
    std::vector<Place> found;
    walk("", {}, found);
    return found;
  }();
  return all;
}

/// Returns the table of a key, the first one if there is a list of tables. Creates missing tables.
json& table_in(json& campaign, const std::vector<std::string>& tables) {
  json* table = &campaign;
  std::string path;
  for (const std::string& part : tables) {
    path += (path.empty() ? "" : ".") + part;
    json& next = (*table)[part];
    static const std::set<std::string> kLists{"condition", "report.sensor", "leak_table.signal",
                                              "leak_table.features.row", "condition.repeats"};
    if (kLists.contains(path)) {
      if (!next.is_array() || next.empty()) next = json::array({json::object()});
      if (!next[0].is_object()) next[0] = {{"file", "a.csv"}};
      table = &next[0];
    } else {
      if (!next.is_object()) next = json::object();
      table = &next;
    }
    // A new table gets the keys that it needs.
    if (const auto* keys = find_campaign_table(path); keys != nullptr && path != "rig") {
      for (const CampaignKey& row : *keys)
        if (row.needed && !table->contains(row.key)) (*table)[row.key] = example_of(row);
    }
  }
  return *table;
}

/// Applies a patch. Objects in it apply to the first table if the campaign has a list of tables.
void patch(json& value, const json& change) {
  for (const auto& [key, each] : change.items()) {
    if (each.is_null()) {
      value.erase(key);
    } else if (each.is_object()) {
      json& next = value[key];
      patch(next.is_array() ? next.at(0) : next, each);
    } else {
      value[key] = each;
    }
  }
}

/// Returns a campaign with this key.
json with_key(const Place& place, const std::string& key, const json& value) {
  json campaign = small_campaign();
  table_in(campaign, place.tables);
  const auto companion = companions().find(place.path);
  if (companion != companions().end()) patch(campaign, companion->second);
  table_in(campaign, place.tables)[key] = value;
  return campaign;
}

/// Returns the reader's error message for a campaign; empty if it is accepted.
std::string refusal_of(const json& campaign) {
  std::string text;
  for (const auto& [key, value] : campaign.items())
    text += fmt::format("{} = {}\n", toml_key(key), as_toml(value));
  try {
    load_text(text);
    return {};
  } catch (const InputError& error) {
    return error.what();
  }
}

json value_at(const Place& place) {
  const std::string& key = place.row->key;
  const bool assumption = place.path.starts_with("leak_table.assumptions.mass.");
  if (assumption || place.path.starts_with("rig.parameters.mass.")) {
    if (place.row->form.kind == FormKind::quantity)
      return key == "lower" ? "10 kg" : key == "upper" ? "500 kg" : "60 kg";
    if (assumption && key == "fit") return true;
  }
  if (place.path == "recording.channels.position.role") return "output";
  return example_of(*place.row);
}

}  // namespace

// To update the file: RIGCAL_WRITE_SCHEMAS=1 build/release/tests/datasets_tests "campaign schema:
// *"
TEST_CASE("campaign schema: the file in docs/schema is that of the rows", "[datasets]") {
  const std::string file = std::string(RIGCAL_SOURCE_DIR) + "/docs/schema/campaign.schema.json";
  if (std::getenv("RIGCAL_WRITE_SCHEMAS") != nullptr) std::ofstream(file) << campaign_schema();
  INFO(file);
  CHECK((test::text_of(file) == campaign_schema()));
}

TEST_CASE("campaign schema: every campaign of the project is as it says", "[datasets]") {
  int campaigns = 0;
  for (const char* folder : {"datasets/rigs", "docs/tutorial", "docs/extending/dat", "tests"}) {
    for (const fs::directory_entry& entry :
         fs::recursive_directory_iterator(fs::path(RIGCAL_SOURCE_DIR) / folder)) {
      if (entry.path().extension() != ".toml") continue;
      INFO(entry.path().string());
      CHECK(rules().violations(as_json(toml::parse_file(entry.path().string()))) == "");
      ++campaigns;
    }
  }
  CHECK(campaigns >= 26);
  CHECK(rules().violations(as_json(toml::parse(test::kExample))) == "");
  CHECK(rules().violations(small_campaign()) == "");
}

TEST_CASE("campaign keys: reader and schema accept each", "[datasets]") {
  REQUIRE(refusal_of(small_campaign()) == "");
  CHECK(key_places().size() > 200);
  for (const Place& place : key_places()) {
    const json campaign = with_key(place, place.row->key, value_at(place));
    CAPTURE(place.path, campaign.dump());
    CHECK_FALSE(place.row->doc.empty());
    // Tables are covered by the campaigns for their keys. A position cannot be a drive.
    if (find_campaign_table(place.path) != nullptr) continue;
    if (place.path == "recording.channels.position.recognise") continue;
    // Only a command has a full scale (tests/datasets/campaign/metering_campaign_test.cpp).
    if (place.row->key == "full_scale") continue;
    CHECK(refusal_of(campaign) == "");
    CHECK(rules().violations(campaign) == "");
  }
}

TEST_CASE("campaign keys: a letter that is wrong is refused by both, with the right one",
          "[datasets]") {
  for (const Place& place : key_places()) {
    std::string wrong = place.row->key;
    wrong.back() = wrong.back() == 'q' ? 'x' : 'q';
    json campaign = with_key(place, wrong, value_at(place));
    CAPTURE(place.path, wrong);
    CHECK_FALSE(rules().violations(campaign).empty());
    if (place.row->needed) table_in(campaign, place.tables)[place.row->key] = value_at(place);
    const std::string message = refusal_of(campaign);
    CHECK_THAT(message, Catch::Contains("unknown ") && Catch::Contains("'" + wrong + "'"));
    if (wrong.size() > 2) CHECK_THAT(message, Catch::Contains("did you mean '"));
  }
}

TEST_CASE("campaign keys: one that is needed and missing is refused by both", "[datasets]") {
  int needed = 0;
  for (const Place& place : key_places()) {
    if (!place.row->needed) continue;
    json campaign = with_key(place, place.row->key, value_at(place));
    table_in(campaign, place.tables).erase(place.row->key);
    CAPTURE(place.path);
    CHECK_THAT(refusal_of(campaign), Catch::Contains(place.row->key + "' is missing: expected "));
    CHECK_FALSE(rules().violations(campaign).empty());
    ++needed;
  }
  CHECK(needed > 20);
}

TEST_CASE("campaign keys: a unit of another dimension is refused by both", "[datasets]") {
  int quantities = 0;
  for (const Place& place : key_places()) {
    const KeyForm& form = place.row->form;
    if (form.kind != FormKind::quantity || form.units.empty()) continue;
    const bool mass = std::find(form.units.begin(), form.units.end(), "kg") != form.units.end();
    for (const char* wrong : {mass ? "1 s" : "1 kg", mass ? "60.5mm" : "-2.5e-3kg", "1", "kN"}) {
      const json campaign = with_key(place, place.row->key, wrong);
      CAPTURE(place.path, wrong);
      CHECK_FALSE(refusal_of(campaign).empty());
      CHECK_FALSE(rules().violations(campaign).empty());
    }
    ++quantities;
  }
  CHECK(quantities > 40);
}

TEST_CASE("campaign keys: a number beyond its limits is refused by both", "[datasets]") {
  int numbers = 0;
  for (const Place& place : key_places()) {
    const KeyForm& form = place.row->form;
    if (form.kind != FormKind::number && form.kind != FormKind::whole) continue;
    for (const bool below : {true, false}) {
      const double limit = below ? form.lower : form.upper;
      if (!std::isfinite(limit)) continue;
      const bool open = below ? form.above_lower : form.below_upper;
      const double beyond = open ? limit : limit + (below ? -1.0 : 1.0);
      const json value = form.kind == FormKind::whole ? json(std::llround(beyond)) : json(beyond);
      const json campaign = with_key(place, place.row->key, value);
      CAPTURE(place.path, value.dump());
      CHECK_FALSE(refusal_of(campaign).empty());
      CHECK_FALSE(rules().violations(campaign).empty());
      ++numbers;
    }
  }
  CHECK(numbers > 40);
}

TEST_CASE("campaign keys: a word that is none is refused by both, with the words", "[datasets]") {
  int words = 0;
  for (const Place& place : key_places()) {
    const KeyForm& form = place.row->form;
    if (form.kind != FormKind::word || place.path == "schema") continue;
    const json campaign = with_key(place, place.row->key, form.words.at(0) + "q");
    CAPTURE(place.path);
    CHECK_FALSE(rules().violations(campaign).empty());
    const std::string message = refusal_of(campaign);
    CHECK_THAT(message, Catch::Contains("unknown value"));
    ++words;
  }
  CHECK(words > 20);
}

TEST_CASE("campaign keys: the parameters of every plant", "[datasets]") {
  const auto* rig = find_campaign_table("rig.parameters");
  const auto* controller = find_campaign_table("rig.controller");
  REQUIRE(rig != nullptr);
  REQUIRE(controller != nullptr);
  std::set<std::string> known;
  for (const std::string& plant : model::plant_names()) {
    for (const model::ParameterSpec& spec :
         model::parameter_table(model::plant_from_name(plant).value())) {
      const bool gain = spec.kind == model::ParameterKind::controller;
      const CampaignKey* row = find_key(gain ? *controller : *rig, spec.key);
      CAPTURE(plant, spec.key);
      REQUIRE(row != nullptr);
      known.insert(row->key);
      const KeyForm& value = row->form.forms.at(0);
      if (spec.unit == "1") {
        CHECK(value.kind == FormKind::number);
        CHECK((value.lower <= spec.lower && value.upper >= spec.upper));
      } else {
        CHECK(std::find(value.units.begin(), value.units.end(), spec.unit) != value.units.end());
      }
    }
  }
  CHECK(known.size() == rig->size() + controller->size() - 2);  // `type`, `feedback`
}

TEST_CASE("campaign schema: what the writer writes is as it says", "[datasets]") {
  const test::TemporaryFolder folder;
  const Campaign campaign = load_campaign(folder.write("campaign.toml", test::kExample));
  const auto index = [&](const char* key) {
    return model::parameter_index(campaign.rig.plant, key);
  };
  const std::string fitted =
      fitted_campaign_text(campaign,
                           {{index("mass"), Scope::rig, "", 61.5},
                            {index("leakage_coefficient"), Scope::leak_level, "none", 0.25},
                            {index("position_offset"), Scope::condition, "steps", 1e-3}},
                           {});
  CHECK_THAT(fitted, Catch::Contains("mass = \"61.5 kg\""));
  CHECK(rules().violations(as_json(toml::parse(fitted))) == "");

  DesignSettings design;
  design.duration_s = 10.0;
  design.sample_rate_hz = 1000.0;
  const std::string designed =
      designed_campaign_text(campaign, design, DriveFamily::chirp, {{Channel::position, 5e-5}});
  CHECK_THAT(designed, Catch::Contains("id = \"design_chirp\""));
  CHECK(rules().violations(as_json(toml::parse(designed))) == "");
}

TEST_CASE("campaign keys: tables as the documents have them", "[datasets]") {
  const auto* fit = find_campaign_table("fit");
  REQUIRE(fit != nullptr);
  const std::string text = markdown_of(*fit);
  CHECK_THAT(text, Catch::StartsWith("| key | type | default | meaning |\n"));
  CHECK_THAT(text, Catch::Contains("| `loss` | `\"squared\"`, `\"huber\"`, `\"cauchy\"`, "
                                   "`\"soft_l1\"` | `\"squared\"` | "));
  CHECK_THAT(text, Catch::Contains("| `loss_scale` | number | `3` | "));
  CHECK_THAT(text, Catch::Contains("| `max_time` | time | none | "));
  CHECK_THAT(text, Catch::Contains("| `starts` | whole number, 1 to 100000 | `1` | "));
  CHECK_THAT(
      markdown_of(*find_campaign_table("acceptance")),
      Catch::Contains("| `r` | number, -1 to 1 | ") && Catch::Contains("100 mean \\|e\\| / (max"));
  CHECK_THAT(markdown_of(*find_campaign_table("diagnosis")),
             Catch::Contains("| `detection` | number, above 0 to below 1 | `0.95` |") &&
                 Catch::Contains("| `leak_law` | `\"orifice\"`, `\"laminar\"` | `\"orifice\"` |"));
  CHECK_THAT(text, Catch::Contains("| `outputs` | list of channels | all outputs | "));
  CHECK(find_campaign_table("fit.loss") == nullptr);
  CHECK(find_campaign_table("fits") == nullptr);
  CHECK(find_campaign_table("rig.parameters.mass") != nullptr);
  CHECK(draft_line("recording", "decimate_to") ==
        "decimate_to = \"1 kHz\"  # if the sampling rate is higher than the model needs\n");
  CHECK_THROWS_AS(draft_line("recording", "nothing"), std::invalid_argument);
}
