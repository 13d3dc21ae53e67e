#include <fmt/format.h>

#include <charconv>
#include <cmath>

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
    numbers.push_back(item.name("a text in place of {n}"));
    if (std::count(numbers.begin(), numbers.end(), numbers.back()) > 1) {
      item.fail_type("every number once");
    }
  }
  if (numbers.empty()) node.fail("is empty: expected at least one text to stand for {n}");
  return numbers;
}

RepeatPattern read_repeat(const TomlNode& node, const Campaign& campaign) {
  RepeatPattern pattern;
  if (!node.is_table()) {
    pattern.file = node.name(
        "a file or pattern such as \"records/run_*.csv\", or a table { file, n, columns }");
    return pattern;
  }
  node.allow_only({"file", "n", "columns"});
  pattern.file = node.require("file", "the file of the repeat").name("a file or pattern");
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
  if (numbers) pattern.numbers = read_numbers(*numbers);
  if (numbers && !uses_number) {
    numbers->fail(
        "neither file nor columns hold {n}, so all repeats would be the same one: "
        "expected columns such as position = \"x_mm_{n}\"");
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
  if (averaged) condition.averaged = averaged->name("a file");
  if (const auto count = node.find("repeats_averaged")) {
    condition.repeats_averaged = count->integer(1, 1'000'000);
    if (!averaged) count->fail("has a meaning only together with averaged = \"file\"");
  }
  if (const auto count = node.find("planned_repeats")) {
    condition.planned_repeats = count->integer(1, 1'000'000);
    if (repeats || averaged)
      count->fail("is combined with a record: expected it where none exists yet, for plan");
  }
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
          fmt::format("starts at {} s, before the window in front of it ends ({} s): "
                      "expected windows in order that do not overlap",
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
      entry->fail(
          fmt::format("has no meaning for the waveform \"{}\": expected it only for a chirp",
                      to_string(waveform)));
    }
  }
}

void read_waveform(const TomlNode& node, const Campaign& campaign, Condition& condition) {
  condition.waveform = node.require("waveform", "one of \"sine\" \"square\" \"chirp\" \"recorded\"")
                           .choice<Waveform>(waveforms());
  check_waveform_keys(node, condition.waveform);
  if (const auto sweep = node.find("sweep")) {
    condition.logarithmic_sweep = sweep->choice<bool>({{"linear", false}, {"logarithmic", true}});
  }
  if (const auto frequency = node.find("frequency")) {
    const bool from_zero = condition.waveform == Waveform::chirp && !condition.logarithmic_sweep;
    condition.frequency_hz =
        frequency->quantity("Hz", from_zero ? kFrequenciesFromZero_hz : kFrequencies_hz);
  }
  if (const auto end = node.find("end_frequency")) {
    condition.end_frequency_hz = end->quantity("Hz", kFrequencies_hz);
  }
  if (const auto sweep = node.find("sweep_time"))
    condition.sweep_s = sweep->quantity("s", kDurations_s);
  if (const auto amplitude = node.find("amplitude")) {
    const bool pid = campaign.rig.controller == model::ControllerKind::pid;
    const model::FeedbackRow& loop = model::gain_keys(campaign.rig.feedback);
    const bool pilot = campaign.rig.pilot;
    const bool forces = pilot || (pid && (campaign.rig.feedback == model::Feedback::force ||
                                          campaign.rig.feedback == model::Feedback::load_pressure));
    const std::string note =
        pid     ? fmt::format("with a pid controller the waveform is the {} reference, in {}",
                              loop.name, loop.unit)
        : pilot ? "pilot_gain makes the waveform a pilot pressure, in Pa"
                : "without a controller the waveform is the valve command, in V";
    const std::string_view unit = pid ? loop.unit : pilot ? "Pa" : "V";
    condition.amplitude =
        amplitude->noted(note).quantity(unit, forces ? kLoadAmplitudes : kAmplitudes);
  }
}

void read_time(const TomlNode& node, Condition& condition) {
  if (const auto duration = node.find("duration")) {
    condition.duration_s = duration->quantity("s", kDurations_s);
  }
  if (const auto rate = node.find("sample_rate")) {
    condition.sample_rate_hz = rate->quantity("Hz", kSampleRates_hz);
  }
  if (condition.duration_s && condition.sample_rate_hz &&
      *condition.duration_s * *condition.sample_rate_hz > kMostSamples) {
    node.require("duration", "a time")
        .fail(fmt::format("{} s at {} Hz are more than {:.0f} samples", *condition.duration_s,
                          *condition.sample_rate_hz, kMostSamples));
  }
  if (const auto window = node.find("window")) condition.windows = read_windows(*window);
  if (const auto windows = node.find("windows")) {
    condition.moving_windows = windows->choice<bool>({{"moving", true}});
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

Condition read_condition(const TomlNode& unnamed, const Campaign& campaign) {
  Condition condition;
  condition.id = read_id(unnamed.require("id", "the name of the condition"));
  const TomlNode node = unnamed.renamed(fmt::format("condition \"{}\"", condition.id));
  node.allow_only({"id",
                   "waveform",
                   "frequency",
                   "end_frequency",
                   "sweep_time",
                   "sweep",
                   "amplitude",
                   "leak_level",
                   "use",
                   "parameters",
                   "controller",
                   "repeats",
                   "averaged",
                   "repeats_averaged",
                   "planned_repeats",
                   "window",
                   "windows",
                   "duration",
                   "sample_rate",
                   "temperature",
                   "date",
                   "specimen",
                   "acceptance"});
  condition.where = node.where();
  read_waveform(node, campaign, condition);
  if (const auto level = node.find("leak_level")) {
    condition.leak_level = level->name("a text that names a leak level");
  }
  if (const auto use = node.find("use")) {
    condition.use = use->choice<Use>({{"fit", Use::fit},
                                      {"validate", Use::validate},
                                      {"diagnose", Use::diagnose},
                                      {"ignore", Use::ignore}});
  }
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
  if (const auto temperature = node.find("temperature")) {
    condition.temperature_k = temperature->quantity("K", kTemperatures_k);
  }
  if (const auto date = node.find("date")) condition.date = date->date();
  if (const auto specimen = node.find("specimen"))
    condition.specimen = specimen->name("a text that names the machine");
  return condition;
}

}  // namespace rigcal::datasets
