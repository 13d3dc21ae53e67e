#include "datasets/campaign/leak_table_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "common/quantity.hpp"
#include "common/suggest.hpp"
#include "datasets/campaign/campaign_parameters.hpp"
#include "datasets/campaign/keys/key_table.hpp"

namespace rigcal::datasets {
namespace {

constexpr std::string_view kResidualScaleKey = "residual_scale";
constexpr double kMostPercent = 1000.0;
/// The parameter that a leak table varies.
constexpr std::string_view kVariedKey = "leakage_coefficient";

bool is_flow(Feature feature) {
  return feature == Feature::servo_flow || feature == Feature::leak_flow;
}

std::string_view amplitude_unit(const Campaign& campaign) {
  return info(drive_channel(campaign)).unit;
}

bool same_drive(const LeakSignal& a, const LeakSignal& b) {
  return a.waveform == b.waveform && a.frequency_hz == b.frequency_hz && a.amplitude == b.amplitude;
}

/// Reads a printed number such as "0.25". Its number of digits determines the rounding error.
PrintedCoefficient read_printed(const TomlNode& node) {
  constexpr const char* kExpected = "a number above zero as it was printed, in quotes: \"0.25\"";
  const std::string text = node.string(kExpected);
  PrintedCoefficient printed;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), printed.value,
                                             std::chars_format::fixed);
  if (error != std::errc{} || rest != text.data() + text.size() || !(printed.value > 0.0)) {
    node.fail_type(kExpected);
  }
  const std::size_t point = text.find('.');
  const std::size_t decimals = point == std::string::npos ? 0 : text.size() - point - 1;
  printed.half_digit = 0.5 * std::pow(10.0, -static_cast<double>(decimals));
  return printed;
}

double read_target(const TomlNode& node) {
  const double target = node.number();
  if (!(target > 0.0 && target <= kMostPercent)) {
    node.fail_type("a share of the servo flow in percent, above zero");
  }
  return target;
}

std::vector<double> read_targets(const TomlNode& node) {
  std::vector<double> targets;
  for (const TomlNode& item : node.items()) {
    targets.push_back(read_target(item));
    if (targets.size() > 1 && !(targets.back() > targets[targets.size() - 2])) {
      item.fail_type("targets in increasing order, each once");
    }
  }
  if (targets.empty()) node.fail("is empty: expected shares in percent such as [10, 20]");
  return targets;
}

void read_drive(const TomlNode& node, const Campaign& campaign, LeakSignal& signal) {
  signal.waveform =
      node.require("waveform", "\"sine\" or \"square\"").choice<Waveform>(periodic_waveforms());
  signal.frequency_hz =
      node.require("frequency", "such as \"0.1 Hz\"").quantity("Hz", kFrequencies_hz);
  signal.amplitude = node.require("amplitude", "half of peak to peak")
                         .quantity(amplitude_unit(campaign), kAmplitudes);
}

std::vector<CampaignKey> drive_keys() {
  using Row = KeyRow<LeakSignal>;
  const std::vector<Row> rows{
      Row::described("waveform", word_form(words_of(periodic_waveforms())),
                     {.doc = "Signal of the drive", .needed = "\"sine\" or \"square\""}),
      Row::described("frequency", quantity_form("Hz"),
                     {.doc = "Frequency of the drive", .needed = "such as \"0.1 Hz\""}),
      Row::described(
          "amplitude", quantity_form(std::vector<std::string>{"m", "V"}),
          {.doc = "Half of peak to peak", .example = "\"5 mm\"", .needed = "half of peak to peak"}),
  };
  return KeyTable<LeakSignal>(rows).keys();
}

const std::vector<CampaignKey>& signal_keys() {
  static const std::vector<CampaignKey> keys = [] {
    std::vector<CampaignKey> rows = drive_keys();
    const KeyForm text = plain_form(KeyForm::Kind::text);
    rows.push_back({"printed",
                    list_form(text, "list of texts"),
                    "A published coefficient per target, in quotes and with the digits as printed: "
                    "`\"0.50\"` is more precise than `\"0.5\"`",
                    {},
                    "none",
                    false,
                    "[\"0.25\"]"});
    rows.push_back({"normal",
                    text,
                    "The published coefficient of the rig without a fault",
                    {},
                    "none",
                    false,
                    "\"0.002\""});
    rows.push_back({"notes",
                    entries_form(text),
                    "What is known about an entry, by its target: `{ \"50\" = \"a misprint\" }`",
                    {},
                    "none",
                    false,
                    "{ \"50\" = \"a misprint\" }"});
    return rows;
  }();
  return keys;
}

