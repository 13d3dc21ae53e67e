#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/describe.hpp"
#include "common/error.hpp"
#include "common/file.hpp"
#include "common/quantity.hpp"
#include "datasets/campaign/design/design_settings.hpp"
#include "datasets/campaign/diagnosis_settings.hpp"
#include "datasets/campaign/report_settings.hpp"
#include "datasets/campaign/waveform.hpp"
#include "datasets/record.hpp"
#include "datasets/stated_sizes.hpp"
#include "model/plant/parameter.hpp"
#include "model/simulate.hpp"

namespace rigcal::datasets {

/// Scope of a fitted parameter's value.
enum class Scope { rig, leak_level, condition };
RIGCAL_NAMES(Scope, rig, leak_level, condition)

struct Prior {
  double mean = 0.0;
  double sd = 0.0;

  /// Returns the distance of a value from the mean, in standard deviations.
  double residual(double value) const { return (value - mean) / sd; }
};

/// One entry of [rig.parameters] or [rig.controller], in SI.
struct ParameterSetting {
  int index = 0;       ///< row of the plant's parameter table
  double value = 0.0;  ///< the known value, or the start value of a fitted parameter
  /// Bounds of the fit. The defaults are value/10 and 10 value within the parameter's limits, or
  /// the limits themselves if the value is 0. NaN if not given and the parameter is not fitted.
  double lower = 0.0;
  double upper = 0.0;
  bool fit = false;
  Scope scope = Scope::rig;
  std::optional<Prior> prior;
  bool nuisance = false;  ///< estimated again in validation
  /// Whether the parameter varies randomly between repeats. The fit then has one unknown per
  /// condition for it. The prior applies to a single repeat; for the mean of R repeats its standard
  /// deviation is divided by sqrt(R).
  bool between_repeats = false;
  Location where;
};

/// Known values that replace those of the rig, as pairs of table index and SI value.
using Overrides = std::vector<std::pair<int, double>>;

enum class ChannelRole { input, output, ignore };
RIGCAL_NAMES(ChannelRole, input, output, ignore)
enum class Interpolation { hold, linear };
RIGCAL_NAMES(Interpolation, hold, linear)

/// The unit that the campaign states for a column, to be compared with the labels in the record
/// file.
struct StatedUnit {
  std::string unit;            ///< "bar"; empty: raw converter counts, which have no unit
  std::optional<double> gain;  ///< physical value in `unit` = gain * number
  bool has_offset = false;
  /// Reading in `unit` at which a command in % or mA counts as kFullCommand_v; 0: the unit is a
  /// voltage.
  double full_scale = 0.0;
  std::string ignored;  ///< `ignore_unit`: a wrong unit in the file; usually empty
  Location where;
};

/// Voltage at the full scale of a command in % or mA: that of the amplifiers of
/// servo and proportional valves.
inline constexpr double kFullCommand_v = 10.0;

/// Conversion from the stated unit to that of a channel, without gain and offset.
///
/// @throws QuantityError  if a unit is unknown, or if the dimensions differ
UnitConversion stated_conversion(const StatedUnit& stated, std::string_view si_unit);

/// One entry of [recording.channels].
struct ChannelSetting {
  Channel channel = Channel::position;
  std::string column;    ///< empty: recorded only if a repeat names it in `columns`
  std::string minus;     ///< second column, subtracted from `column`; empty: none
  UnitConversion to_si;  ///< SI = conversion(gain * raw + offset); `raw` is the number in the file
  StatedUnit stated;
  std::optional<double> sd;               ///< noise of the samples in the file, SI, after `gain`
  double gain_sd = 0.0;                   ///< standard uncertainty of the sensor's gain, relative
  std::optional<Location> gain_sd_where;  ///< place of the channel's own `gain_sd` in the file
  double offset_sd = 0.0;                 ///< standard uncertainty of the sensor's offset, SI
  ChannelRole role = ChannelRole::output;
  Interpolation interpolation = Interpolation::hold;
  bool recognise = true;   ///< simulate a recorded drive as a generated waveform if the two agree
  bool in_counts = false;  ///< raw converter counts in an unknown unit
};

enum class Use { fit, validate, diagnose, ignore };
RIGCAL_NAMES(Use, fit, validate, diagnose, ignore)

/// One item in `repeats`: files (a pattern with * and ?), or columns in one file.
struct RepeatPattern {
  std::string file;
  std::vector<std::string> numbers;        ///< replacements for {n}; empty: one repeat per file
  std::map<Channel, std::string> columns;  ///< replace the channels' columns; may contain {n}
};

/// Limit of one metric: FAIL beyond `limit`, WARN between `limit` and `warn`.
struct AcceptanceLimit {
  Channel channel = Channel::position;  ///< key of the channel
  std::string metric;                   ///< name in result files
  std::optional<double> limit;          ///< beyond it FAIL
  std::optional<double> warn;           ///< between it and `limit` WARN
  RIGCAL_DESCRIBE(channel, metric, limit, warn)
};

/// How the uncertainty of a score enters the comparison with a limit (ISO/IEC 17025:2017, 7.8.6).
enum class DecisionRule {
  simple,      ///< the uncertainty is not taken into account
  guard_band,  ///< a margin below the expanded uncertainty gives WARN
};
RIGCAL_NAMES(DecisionRule, simple, guard_band)

/// Requirements for acceptance without reservation, in addition to the limits on metrics.
struct AcceptanceBounds {
  DecisionRule decision = DecisionRule::simple;
  /// Largest accepted ratio of the model error to the noise in a record's mean. Both are standard
  /// deviations.
  double model_error_to_noise = 0.5;
  /// Largest size that counts as negligible, SI, by table index. Used for estimates that are
  /// indistinguishable from zero.
  std::map<int, double> negligible;
  std::vector<Channel> not_judged;  ///< output channels that need no limit
};

struct Condition {
  std::string id;
  Waveform waveform = Waveform::recorded;
  std::optional<double> frequency_hz;      ///< for a chirp: start frequency
  std::optional<double> end_frequency_hz;  ///< for a chirp (`end_frequency`)
  std::optional<double> sweep_s;           ///< for a chirp (`sweep_time`; default: the duration)
  bool logarithmic_sweep = false;          ///< `sweep = "logarithmic"`
  std::optional<double> amplitude;  ///< amplitude of the drive, in the SI unit of its channel
  std::optional<std::string> leak_level;
  Use use = Use::fit;
  Overrides overrides;  ///< `parameters` and `controller` for this condition
  std::vector<RepeatPattern> repeats;
  std::optional<std::string> averaged;  ///< file that is already averaged
  int repeats_averaged = 1;
  std::optional<int> planned_repeats;  ///< number of repeats of a future record, for `plan`
  std::vector<TimeWindow> windows;     ///< empty: the whole record counts
  bool moving_windows = false;         ///< `windows = "moving"`: derived from the record
  std::optional<std::vector<AcceptanceLimit>> acceptance;  ///< replaces the campaign's limits
  std::vector<Channel> not_judged;                         ///< in addition to those of the campaign
  std::optional<double> duration_s;
  std::optional<double> sample_rate_hz;
  std::optional<double> temperature_k;
  std::optional<std::string> date;
  std::optional<std::string> specimen;  ///< name of the machine, if there are several
  Location where;

