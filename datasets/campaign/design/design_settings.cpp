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
/// Amplitudes of references in metres, volts, newtons or pascals.
constexpr QuantityRange kDriveAmplitudes{1e-9, 1e9};

template <typename Value, std::size_t N>
std::vector<std::pair<std::string, Value>> choices_of(const std::array<Value, N>& values) {
  std::vector<std::pair<std::string, Value>> choices;
  for (const Value value : values) choices.emplace_back(to_string(value), value);
  return choices;
}

std::pair<TomlNode, TomlNode> two_of(const TomlNode& node, const char* expected) {
  if (!node.is_array()) node.fail_type(expected);
  const auto items = node.items();
  if (items.size() != 2) node.fail_type(expected);
  return {items[0], items[1]};
}

void read_stroke(const TomlNode& node, DesignSettings& settings) {
  const auto [low, high] = two_of(node, "where the piston may be, such as [\"-50 mm\", \"50 mm\"]");
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
  if (settings.band_hz->second > 0.5 * settings.sample_rate_hz)
    node.fail(fmt::format("{:g} Hz is above half the sample rate of {:g} Hz",
                          settings.band_hz->second, settings.sample_rate_hz));
}

std::optional<StatedLimit> read_stated_limit(const TomlNode& design, std::string_view key,
                                             std::string_view unit, QuantityRange range) {
  const auto node = design.find(key);
  if (!node) return std::nullopt;
  return StatedLimit{node->quantity(unit, range), node->where()};
}

void read_sampling(const TomlNode& node, DesignSettings& settings) {
  const TomlNode duration = node.require("duration", "how long the test is, such as \"20 s\"");
  settings.duration_s = duration.quantity("s", kDurations_s);
  settings.sample_rate_hz = node.require("sample_rate", "that of the drive, such as \"1 kHz\"")
                                .quantity("Hz", kSampleRates_hz);
  const double samples = settings.duration_s * settings.sample_rate_hz;
  if (samples < kFewestDriveSamples || samples > kMostDriveSamples)
    duration.fail(fmt::format("{:g} s at {:g} Hz are {:.0f} samples: expected {} to {}",
                              settings.duration_s, settings.sample_rate_hz, samples,
                              kFewestDriveSamples, kMostDriveSamples));
}

void read_noise(const TomlNode& table, const Campaign& campaign, DesignSettings& settings) {
  for (const auto& [key, node] : table.entries()) {
    const Channel channel = read_channel_key(table, key);
    const auto outputs = output_channels(campaign);
    if (std::find(outputs.begin(), outputs.end(), channel) == outputs.end())
      node.fail("is no output channel: expected one of those in [recording.channels]");
    settings.noise_sd[channel] = node.difference(info(channel).unit, kStandardDeviations);
  }
}

}  // namespace

std::string_view to_string(DesignCriterion criterion) {
  switch (criterion) {
    case DesignCriterion::determinant:
      return "determinant";
    case DesignCriterion::worst:
      return "worst";
  }
  return "";
}

std::string_view to_string(DriveFamily family) {
  switch (family) {
    case DriveFamily::multisine:
      return "multisine";
    case DriveFamily::chirp:
      return "chirp";
    case DriveFamily::steps:
      return "steps";
    case DriveFamily::prbs:
      return "prbs";
  }
  return "";
}

std::size_t DesignSettings::samples() const {
  // If the duration is a whole number of intervals, rounding must not drop the last sample.
  constexpr double kSlack = 1e-9;
  return static_cast<std::size_t>(std::floor(duration_s * sample_rate_hz * (1.0 + kSlack))) + 1;
}

DesignSettings read_design(const TomlNode& node, const Campaign& campaign) {
  node.allow_only({"stroke", "speed", "acceleration", "command", "flow", "amplitude", "duration",
                   "sample_rate", "band", "criterion", "family", "repeats", "evaluations", "seed",
                   "noise", "like"});
  DesignSettings settings;
  settings.where = node.where();
  read_stroke(node.require("stroke", "where the piston may be, such as [\"-50 mm\", \"50 mm\"]"),
              settings);
  read_sampling(node, settings);
  settings.speed_m_per_s = read_stated_limit(node, "speed", "m/s", kSpeeds_m_per_s);
  settings.acceleration_m_per_s2 =
      read_stated_limit(node, "acceleration", "m/s2", kAccelerations_m_per_s2);
  settings.command_v = read_stated_limit(node, "command", "V", kCommands_v);
  settings.flow_m3_per_s = read_stated_limit(node, "flow", "m3/s", kFlows_m3_per_s);
  settings.amplitude =
      read_stated_limit(node, "amplitude", info(drive_channel(campaign)).unit, kDriveAmplitudes);
  if (const auto band = node.find("band")) read_band(*band, settings);
  if (const auto criterion = node.find("criterion"))
    settings.criterion = criterion->choice(
        choices_of(std::array{DesignCriterion::determinant, DesignCriterion::worst}));
  if (const auto family = node.find("family"))
    settings.family = family->choice(choices_of(kDriveFamilies));
  if (const auto repeats = node.find("repeats"))
    settings.repeats = repeats->integer(1, kMostDesignRepeats);
  if (const auto evaluations = node.find("evaluations"))
    settings.evaluations = evaluations->integer(1, kMostTrials);
  if (const auto seed = node.find("seed"))
    settings.seed = static_cast<std::uint64_t>(seed->integer(0, std::numeric_limits<int>::max()));
  if (const auto noise = node.find("noise")) read_noise(*noise, campaign, settings);
  if (const auto like = node.find("like")) {
    settings.like = like->string("the id of a condition");
    if (campaign.find(*settings.like) == nullptr) {
      std::vector<std::pair<std::string, bool>> ids;
      for (const Condition& condition : campaign.conditions) ids.emplace_back(condition.id, true);
      like->choice(ids);
    }
  }
  return settings;
}

}  // namespace rigcal::datasets
