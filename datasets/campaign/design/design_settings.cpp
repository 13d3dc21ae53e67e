#include "datasets/campaign/design/design_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "datasets/campaign/campaign_sections.hpp"

namespace rigcal::datasets {
namespace {

constexpr int kMostDesignRepeats = 1000;
constexpr int kMostTrials = 100'000;
constexpr std::size_t kFewestDriveSamples = 100;
/// Limits the computing time, because every drive tried is simulated with a step at each sample.
constexpr std::size_t kMostDriveSamples = 500'000;

constexpr QuantityRange kPositions_m{-1e3, 1e3};
constexpr QuantityRange kSpeeds_m_per_s{1e-9, 1e3};
constexpr QuantityRange kAccelerations_m_per_s2{1e-6, 1e6};
constexpr QuantityRange kCommands_v{1e-6, 1e3};
/// Amplitude of a reference or command, in metres, volts, newtons or pascals.
constexpr QuantityRange kDriveAmplitudes{1e-9, 1e9};

std::pair<TomlNode, TomlNode> two_of(const TomlNode& node, const char* expected) {
  if (!node.is_array()) node.fail_type(expected);
  const auto items = node.items();
  if (items.size() != 2) node.fail_type(expected);
  return {items[0], items[1]};
}

void read_stroke(const TomlNode& node, DesignSettings& settings) {
  const auto [low, high] =
      two_of(node, "permitted positions of the piston, such as [\"-50 mm\", \"50 mm\"]");
  settings.lowest_m = {low.quantity("m", kPositions_m), low.where()};
  settings.highest_m = {high.quantity("m", kPositions_m), high.where()};
  if (!(settings.highest_m.value > settings.lowest_m.value))
    node.fail("its end is not above its beginning: expected the lower position first");
}

void read_band(const TomlNode& node, DesignSettings& settings) {
  const auto [low, high] = two_of(node, "two frequencies, such as [\"0.2 Hz\", \"50 Hz\"]");
  settings.band_hz = {low.quantity("Hz", kFrequencies_hz), high.quantity("Hz", kFrequencies_hz)};
  if (!(settings.band_hz->second > settings.band_hz->first))
    node.fail("its end is not above its beginning: expected the lower frequency first");
  // The sample rate is known here because its row comes before this one.
  if (settings.band_hz->second > 0.5 * settings.sample_rate_hz)
    node.fail(fmt::format("{:g} Hz is above half the sample rate of {:g} Hz",
                          settings.band_hz->second, settings.sample_rate_hz));
}

/// Makes the row for a limit, which is stored with its place in the file.
KeyRow<DesignSettings> limit_row(std::string_view key,
                                 std::optional<StatedLimit> DesignSettings::*limit,
                                 std::string_view unit, QuantityRange range,
                                 const KeyAbout& about) {
  return KeyRow<DesignSettings>::custom(
      key, quantity_form(unit),
      [limit, unit, range](const TomlNode& node, DesignSettings& settings) {
        settings.*limit = StatedLimit{node.quantity(unit, range), node.where()};
      },
      about);
}

void check_sampling(const TomlNode& node, const DesignSettings& settings) {
  const double samples = settings.duration_s * settings.sample_rate_hz;
  if (samples >= kFewestDriveSamples && samples <= kMostDriveSamples) return;
  node.require("duration", "a time")
      .fail(fmt::format("{:g} s at {:g} Hz are {:.0f} samples: expected {} to {}",
                        settings.duration_s, settings.sample_rate_hz, samples, kFewestDriveSamples,
                        kMostDriveSamples));
}

void read_noise(const TomlNode& table, const Campaign& campaign, DesignSettings& settings) {
  for (const auto& [key, node] : table.entries()) {
    const Channel channel = read_channel_key(table, key);
    const auto outputs = output_channels(campaign);
    if (std::find(outputs.begin(), outputs.end(), channel) == outputs.end())
      node.fail("is not an output channel: expected one of those in [recording.channels]");
    settings.noise_sd[channel] = node.difference(info(channel).unit, kStandardDeviations);
  }
}

}  // namespace

std::size_t DesignSettings::samples() const {
  // If the duration is a whole number of intervals, rounding must not drop the last sample.
  constexpr double kSlack = 1e-9;
  return static_cast<std::size_t>(std::floor(duration_s * sample_rate_hz * (1.0 + kSlack))) + 1;
}

const KeyTable<DesignSettings>& design_keys() {
  using Row = KeyRow<DesignSettings>;
  KeyForm stroke = list_form(quantity_form("m"), "two lengths", 2, 2);
  KeyForm band = list_form(quantity_form("Hz"), "two frequencies", 2, 2);
  static const KeyTable<DesignSettings> keys({
      Row::custom("stroke", stroke, read_stroke,
                  {.doc = "Permitted positions of the piston: `[\"-50 mm\", \"50 mm\"]`, including "
                          "the rest position. They also limit a position reference",
                   .example = "[\"-50 mm\", \"50 mm\"]",
                   .needed = "permitted positions of the piston, such as [\"-50 mm\", \"50 mm\"]"}),
      Row::quantity("duration", &DesignSettings::duration_s, "s", kDurations_s,
                    {.doc = "Duration of the test; 100 to 500 000 samples",
                     .example = "\"20 s\"",
                     .needed = "duration of the test, such as \"20 s\""}),
      Row::quantity("sample_rate", &DesignSettings::sample_rate_hz, "Hz", kSampleRates_hz,
                    {.doc = "Of the drive",
                     .example = "\"1 kHz\"",
                     .needed = "that of the drive, such as \"1 kHz\""}),
      limit_row("speed", &DesignSettings::speed_m_per_s, "m/s", kSpeeds_m_per_s,
                {.doc = "Largest speed of the piston", .otherwise = "no limit"}),
      limit_row("acceleration", &DesignSettings::acceleration_m_per_s2, "m/s2",
                kAccelerations_m_per_s2,
                {.doc = "Largest acceleration of the piston", .otherwise = "no limit"}),
      limit_row("command", &DesignSettings::command_v, "V", kCommands_v,
                {.doc = "Largest valve command, after the controller's own limit",
                 .otherwise = "no limit"}),
      limit_row("flow", &DesignSettings::flow_m3_per_s, "m3/s", kFlows_m3_per_s,
                {.doc = "Largest flow of the servo valve", .otherwise = "no limit"}),
      Row::described(
          "amplitude",
          quantity_form(std::vector<std::string>{"m", "V", "Pa", "N", "m/s2", "rad", "N m"}),
          {.doc = "Largest distance of the drive from its initial value, in the unit of its "
                  "channel; needed if the loop controls something other than position",
           .otherwise = "end of the stroke, or `command` without a controller",
           .example = "\"5 mm\""}),
      Row::custom("band", band, read_band,
                  {.doc = "Frequency range of the drive: `[\"0.2 Hz\", \"50 Hz\"]`",
                   .otherwise = "two periods in the test to ten samples per period",
                   .example = "[\"0.2 Hz\", \"50 Hz\"]"}),
      Row::word<DesignCriterion>("criterion", &DesignSettings::criterion,
                                 {.doc = "What is minimised: the volume of the confidence "
                                         "ellipsoid (D-optimal), or the widest relative interval"}),
      Row::word<DriveFamily>("family", &DesignSettings::family,
                             {.doc = "Kind of the drive", .otherwise = "the best of all"}),
      Row::whole("repeats", &DesignSettings::repeats, 1, kMostDesignRepeats,
                 {.doc = "Planned ones"}),
      Row::described("noise", channels_form("table of channels"),
                     {.doc = "Standard deviation of the noise in a sample of one repeat",
                      .otherwise = "the channel's `sd`, that of `[synthetic]`, or that of the "
                                   "records",
                      .example = "{ position = \"0.05 mm\" }"}),
      Row::described("like", plain_form(KeyForm::Kind::text),
                     {.doc = "Id of a condition with the leak level, known values and machine of "
                             "the test; needed if a fitted parameter has scope `leak_level`",
                      .otherwise = "the values of the rig",
                      .example = "\"sine\""}),
      Row::whole("evaluations", &DesignSettings::evaluations, 1, kMostTrials,
                 {.doc = "Number of drives tried in each family"}),
      Row::whole("seed", &DesignSettings::seed, 0, std::numeric_limits<int>::max(),
                 {.doc = "Of the search"}),
  });
  return keys;
}

DesignSettings read_design(const TomlNode& node, const Campaign& campaign) {
  DesignSettings settings;
  settings.where = node.where();
  design_keys().read(node, settings);
  check_sampling(node, settings);
  if (const auto amplitude = node.find("amplitude")) {
    settings.amplitude =
        StatedLimit{amplitude->quantity(info(drive_channel(campaign)).unit, kDriveAmplitudes),
                    amplitude->where()};
  }
  if (const auto noise = node.find("noise")) read_noise(*noise, campaign, settings);
  if (const auto like = node.find("like")) {
    settings.like = like->string("the id of a condition");
    if (campaign.find(*settings.like) == nullptr) {
      Words<bool> ids;
      for (const Condition& condition : campaign.conditions) ids.emplace_back(condition.id, true);
      like->choice(ids);
    }
  }
  return settings;
}

}  // namespace rigcal::datasets