/// Keys of a row of [leak_table.features].
const KeyTable<PrintedFeatures>& level_keys() {
  using Row = KeyRow<PrintedFeatures>;
  static const KeyTable<PrintedFeatures> keys = [] {
    std::vector<Row> rows{
        Row::text(
            "level", &PrintedFeatures::level, "text in quotes",
            {.doc = "Name of the level", .example = "\"10 %\"", .needed = "the name of the level"}),
        Row::number("coefficient", &PrintedFeatures::coefficient, kSizes,
                    {.doc = "Leakage coefficient at which the row was published",
                     .needed = "the leakage coefficient of the level"}),
        Row::flag("leaking", &PrintedFeatures::leaking,
                  {.doc = "`false`: the rig without a fault; the coefficient that gives its leak "
                          "flow is computed too"}),
    };
    for (const Feature feature : enumerators_like(Feature{})) {
      const bool flow = is_flow(feature);
      rows.push_back(
          Row::custom(to_string(feature), flow ? quantity_form("m3/s") : number_form(kSizes),
                      [feature, flow](const TomlNode& node, PrintedFeatures& row) {
                        row.printed[feature] =
                            flow ? node.quantity("m3/s", kFlows_m3_per_s) : node.number(kSizes);
                      },
                      {.doc = flow ? "Mean of the absolute value"
                                   : "Of the residual's absolute value, as printed",
                       .otherwise = "none"}));
    }
    rows.push_back(Row::described(
        "left_out",
        list_form(word_form(words_of(enumerator_words<Feature>())), "list of these names", 0),
        {.doc = "Values that `fit-tables` does not use; needs a `reason`", .otherwise = "none"}));
    rows.push_back(Row::described("reason", plain_form(KeyForm::Kind::text),
                                  {.doc = "Why it is left out", .otherwise = "none"}));
    return KeyTable<PrintedFeatures>(std::move(rows));
  }();
  return keys;
}

std::vector<CampaignKey> feature_keys() {
  std::vector<CampaignKey> keys = drive_keys();
  keys.push_back({"row",
                  list_form(table_form(level_keys().keys()), "tables", 0),
                  "A published row, each a table `[[leak_table.features.row]]`",
                  {},
                  {},
                  true});
  return keys;
}

/// @param value  form of the assumed value
KeyTable<Assumption> assumption_keys(const KeyForm& value) {
  using Row = KeyRow<Assumption>;
  KeyForm quantity = value;
  quantity.name = "quantity";
  const std::string with_fit = "needed with `fit = true`";
  return KeyTable<Assumption>({
      Row::described("value", quantity, {.doc = "The assumed value", .needed = "a value"}),
      Row::text("source", &Assumption::source, "text in quotes",
                {.doc = "Source of the value, as stated in the results",
                 .needed = "where the value comes from"}),
      Row::flag("fit", &Assumption::fit, {.doc = "Whether `fit-tables` estimates it"}),
      Row::described("start", quantity,
                     {.doc = "Where `fit-tables` starts", .otherwise = with_fit}),
      Row::described("lower", quantity,
                     {.doc = "Lower bound. If above zero, the logarithm of the value is estimated, "
                             "otherwise the value itself",
                      .otherwise = with_fit}),
      Row::described("upper", quantity, {.doc = "Upper bound", .otherwise = with_fit}),
  });
}

KeyForm assumptions_form() {
  std::vector<CampaignKey> rows = parameter_rows(ParameterGroup::any, false);
  const model::ParameterSpec& scale = assumption_spec({}, kResidualScale);
  rows.push_back({std::string(scale.key), quantity_form(scale.unit), std::string(scale.meaning)});
  std::erase_if(rows, [](const CampaignKey& row) { return row.key == kVariedKey; });
  for (CampaignKey& row : rows) {
    KeyForm value = plain_form(row.form.kind);
    value.units = row.form.units;
    row.form = table_form(assumption_keys(value).keys());
  }
  return table_form(std::move(rows));
}