  bool has_record() const { return averaged.has_value() || !repeats.empty(); }
  /// Whether a value of the scope applies here. `level` is a leak level or the id of a condition.
  bool is_within(Scope scope, const std::string& level) const {
    if (scope == Scope::rig) return true;
    return level == (scope == Scope::condition ? id : leak_level.value_or(""));
  }
};

enum class InitialMode { rest, record, fit };
RIGCAL_NAMES(InitialMode, rest, record, fit)
enum class Alignment { correlate, none };
RIGCAL_NAMES(Alignment, correlate, none)
enum class SpikeTreatment { report, exclude };
RIGCAL_NAMES(SpikeTreatment, report, exclude)

enum class Loss { squared, huber, cauchy, soft_l1 };
RIGCAL_NAMES(Loss, squared, huber, cauchy, soft_l1)

/// Accepted numbers of posterior draws per chain. Fewer draws give no useful quantiles.
inline constexpr int kLeastPosteriorDraws = 100;
inline constexpr int kMostPosteriorDraws = 100'000;

/// Settings in [fit]; all are optional.
struct FitSettings {
  Loss loss = Loss::squared;
  double loss_scale = 3.0;  ///< in standard deviations of a residual
  int max_iterations = 200;
  int starts = 1;
  int posterior = 0;                  ///< draws per chain; 0: no posterior
  std::optional<double> max_seconds;  ///< limit for the whole fit
  std::vector<Channel> outputs;       ///< channels to compare with the model; empty: every output
};

/// [synthetic]: a known rig, and the disturbances in its records.
struct SyntheticSettings {
  Overrides parameters;                               ///< true values, replacing the campaign's
  std::map<std::string, Overrides> level_parameters;  ///< [synthetic.leak_level."..."]
  int repeats = 5;
  double duration_s = 0.0;  ///< for conditions that state none; 0: absent
  double sample_rate_hz = 0.0;
  std::map<Channel, double> noise_sd;      ///< white noise in one repeat, SI
  std::map<Channel, double> ar1_sd;        ///< stationary sd of AR(1) noise, SI
  double ar1_coefficient = 0.9;            ///< per sample
  std::map<Channel, double> quantisation;  ///< step of the converter, SI
  std::map<Channel, double> drift;         ///< linear, total over the record, random sign, SI
  double trigger_jitter_s = 0.0;           ///< sd of the start time of a repeat
  double supply_ripple_pa = 0.0;           ///< amplitude
  double supply_ripple_hz = 50.0;
  std::map<int, double> variation;  ///< relative sd between repeats, by parameter
};

struct SimulationSettings {
  model::Method method = model::Method::rosenbrock;
  std::optional<double> tolerance;  ///< absent: derived from the noise in the records
  double max_seconds = 120.0;
};

/// A campaign file after checking, with values in SI units.
struct Campaign {
  std::filesystem::path file;
  FileState file_state;            ///< taken before the file was read
  std::filesystem::path data_dir;  ///< base for relative record paths
  std::filesystem::path root;      ///< no file outside this folder is read; empty: no restriction
  std::string name;
  bool synthetic = false;  ///< the records were made by `rigcal synthesize`
  model::Rig rig;
  std::vector<ParameterSetting> parameters;
  std::map<std::string, Overrides> leak_levels;
  InitialMode initial = InitialMode::rest;
  double initial_window_s = 0.1;
  bool before_stated = false;  ///< the campaign sets Rig::before
  char separator = 0;
  std::optional<double> decimate_to_hz;
  SpikeTreatment spikes = SpikeTreatment::report;
  std::optional<double> longest_bridge_s;  ///< longest gap to bridge; absent: gaps are refused
  std::string time_column;
  UnitConversion time_to_s;
  StatedUnit stated_time;
  bool time_in_counts = false;  ///< the time column only numbers the samples; their interval is
                                ///< unknown
  std::map<Channel, ChannelSetting> channels;
  Alignment alignment = Alignment::correlate;
  bool leave_out_outliers = false;  ///< exclude repeats that are far from the others when averaging
  std::vector<AcceptanceLimit> acceptance;
  AcceptanceBounds acceptance_bounds;
  FitSettings fit;
  SimulationSettings simulation;
  StatedSizes considered;
  StatedSizes between_days;
  DiagnosisSettings diagnosis;
  ReportSettings report;
  std::optional<DesignSettings> design;
  std::optional<SyntheticSettings> synthetic_settings;
  std::vector<Condition> conditions;

