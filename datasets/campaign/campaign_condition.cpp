#include <fmt/format.h>

#include <charconv>

#include "datasets/campaign/campaign_parameters.hpp"
#include "datasets/campaign/campaign_sections.hpp"
#include "datasets/campaign/condition_id.hpp"

namespace rigcal::datasets {
namespace {

constexpr long kMostRepeats = 10'000;
constexpr std::string_view kPlaceholder = "{n}";

bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

std::string read_id(const TomlNode& node) {
  const std::string id = node.name("an id of letters, digits, '.', '_' and '-'");
  if (!is_condition_id(id)) node.fail_type(std::string(condition_id_rule()));
  return id;
}

std::optional<long> whole_number(std::string_view text) {
  long value = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc{} && rest == text.data() + text.size() && value >= 0;
  return whole ? std::optional(value) : std::nullopt;
}

/// Expands "01..10" to 01, 02, ..., 10. Leading zeros are kept.
std::vector<std::string> read_range(const TomlNode& node) {
  const std::string expected = fmt::format(
      "a range such as \"01..10\" of at most {} numbers, or a list of texts", kMostRepeats);
  const std::string text = node.string(expected);
  const std::size_t dots = text.find("..");
  const std::string first_text = text.substr(0, dots);
  const auto first = whole_number(first_text);
  const auto last = dots == std::string::npos ? std::nullopt : whole_number(text.substr(dots + 2));
  if (!first || !last || *last < *first || *last - *first >= kMostRepeats) node.fail_type(expected);
  const bool padded = first_text.size() > 1 && first_text.front() == '0';
  std::vector<std::string> numbers;
  for (long n = *first; n <= *last; ++n) {
    numbers.push_back(padded ? fmt::format("{:0{}}", n, first_text.size()) : fmt::format("{}", n));
  }
  return numbers;
}

std::vector<std::string> read_numbers(const TomlNode& node) {
  if (!node.is_array()) return read_range(node);
  std::vector<std::string> numbers;
  for (const TomlNode& item : node.items()) {
    numbers.push_back(item.name("text in place of {n}"));
    if (std::count(numbers.begin(), numbers.end(), numbers.back()) > 1) {
      item.fail_type("every number once");
    }
  }
  if (numbers.empty()) node.fail("is empty: expected at least one text to replace {n}");
  return numbers;
}

/// Keys of an entry of `repeats` that is a table.
const KeyTable<RepeatPattern>& repeat_keys() {
  using Row = KeyRow<RepeatPattern>;
  KeyForm columns = channels_form("table");
  for (CampaignKey& row : columns.keys) row.form = plain_form(KeyForm::Kind::text);
  static const KeyTable<RepeatPattern> keys({
      Row::text("file", &RepeatPattern::file, "a file or pattern",
                {.doc = "File or pattern; may contain `{n}`",
                 .example = "\"steps_1V.csv\"",
                 .needed = "the file of the repeat"}),
      Row::custom(
          "n",
          either_form({plain_form(KeyForm::Kind::text), list_form(plain_form(KeyForm::Kind::text))},
                      "text or list"),
          [](const TomlNode& node, RepeatPattern& pattern) {
            pattern.numbers = read_numbers(node);
          },
          {.doc =
               "Text in place of `{n}`: `\"01..10\"` (leading zeros are kept) or a list of texts",
           .otherwise = "none",
           .example = "\"01..10\""}),
      Row::described("columns", columns,
                     {.doc = "Columns of this repeat, by channel",
                      .otherwise = "those of the channels",
                      .example = "{ position = \"x_mm_{n}\" }"}),
  });
  return keys;
}

RepeatPattern read_repeat(const TomlNode& node, const Campaign& campaign) {
  RepeatPattern pattern;
  if (!node.is_table()) {
    pattern.file = node.name(
        "a file or pattern such as \"records/run_*.csv\", or a table { file, n, columns }");
    return pattern;
  }
  repeat_keys().read(node, pattern);
  bool uses_number = contains(pattern.file, kPlaceholder);
  if (const auto columns = node.find("columns")) {
    for (const auto& [key, entry] : columns->entries()) {
      const Channel channel = read_channel_key(*columns, key);
      if (!campaign.channels.contains(channel)) {
        entry.fail(
            fmt::format("{0} has no unit: expected an entry {0} = {{ unit = \"...\" }} in "
                        "[recording.channels]",
                        key));
      }
      pattern.columns[channel] = entry.name("a column name");
      uses_number = uses_number || contains(pattern.columns[channel], kPlaceholder);
    }
  }
  const auto numbers = node.find("n");
  if (numbers && !uses_number) {
    numbers->fail(
        "neither file nor columns contain {n}, so all repeats would be the same: expected columns "
        "such as position = \"x_mm_{n}\"");
  }
  if (!numbers && uses_number) {
    node.fail("contains {n} but does not say what replaces it: expected n = \"01..10\" beside it");
  }
  return pattern;
}

void read_records(const TomlNode& node, const Campaign& campaign, Condition& condition) {
  const auto repeats = node.find("repeats");
  const auto averaged = node.find("averaged");
  if (repeats && averaged) {
    averaged->fail("cannot be combined with repeats: expected one of them");
  }
  if (repeats) {
    if (!repeats->is_array()) {
      repeats->fail_type("a list of files in brackets, such as [\"records/run_*.csv\"]");
    }
    for (const TomlNode& item : repeats->items()) {
      condition.repeats.push_back(read_repeat(item, campaign));
    }
    if (condition.repeats.empty()) repeats->fail("is empty: expected at least one file");
  }
  if (const auto count = node.find("repeats_averaged"); count && !averaged)
    count->fail("is meaningful only with averaged = \"file\"");
  if (const auto count = node.find("planned_repeats"); count && (repeats || averaged))
    count->fail("is combined with a record: expected only without one, for plan");
}

TimeWindow read_window(const TomlNode& node) {
  const auto items = node.items();
  if (items.size() != 2) {
    node.fail(fmt::format("has {} entries: expected start and end, such as [\"0.5 s\", \"12 s\"]",
                          items.size()));
  }
  const TimeWindow window{items[0].quantity("s", kInstants_s), items[1].quantity("s", kInstants_s)};
  if (!(window.start_s < window.end_s)) {
    node.fail(
        fmt::format("the start ({} s) is not before the end ({} s)", window.start_s, window.end_s));
  }
  return window;
}

std::vector<TimeWindow> read_windows(const TomlNode& node) {
  const auto items = node.items();
  if (items.empty()) node.fail("is empty: expected a window such as [\"0.5 s\", \"12 s\"]");
  if (!items.front().is_array()) return {read_window(node)};
  std::vector<TimeWindow> windows;
  for (const TomlNode& item : items) {
    const TimeWindow window = read_window(item);
    if (!windows.empty() && window.start_s < windows.back().end_s) {
      item.fail(
          fmt::format("starts at {} s, before the previous window ends ({} s): expected windows in "
                      "increasing order without overlap",
                      window.start_s, windows.back().end_s));
    }
    windows.push_back(window);
  }
  return windows;
}

struct Rule {
  std::string key;
  bool needed;
  bool allowed;
};

/// Checks that a condition has the keys that its waveform needs, and no others.
void check_waveform_keys(const TomlNode& node, Waveform waveform) {
  const bool recorded = waveform == Waveform::recorded;
  const bool chirp = waveform == Waveform::chirp;
  const std::vector<Rule> rules{{"frequency", !recorded, true},
                                {"amplitude", !recorded, true},
                                {"end_frequency", chirp, chirp},
                                {"sweep_time", false, chirp},
                                {"sweep", false, chirp}};
  for (const Rule& rule : rules) {
    const auto entry = node.find(rule.key);
    if (rule.needed) node.require(rule.key, fmt::format("a {} needs it", to_string(waveform)));
    if (entry && !rule.allowed) {
      entry->fail(fmt::format("is not used with the waveform \"{}\": expected only for a chirp",
                              to_string(waveform)));
    }
  }
}

void read_amplitude(const TomlNode& amplitude, const Campaign& campaign, Condition& condition) {
  const bool pid = campaign.rig.controller == model::ControllerKind::pid;
  const model::FeedbackRow& loop = model::gain_keys(campaign.rig.feedback);
  const bool pilot = campaign.rig.pilot;
  const bool forces =
      pilot || (pid && (loop.unit == "N" || loop.unit == "N m" || loop.unit == "Pa"));
  const std::string note =
      pid ? fmt::format("with a pid controller the waveform is the {} reference, in {}", loop.name,
                        loop.unit)
      : pilot ? "pilot_gain makes the waveform a pilot pressure, in Pa"
              : "without a controller the waveform is the valve command, in V";
  const std::string_view unit = pid ? loop.unit : pilot ? "Pa" : "V";
  condition.amplitude =
      amplitude.noted(note).quantity(unit, forces ? kLoadAmplitudes : kAmplitudes);
}

void read_time(const TomlNode& node, Condition& condition) {
  if (condition.duration_s && condition.sample_rate_hz &&
      *condition.duration_s * *condition.sample_rate_hz > kMostSamples) {
    node.require("duration", "a time")
        .fail(fmt::format("{} s at {} Hz is more than {:.0f} samples", *condition.duration_s,
                          *condition.sample_rate_hz, kMostSamples));
  }
  if (const auto windows = node.find("windows")) {
    if (!condition.windows.empty()) {
      windows->fail("cannot be combined with window: expected one of them");
    }
    if (!condition.has_record()) {
      windows->fail(
          "are found from the record, but the condition has none: expected repeats or "
          "averaged, or window = [\"0.5 s\", \"12 s\"]");
    }
  }
}

void append(Overrides& all, const Overrides& more) {
  all.insert(all.end(), more.begin(), more.end());
}

}  // namespace

const KeyTable<Condition>& condition_keys() {
  using Row = KeyRow<Condition>;
  const KeyForm text = plain_form(KeyForm::Kind::text);
  const KeyForm window = list_form(quantity_form("s"), "list", 2, 2);
  const KeyForm repeat = either_form({text, table_form(repeat_keys().keys())}, "text or table");
  KeyForm limits = table_form(limit_keys());
  const std::string_view drives = "Sine, square and chirp need it. ";
  static const KeyTable<Condition> keys({
      Row::described(
          "id", text,
          {.doc = "Name of the condition and its files; unique even without regard to case",
           .example = "\"sine\"",
           .needed = "the name of the condition"}),
      Row::word<Waveform>("waveform", &Condition::waveform, waveforms(),
                          {.doc = "Signal of the drive",
                           .needed = "one of \"sine\" \"square\" \"chirp\" \"recorded\""}),
      Row::word<bool>("sweep", &Condition::logarithmic_sweep,
                      {{"linear", false}, {"logarithmic", true}}, {.doc = "Of a chirp"}),
      Row::custom("frequency", quantity_form("Hz"),
                  [](const TomlNode& node, Condition& condition) {
                    const bool from_zero =
                        condition.waveform == Waveform::chirp && !condition.logarithmic_sweep;
                    condition.frequency_hz =
                        node.quantity("Hz", from_zero ? kFrequenciesFromZero_hz : kFrequencies_hz);
                  },
                  {.doc = fmt::format("{}For a chirp: at its start", drives), .otherwise = "none"}),
      Row::described(
          "amplitude",
          quantity_form(std::vector<std::string>{"m", "V", "Pa", "N", "m/s2", "rad", "N m"}),
          {.doc = fmt::format("{}Half of peak to peak: a length; a voltage without a controller (a "
                              "pressure with `pilot_gain`); or the quantity of `feedback`",
                              drives),
           .otherwise = "none",
           .example = "\"5 mm\""}),
      Row::quantity("end_frequency", &Condition::end_frequency_hz, "Hz", kFrequencies_hz,
                    {.doc = "A chirp needs it", .otherwise = "none"}),
      Row::quantity("sweep_time", &Condition::sweep_s, "s", kDurations_s,
                    {.doc = "Of a chirp", .otherwise = "`duration`, or the record's length"}),
      Row::text("leak_level", &Condition::leak_level, "text that names a leak level",
                {.doc = "Needed where a fitted parameter has the scope `\"leak_level\"`",
                 .otherwise = "none",
                 .example = "\"none\"",
                 .hint = "names the state of the rig, if there are several"}),
      Row::word<Use>("use", &Condition::use,
                     {.doc = "What the condition is for",
                      .example = "\"fit\"",
                      .hint = "or \"validate\": keep some back from the fit"}),
      Row::described("parameters", known_values_form(ParameterGroup::rig),
                     {.doc = "Known values of this condition alone", .otherwise = "none"}),
      Row::described(
          "controller", known_values_form(ParameterGroup::controller),
          {.doc = "Known values of the controller in this condition alone", .otherwise = "none"}),
      Row::described("repeats", list_form(repeat),
                     {.doc = "One entry per file, pattern or column set (below)",
                      .otherwise = "none",
                      .example = "[\"records/sine_*.csv\"]"}),
      Row::text("averaged", &Condition::averaged, "a file",
                {.doc = "A file that is already averaged, in place of `repeats`",
                 .otherwise = "none",
                 .example = "\"averaged/sine.csv\""}),
      Row::whole("repeats_averaged", &Condition::repeats_averaged, 1, 1'000'000,
                 {.doc = "Number of repeats behind `averaged`"}),
      Row::whole("planned_repeats", &Condition::planned_repeats, 1, 1'000'000,
                 {.doc = "Number of repeats that `plan` assumes for a condition without a record",
                  .otherwise = "the number to which the campaign's noise refers",
                  .example = "5"}),
      Row::custom("window", either_form({window, list_form(window)}, "list"),
                  [](const TomlNode& node, Condition& condition) {
                    condition.windows = read_windows(node);
                  },
                  {.doc = "Part of the record that is used: `[\"0.5 s\", \"12 s\"]`, or several: "
                          "`[[\"1 s\", \"2 s\"], [\"4 s\", \"6 s\"]]`",
                   .otherwise = "the whole record",
                   .example = "[\"0.5 s\", \"12 s\"]"}),
      Row::word<bool>(
          "windows", &Condition::moving_windows, {{"moving", true}},
          {.doc = "Found from the record (below), in place of `window`", .otherwise = "none"}),
      Row::quantity("duration", &Condition::duration_s, "s", kDurations_s,
                    {.doc = "Duration without a record; a shorter record causes a warning",
                     .otherwise = "that of `[synthetic]`"}),
      Row::quantity(
          "sample_rate", &Condition::sample_rate_hz, "Hz", kSampleRates_hz,
          {.doc = "Sampling rate without a record", .otherwise = "that of `[synthetic]`"}),
      Row::quantity("temperature", &Condition::temperature_k, "K", kTemperatures_k,
                    {.doc = "Stated in the results: `\"38 degC\"`. It is the oil temperature if "
                            "`reference_temperature` is given",
                     .otherwise = "none",
                     .example = "\"38 degC\""}),
      Row::date(
          "date", &Condition::date,
          {.doc = "Stated in the results: `2026-03-01`, without quotes", .otherwise = "none"}),
      Row::text("specimen", &Condition::specimen, "text that names the machine",
                {.doc = "Which machine, where a campaign has several",
                 .otherwise = "none",
                 .example = "\"machine 2\""}),
      Row::described("acceptance", limits,
                     {.doc = "Limits of this condition, in place of `[acceptance]`",
                      .otherwise = "that of the campaign"}),
  });
  return keys;
}

Condition read_condition(const TomlNode& unnamed, const Campaign& campaign) {
  Condition condition;
  condition.id = read_id(unnamed.require("id", "the name of the condition"));
  const TomlNode node = unnamed.renamed(fmt::format("condition \"{}\"", condition.id));
  condition.where = node.where();
  condition_keys().read(node, condition);
  check_waveform_keys(node, condition.waveform);
  if (const auto amplitude = node.find("amplitude"))
    read_amplitude(*amplitude, campaign, condition);
  if (const auto values = node.find("parameters")) {
    condition.overrides = read_overrides(*values, campaign.rig.plant, ParameterGroup::rig);
  }
  if (const auto values = node.find("controller")) {
    append(condition.overrides,
           read_overrides(*values, campaign.rig.plant, ParameterGroup::controller));
  }
  read_records(node, campaign, condition);
  read_time(node, condition);
  if (const auto limits = node.find("acceptance")) {
    condition.acceptance = read_limits(*limits, campaign);
    condition.not_judged = read_not_judged(*limits, campaign, *condition.acceptance);
  }
  return condition;
}

}  // namespace rigcal::datasets