LeakSignal read_signal(const TomlNode& node, const Campaign& campaign,
                       const std::vector<double>& targets) {
  node.allow_only(names_of(signal_keys()));
  LeakSignal signal;
  read_drive(node, campaign, signal);
  if (const auto printed = node.find("printed")) {
    const auto items = printed->items();
    if (items.size() != targets.size()) {
      printed->fail(fmt::format("has {} coefficients, but there are {} targets: expected one each",
                                items.size(), targets.size()));
    }
    for (std::size_t i = 0; i < items.size(); ++i) {
      signal.printed[targets[i]] = read_printed(items[i]);
    }
  }
  if (const auto normal = node.find("normal")) signal.normal = read_printed(*normal);
  if (const auto notes = node.find("notes")) {
    for (const auto& [key, entry] : notes->entries()) {
      const auto found = std::find_if(
          signal.printed.begin(), signal.printed.end(),
          [&, &name = key](const auto& p) { return fmt::format("{:g}", p.first) == name; });
      if (found == signal.printed.end()) {
        entry.fail(
            "names no target with a printed coefficient: expected its percentage, such as "
            "\"50\"");
      }
      found->second.note = entry.name("text about the entry");
    }
  }
  return signal;
}

PrintedFeatures read_level(const TomlNode& node) {
  PrintedFeatures row;
  level_keys().read(node, row);
  const Words<Feature> names = enumerator_words<Feature>();
  if (const auto left_out = node.find("left_out")) {
    for (const TomlNode& item : left_out->items()) row.left_out.push_back(item.choice(names));
    row.reason = node.require("reason", "why these are left out of a fit").name();
  } else if (const auto reason = node.find("reason")) {
    reason->fail("is given, but no value is left out: expected left_out = [\"std\"] beside it");
  }
  return row;
}

void read_features(const TomlNode& node, const Campaign& campaign, LeakTableSettings& settings) {
  node.allow_only(names_of(feature_keys()));
  settings.feature_signal.emplace();
  read_drive(node, campaign, *settings.feature_signal);
  for (const TomlNode& item :
       node.require("row", "the rows as [[leak_table.features.row]]").items()) {
    settings.features.push_back(read_level(item));
  }
}

double read_assumed(const TomlNode& node, const model::ParameterSpec& spec) {
  const double value = node.quantity(spec.unit);
  if (const auto problem = outside_limits(spec, value)) node.fail(*problem);
  return value;
}

Assumption read_assumption(const TomlNode& node, const Campaign& campaign, int index) {
  static const KeyTable<Assumption> keys = assumption_keys(plain_form(KeyForm::Kind::quantity));
  node.allow_only(keys.names());
  const model::ParameterSpec& spec = assumption_spec(campaign.rig.plant, index);
  Assumption assumption;
  assumption.index = index;
  assumption.value =
      read_assumed(node.require("value", fmt::format("a value in {}", spec.unit)), spec);
  keys.read_rows(node, assumption);
  if (!assumption.fit) {
    for (const char* key : {"start", "lower", "upper"}) {
      if (const auto entry = node.find(key)) {
        entry->fail(
            "has an effect only if fit-tables estimates the value: expected fit = true as well");
      }
    }
    return assumption;
  }
  if (const auto problem = cannot_be_fitted(spec)) node.fail(*problem);
  const TomlNode start = node.require("start", "where fit-tables starts");
  assumption.start = read_assumed(start, spec);
  assumption.lower = read_assumed(node.require("lower", "the lower bound of the fit"), spec);
  assumption.upper = read_assumed(node.require("upper", "the upper bound of the fit"), spec);
  if (!(assumption.lower < assumption.upper && assumption.lower <= assumption.start &&
        assumption.start <= assumption.upper)) {
    start.fail("is not between lower and upper: expected lower <= start <= upper");
  }
  return assumption;
}

void read_assumptions(const TomlNode& node, const Campaign& campaign, LeakTableSettings& settings) {
  std::vector<std::string> known = parameter_keys(campaign.rig.plant, ParameterGroup::any);
  known.emplace_back(kResidualScaleKey);
  for (const auto& [key, entry] : node.entries()) {
    const bool scale = key == kResidualScaleKey;
    const int index = scale ? kResidualScale : model::parameter_index(campaign.rig.plant, key);
    if (index < 0 && !scale) node.fail_unknown(key, "parameter", known);
    if (key == kVariedKey) {
      entry.fail("is the parameter that the table varies: expected any other parameter");
    }
    settings.assumptions.push_back(read_assumption(entry, campaign, index));
  }
}

void read_range(const TomlNode& node, LeakTableSettings& settings) {
  const auto items = node.items();
  if (items.size() != 2) node.fail_type("the lowest and the highest coefficient: [0.001, 100]");
  settings.lowest_coefficient = items[0].number();
  settings.highest_coefficient = items[1].number();
  if (!(settings.lowest_coefficient > 0.0 &&
        settings.lowest_coefficient < settings.highest_coefficient &&
        settings.highest_coefficient <= 1000.0)) {
    node.fail_type("0 < lowest < highest <= 1000");
  }
}