  const Condition* find(std::string_view id) const;
  const ParameterSetting* setting(int index) const;
  /// Whether a channel is an input that keeps its value from one sample to the next.
  bool is_held_input(Channel channel) const;
  /// Limits for a condition: its own, or else the campaign's.
  const std::vector<AcceptanceLimit>& limits(const Condition& condition) const;
  /// Whether `not_judged` allows an output channel to have no limit in a condition.
  bool may_lack_limits(const Condition& condition, Channel channel) const;
};

/// Returns the channel of the drive: the command, the pilot pressure, or the reference in closed
/// loop.
Channel drive_channel(const model::Rig& rig);
inline Channel drive_channel(const Campaign& campaign) { return drive_channel(campaign.rig); }

/// Returns the channel of the motion: the position, or the angle of a joint.
Channel motion_channel(const model::Rig& rig);
inline Channel motion_channel(const Campaign& campaign) { return motion_channel(campaign.rig); }

/// Returns the channel that may be a recorded load on the rig: the force, or the torque of a joint.
Channel external_load_channel(const model::Rig& rig);
inline Channel external_load_channel(const Campaign& campaign) {
  return external_load_channel(campaign.rig);
}

/// Reads and checks a campaign file.
///
/// @param data_dir  base for relative record paths; the file's folder if empty
/// @param root      no file outside this folder is read, not even through links; empty: no
///                  restriction
/// @throws InputError  if the file is invalid or outside `root`; names file:line:column, the key,
///                     what was found and what was expected, and for an unknown key the nearest
///                     known one
Campaign load_campaign(const std::filesystem::path& file,
                       const std::filesystem::path& data_dir = {},
                       const std::filesystem::path& root = {});

/// Applies `--set name="value unit"`. For a fitted parameter this changes the start value.
///
/// @throws UsageError  if the name is unknown, the unit is wrong, the value is outside the limits
///                     or bounds, or has no effect because every condition has its own value
void set_value(Campaign& campaign, std::string_view assignment);

/// Applies `--set name="value unit"` of a simulation, where there is nothing to fit: every
/// condition gets this value, also where its leak level or the condition states another one. Bounds
/// of a fit do not apply.
///
/// @throws UsageError  if the name is unknown, the unit is wrong or the value is outside the limits
void set_everywhere(Campaign& campaign, std::string_view assignment);

/// Applies `--free a,b`: exactly these parameters are fitted. Missing bounds default to value/10
/// and 10 value within the parameter's limits, or to the limits if the value is 0.
///
/// @throws UsageError  if a name is unknown or the parameter cannot be fitted
void set_free(Campaign& campaign, const std::vector<std::string>& names);

/// Checks that the values are consistent. Call it after the last set_value() and set_free(), since
/// a single change may leave a pair of values incomplete.
///
/// @throws UsageError  if values are missing or contradictory; names the condition
void check_values(const Campaign& campaign);

/// Lists, in words, what is missing for a comparison of a condition with the model: parameters
/// without a value, an unknown drive, time or unit, no output channel. load_campaign() already
/// refuses conditions with use `fit` or `validate` that lack anything except a unit.
std::vector<std::string> lacks_for_model(const Campaign& campaign, const Condition& condition);

/// Returns the parameter values in a condition. Values of its leak level replace those of the rig,
/// and its own values replace both.
model::ParameterValues values_in(const Campaign& campaign, const Condition& condition);

/// One repeat of a condition: a file, and the column for each channel.
struct RepeatSource {
  std::filesystem::path path;
  std::string label;  ///< file name as in the campaign, with the column number if there is one
  std::map<Channel, std::string> columns;
};

/// Lists the repeats of a condition, with patterns expanded and files sorted by name.
///
/// @throws InputError  if a pattern matches no file (names the searched folder), or a file is
///                     outside the campaign's root
std::vector<RepeatSource> repeat_sources(const Campaign& campaign, const Condition& condition);

/// Returns the model inputs for a condition.
///
/// @param record  required for a recorded waveform; otherwise may be null
model::SimulationInputs inputs_of(const Campaign& campaign, const Condition& condition,
                                  const model::ParameterValues& values, const Record* record);

/// Returns the sample times of a condition. They come from its record, or otherwise from its
/// duration and sample rate.
///
/// @throws InputError  if there is neither a record nor a duration and sample rate
std::vector<double> sample_times(const Condition& condition, const Record* record);

/// A value to be written into a campaign file by fitted_campaign_text().
struct FittedValue {
  int index = 0;
  Scope scope = Scope::rig;
  std::string level;
  double value = 0.0;
};
/// Writes the text of `fitted.toml`: the campaign file with known values instead of start values.
/// Nuisance parameters remain free. A start is removed if every condition has its own value.
/// Changes by --set and --free are included. Relative record paths are rewritten to be valid from
/// `out_dir`. The order of the file is kept, but its comments are lost.
///
/// @throws InputError             if the campaign file has disappeared or become invalid
/// @throws std::invalid_argument  if a value belongs to an unknown condition
std::string fitted_campaign_text(const Campaign& campaign, const std::vector<FittedValue>& values,
                                 const std::filesystem::path& out_dir);

/// Writes a campaign file for the records of a designed test. A single condition replaces all
/// others; it has a recorded drive and one file per planned repeat. The planned noise is added
/// where the campaign states none. Changes by --set and --free are included.
///
/// @param noise_sd  noise per sample in one repeat, by channel, SI
/// @throws InputError  if the campaign file has disappeared or become invalid
std::string designed_campaign_text(const Campaign& campaign, const DesignSettings& design,
                                   DriveFamily family, const std::map<Channel, double>& noise_sd);

}  // namespace rigcal::datasets