/// Lists the periodic signals (sine, square) of the conditions, without duplicates.
std::vector<LeakSignal> signals_of(const Campaign& campaign) {
  std::vector<LeakSignal> signals;
  for (const Condition& condition : campaign.conditions) {
    if (!is_periodic(condition.waveform) || condition.use == Use::ignore) continue;
    LeakSignal signal;
    signal.waveform = condition.waveform;
    signal.frequency_hz = *condition.frequency_hz;
    signal.amplitude = *condition.amplitude;
    if (std::none_of(signals.begin(), signals.end(),
                     [&](const LeakSignal& other) { return same_drive(signal, other); })) {
      signals.push_back(signal);
    }
  }
  return signals;
}

}  // namespace

std::string LeakSignal::name() const {
  return fmt::format("{}_{:g}Hz", to_string(waveform), frequency_hz);
}

const model::ParameterSpec& assumption_spec(model::PlantKind plant, int index) {
  static constexpr model::ParameterSpec kScale{
      .key = kResidualScaleKey,
      .name = "residual_scale_per_m",
      .symbol = "s_r",
      .unit = "1/m",
      .meaning = "factor from metres to the unit of the printed residual",
      .source = "Table 4",
      .kind = model::ParameterKind::sensor,
      .lower = 1e-6,
      .upper = 1e9};
  return index == kResidualScale ? kScale : model::parameter_spec(plant, index);
}

const Assumption* LeakTableSettings::assumption(int index) const {
  const auto found = std::find_if(assumptions.begin(), assumptions.end(),
                                  [&](const Assumption& entry) { return entry.index == index; });
  return found == assumptions.end() ? nullptr : &*found;
}

const std::vector<CampaignKey>& leak_table_keys() {
  static const std::vector<CampaignKey> keys{
      {"targets", list_form(number_form({0.0, kMostPercent}), "list of numbers"),
       "Shares of the servo flow in percent, increasing", "[10, 20, 30, 50]"},
      {"coefficients", list_form(number_form({0.0, 1000.0}), "two numbers", 2, 2),
       "Range in which roots are searched", "[0.001, 100]"},
      {"assumptions",
       assumptions_form(),
       "Values that override those of the rig, each with its source (below)",
       {},
       "none"},
      {"signal",
       list_form(table_form(signal_keys()), "tables", 0),
       "The columns of the table, each a table `[[leak_table.signal]]`",
       {},
       "from the conditions"},
      {"features",
       table_form(feature_keys()),
       "Published flows and features of the residual at one signal",
       {},
       "none"},
  };
  return keys;
}

LeakTableSettings read_leak_table(const TomlNode& node, const Campaign& campaign) {
  node.allow_only(names_of(leak_table_keys()));
  if (campaign.rig.feedback != model::Feedback::position)
    node.fail(fmt::format(
        "is not defined for a loop on {}: expected feedback = \"position\" in [rig.controller]",
        model::gain_keys(campaign.rig.feedback).name));
  LeakTableSettings settings;
  if (const auto targets = node.find("targets")) settings.targets_percent = read_targets(*targets);
  if (const auto range = node.find("coefficients")) read_range(*range, settings);
  if (const auto values = node.find("assumptions")) read_assumptions(*values, campaign, settings);
  if (const auto signals = node.find("signal")) {
    for (const TomlNode& item : signals->items()) {
      settings.signals.push_back(read_signal(item, campaign, settings.targets_percent));
      const LeakSignal& added = settings.signals.back();
      for (std::size_t i = 0; i + 1 < settings.signals.size(); ++i) {
        if (same_drive(settings.signals[i], added)) {
          item.fail(fmt::format("{} appears twice: expected each signal once", added.name()));
        }
      }
    }
  }
  if (const auto features = node.find("features")) read_features(*features, campaign, settings);
  return settings;
}

LeakTableSettings leak_table_settings(const Campaign& campaign) {
  const toml::table parsed = parse_toml_file(campaign.file);
  const TomlNode root(parsed, campaign.file.string(), "");
  LeakTableSettings settings;
  if (const auto node = root.find("leak_table")) settings = read_leak_table(*node, campaign);
  if (campaign.rig.feedback != model::Feedback::position)
    throw InputError({campaign.file.string()},
                     fmt::format("key 'rig.controller.feedback': a leak table needs a position "
                                 "loop or no controller: found \"{}\"",
                                 model::gain_keys(campaign.rig.feedback).name));
  if (settings.signals.empty()) settings.signals = signals_of(campaign);
  if (settings.signals.empty()) {
    throw InputError({campaign.file.string()},
                     "no signal for a leak table: expected [[leak_table.signal]], or a condition "
                     "with the waveform \"sine\" or \"square\"");
  }
  return settings;
}

LeakSignal signal_from_text(const Campaign& campaign, const LeakTableSettings& settings,
                            std::string_view text) {
  const auto fail = [&](const std::string& problem) {
    throw UsageError(
        fmt::format("--signals {}: {}; expected waveform@frequency or "
                    "waveform@frequency@amplitude, such as sine@0.1Hz@50mm",
                    text, problem));
  };
  std::vector<std::string> parts{""};
  for (const char c : text) {
    if (c == '@') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  if (parts.size() < 2 || parts.size() > 3) fail(fmt::format("found {} parts", parts.size()));
  LeakSignal signal;
  const auto known = waveforms();
  const auto waveform = std::find_if(known.begin(), known.end(),
                                     [&](const auto& entry) { return entry.first == parts[0]; });
  if (waveform == known.end()) fail(fmt::format("'{}' is not a sine or square", parts[0]));
  signal.waveform = waveform->second;
  try {
    signal.frequency_hz = parse_quantity(parts[1], "Hz");
    if (parts.size() == 3) signal.amplitude = parse_quantity(parts[2], amplitude_unit(campaign));
  } catch (const QuantityError& error) {
    fail(error.what());
  }
  if (!(signal.frequency_hz > 0.0)) fail("the frequency is not above zero");
  if (signal.frequency_hz < kFrequencies_hz.lower || signal.frequency_hz > kFrequencies_hz.upper)
    fail(fmt::format("the frequency is not within {:g} to {:g} Hz", kFrequencies_hz.lower,
                     kFrequencies_hz.upper));
  if (parts.size() == 2) {
    signal.amplitude = settings.signals.front().amplitude;
    for (const LeakSignal& other : settings.signals) {
      if (other.amplitude != signal.amplitude) {
        fail("the signals of the campaign differ in amplitude, so one is needed");
      }
    }
  }
  if (!(signal.amplitude > 0.0)) fail("the amplitude is not above zero");
  if (signal.amplitude < kAmplitudes.lower || signal.amplitude > kAmplitudes.upper)
    fail(fmt::format("the amplitude is not within {:g} to {:g} {}", kAmplitudes.lower,
                     kAmplitudes.upper, amplitude_unit(campaign)));
  for (const LeakSignal& other : settings.signals) {
    if (same_drive(signal, other)) return other;
  }
  return signal;
}

void override_assumption(LeakTableSettings& settings, const Campaign& campaign,
                         std::string_view assignment) {
  const std::string_view name = assignment.substr(0, assignment.find('='));
  const bool scale = name == kResidualScaleKey;
  const int index = scale ? kResidualScale : model::parameter_index(campaign.rig.plant, name);
  const ParameterSetting* setting = scale ? nullptr : campaign.setting(index);
  if (!scale && setting == nullptr) return;
  double value = 0.0;
  if (scale) {
    const model::ParameterSpec& spec = assumption_spec(campaign.rig.plant, index);
    try {
      value = parse_quantity(
          assignment.substr(std::min(assignment.find('='), assignment.size() - 1) + 1), spec.unit);
    } catch (const QuantityError& error) {
      throw UsageError(fmt::format("--set {}: {}", assignment, error.what()));
    }
    if (const auto problem = outside_limits(spec, value)) {
      throw UsageError(fmt::format("--set {}: {}", assignment, *problem));
    }
  } else {
    value = setting->value;
  }
  for (Assumption& assumption : settings.assumptions) {
    if (assumption.index != index) continue;
    if (assumption.fit && (value < assumption.lower || value > assumption.upper)) {
      throw UsageError(fmt::format("--set {}: is outside the bounds {:g} to {:g} {} of fit-tables",
                                   assignment, assumption.lower, assumption.upper,
                                   assumption_spec(campaign.rig.plant, index).unit));
    }
    assumption.value = value;
    assumption.start = value;
    assumption.source = "--set";
    assumption.fitted = false;
    return;
  }
  Assumption added;
  added.index = index;
  added.value = value;
  added.source = "--set";
  settings.assumptions.push_back(added);
}

void take_fitted(LeakTableSettings& settings, const Campaign& campaign,
                 const std::vector<FittedValue>& fitted) {
  const int leak = model::parameter_index(campaign.rig.plant, "leakage_coefficient");
  for (const FittedValue& value : fitted) {
    if (value.index == leak) continue;
    const model::ParameterSpec& spec = assumption_spec(campaign.rig.plant, value.index);
    const auto found =
        std::find_if(settings.assumptions.begin(), settings.assumptions.end(),
                     [&](const Assumption& entry) { return entry.index == value.index; });
    if (value.scope != Scope::rig) {
      if (found != settings.assumptions.end()) continue;
      throw InputError(
          {campaign.file.string()},
          fmt::format("{} was fitted {}, so the rig has no single value of it: "
                      "expected one in [leak_table.assumptions], or --set {}",
                      spec.key,
                      value.scope == Scope::leak_level ? "per leak level" : "per condition",
                      spec.key));
    }
    Assumption taken;
    taken.index = value.index;
    taken.value = value.value;
    taken.fitted = true;
    taken.source = "fit";
    if (found == settings.assumptions.end()) {
      settings.assumptions.push_back(taken);
      continue;
    }
    if (found->value != value.value)
      taken.source =
          fmt::format("fit, in place of {:g} {} ({})", found->value, spec.unit, found->source);
    *found = taken;
  }
}

void free_assumptions(LeakTableSettings& settings, const Campaign& campaign,
                      const std::vector<std::string>& names) {
  const model::ParameterValues values = leak_table_values(campaign, settings);
  for (Assumption& assumption : settings.assumptions) assumption.fit = false;
  std::vector<std::string> known = parameter_keys(campaign.rig.plant, ParameterGroup::any);
  known.emplace_back(kResidualScaleKey);
  for (const std::string& name : names) {
    const auto fail = [&](const std::string& problem) {
      throw UsageError(fmt::format("--free {}: {}", name, problem));
    };
    const bool scale = name == kResidualScaleKey;
    const int index = scale ? kResidualScale : model::parameter_index(campaign.rig.plant, name);
    if (index < 0 && !scale) fail(unknown_name_message("parameter", name, known));
    if (name == "leakage_coefficient")
      fail("is the parameter that the table varies: expected another parameter");
    const model::ParameterSpec& spec = assumption_spec(campaign.rig.plant, index);
    if (const auto problem = cannot_be_fitted(spec)) fail(*problem);
    auto found = std::find_if(settings.assumptions.begin(), settings.assumptions.end(),
                              [&](const Assumption& entry) { return entry.index == index; });
    if (found == settings.assumptions.end()) {
      if (scale) fail("has no value to start from: expected --set residual_scale=\"40 1/m\"");
      Assumption added;
      added.index = index;
      added.value = values.value[static_cast<std::size_t>(index)];
      added.source = "campaign file";
      found = settings.assumptions.insert(settings.assumptions.end(), added);
    }
    found->fit = true;
    if (found->lower < found->upper) continue;  // the section gives bounds
    found->start = found->value;
    found->lower = std::max(spec.lower, std::min(0.1 * found->value, 10.0 * found->value));
    found->upper = std::min(spec.upper, std::max(0.1 * found->value, 10.0 * found->value));
    if (!(found->lower < found->upper && std::isfinite(found->upper))) {
      fail(
          "has no value from which bounds can be derived: expected fit = true with start, lower "
          "and upper in [leak_table.assumptions]");
    }
  }
}

model::ParameterValues leak_table_values(const Campaign& campaign,
                                         const LeakTableSettings& settings) {
  auto values = model::ParameterValues::defaults(campaign.rig.plant);
  for (const ParameterSetting& setting : campaign.parameters) {
    values.set(setting.index, setting.value);
  }
  values.set("leakage_coefficient", 0.0);
  for (const Assumption& assumption : settings.assumptions) {
    if (assumption.index != kResidualScale) values.set(assumption.index, assumption.value);
  }
  const auto missing = values.missing();
  if (!missing.empty()) {
    throw InputError({campaign.file.string()},
                     fmt::format("{} has no value for the whole rig, which a leak table needs: "
                                 "expected one in [rig.parameters] or [leak_table.assumptions]",
                                 missing.front()));
  }
  if (const auto conflict = find_conflict(campaign.rig, values)) {
    throw InputError({campaign.file.string()},
                     fmt::format("key '{}': {}", conflict->key, conflict->message));
  }
  return values;
}

}  // namespace rigcal::datasets
