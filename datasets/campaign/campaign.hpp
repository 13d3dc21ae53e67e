#pragma once

#include <array>
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
#include "datasets/between_days_settings.hpp"
#include "datasets/campaign/design/design_settings.hpp"
#include "datasets/campaign/diagnosis_settings.hpp"
#include "datasets/campaign/report_settings.hpp"
#include "datasets/campaign/waveform.hpp"
#include "datasets/considered_settings.hpp"
#include "datasets/record.hpp"
#include "model/plant/parameter.hpp"
#include "model/simulate.hpp"

namespace rigcal::datasets {

/// Scope of one value of a fitted parameter.
enum class Scope { rig, leak_level, condition };
std::string_view to_string(Scope scope);

struct Prior {
  double mean = 0.0;
  double sd = 0.0;

  /// Distance of a value from the mean, in standard deviations.
  double residual(double value) const { return (value - mean) / sd; }
};

/// One entry of [rig.parameters] or [rig.controller], in SI.
struct ParameterSetting {
  int index = 0;       ///< row of the plant's parameter table
  double value = 0.0;  ///< the known value, or the start of a fitted one
  /// Bounds of the fit. Where the campaign gives none: value/10 to 10 value within the parameter's
  /// limits (its limits where the value is 0). NaN: not given, and not `fit`.
  double lower = 0.0;
  double upper = 0.0;
  bool fit = false;
  Scope scope = Scope::rig;
  std::optional<Prior> prior;
  bool nuisance = false;  ///< estimated again in validation
  /// It differs at random from one repeat to the next: one unknown per condition, whose prior is
  /// that of a single repeat; in the mean of R repeats its standard deviation is over sqrt(R).
  bool between_repeats = false;
  Location where;
};

/// Known values over those of the rig: (table index, SI value).
using Overrides = std::vector<std::pair<int, double>>;

enum class ChannelRole { input, output, ignore };
enum class Interpolation { hold, linear };

/// What the campaign states about the numbers of a column, to be compared with the labels in its
/// file.
struct StatedUnit {
  std::string unit;            ///< "bar"; empty: raw numbers of a converter, which have no unit
  std::optional<double> gain;  ///< physical value in `unit` = gain * number
  bool has_offset = false;
  std::string ignored;  ///< `ignore_unit`: wrong unit in the file; mostly empty
  Location where;
};

/// One entry of [recording.channels].
struct ChannelSetting {
  Channel channel = Channel::position;
  std::string column;    ///< empty: only where `columns` of a repeat names one
  std::string minus;     ///< second column that is subtracted from `column`; empty: none
  UnitConversion to_si;  ///< SI = conversion(gain * raw + offset), from the file's number
  StatedUnit stated;
  std::optional<double> sd;               ///< for samples in the file, SI, after `gain`
  double gain_sd = 0.0;                   ///< standard uncertainty of the sensor's gain, relative
  std::optional<Location> gain_sd_where;  ///< where the channel states `gain_sd` itself
  double offset_sd = 0.0;                 ///< standard uncertainty of its offset, SI
  ChannelRole role = ChannelRole::output;
  Interpolation interpolation = Interpolation::hold;
  bool recognise = true;   ///< simulate a recorded drive as generated where it equals one
  bool in_counts = false;  ///< raw numbers of a converter, in an unknown unit
};

enum class Use { fit, validate, diagnose, ignore };
std::string_view to_string(Use use);

/// One item of `repeats`: files (a pattern with * and ?), or columns of one file.
struct RepeatPattern {
  std::string file;
  std::vector<std::string> numbers;        ///< replacements of {n}; empty: one repeat per file
  std::map<Channel, std::string> columns;  ///< over the columns of the channels; {n} replaced
};

/// Limit of one metric: FAIL beyond `limit`, WARN between it and `warn`.
struct AcceptanceLimit {
  Channel channel = Channel::position;
  std::string metric;  ///< name as in the results
  std::optional<double> limit;
  std::optional<double> warn;
  RIGCAL_DESCRIBE(channel, metric, limit, warn)
};

/// How the uncertainty of a score enters the comparison with a limit (ISO/IEC 17025:2017, 7.8.6).
enum class DecisionRule {
  simple,      ///< not at all
  guard_band,  ///< a limit is kept without reservation only by more than the expanded uncertainty
};
std::string_view to_string(DecisionRule rule);

/// Conditions for acceptance without reservation, in addition to the limits of metrics.
struct AcceptanceBounds {
  DecisionRule decision = DecisionRule::simple;
  /// Standard deviation of the model's error over that of the noise of a record's mean.
  double model_error_to_noise = 0.5;
  /// Largest negligible size, SI, of parameters whose estimate is not distinguishable from zero.
  std::map<int, double> negligible;
  std::vector<Channel> not_judged;  ///< output channels that need no limit
};

struct Condition {
  std::string id;
  Waveform waveform = Waveform::recorded;
  std::optional<double> frequency_hz;      ///< for a chirp: at its start
  std::optional<double> end_frequency_hz;  ///< for a chirp (`end_frequency`)
  std::optional<double> sweep_s;           ///< for a chirp (`sweep_time`; default: the duration)
  bool logarithmic_sweep = false;          ///< `sweep = "logarithmic"`
  std::optional<double> amplitude;  ///< amplitude of the drive, in the SI unit of its channel
  std::optional<std::string> leak_level;
  Use use = Use::fit;
  Overrides overrides;  ///< `parameters` and `controller` of this condition
  std::vector<RepeatPattern> repeats;
  std::optional<std::string> averaged;  ///< file that is averaged already
  int repeats_averaged = 1;
  std::optional<int> planned_repeats;  ///< repeats of a record that does not exist yet, for `plan`
  std::vector<TimeWindow> windows;     ///< empty: the whole record counts
  bool moving_windows = false;         ///< `windows = "moving"`: found from the record
  std::optional<std::vector<AcceptanceLimit>> acceptance;  ///< in place of the campaign's
  std::vector<Channel> not_judged;                         ///< in addition to those of the campaign
  std::optional<double> duration_s;
  std::optional<double> sample_rate_hz;
  std::optional<double> temperature_k;
  std::optional<std::string> date;
  std::optional<std::string> specimen;  ///< the machine, if a campaign has several
  Location where;

  bool has_record() const { return averaged.has_value() || !repeats.empty(); }
};

enum class InitialMode { rest, record, fit };
enum class Alignment { correlate, none };
enum class SpikeTreatment { report, exclude };

enum class Loss { squared, huber, cauchy, soft_l1 };

/// Draws of each chain of the posterior: fewer give no quantiles.
inline constexpr int kLeastPosteriorDraws = 100;
inline constexpr int kMostPosteriorDraws = 100'000;

/// [fit], all optional.
struct FitSettings {
  Loss loss = Loss::squared;
  double loss_scale = 3.0;  ///< in standard deviations of a residual
  int max_iterations = 200;
  int starts = 1;
  int posterior = 0;                  ///< draws of each chain of the posterior; 0: none
  std::optional<double> max_seconds;  ///< limit for the whole fit
  std::vector<Channel> outputs;       ///< compared with the model; empty: every output channel
  /// Length of the pieces of multiple shooting before a start; none: no multiple shooting.
  std::optional<double> shooting_interval_s;
};

/// [synthetic]: a known rig and the disturbances of its records.
struct SyntheticSettings {
  Overrides parameters;                               ///< the truth, over the campaign's values
  std::map<std::string, Overrides> level_parameters;  ///< [synthetic.leak_level."..."]
  int repeats = 5;
  double duration_s = 0.0;  ///< for conditions without one; 0: none
  double sample_rate_hz = 0.0;
  std::map<Channel, double> noise_sd;      ///< white, of one repeat, SI
  std::map<Channel, double> ar1_sd;        ///< stationary sd of an AR(1) noise, SI
  double ar1_coefficient = 0.9;            ///< per sample
  std::map<Channel, double> quantisation;  ///< step of the converter, SI
  std::map<Channel, double> drift;         ///< linear, over the record, random sign, SI
  double trigger_jitter_s = 0.0;           ///< sd of the start of each repeat
  double supply_ripple_pa = 0.0;           ///< amplitude
  double supply_ripple_hz = 50.0;
  std::map<int, double> variation;  ///< relative sd between repeats, by parameter
};

struct SimulationSettings {
  model::Method method = model::Method::rosenbrock;
  std::optional<double> tolerance;  ///< none: from the noise of the records
  double max_seconds = 120.0;
};

/// A campaign file, checked and in SI.
struct Campaign {
  std::filesystem::path file;
  FileState file_state;            ///< taken before the file was read
  std::filesystem::path data_dir;  ///< base of relative record paths
  std::filesystem::path root;      ///< no file outside this folder is read; empty: no restriction
  std::string name;
  bool synthetic = false;  ///< its records were made by `rigcal synthesize`
  model::Rig rig;
  std::vector<ParameterSetting> parameters;
  std::map<std::string, Overrides> leak_levels;
  InitialMode initial = InitialMode::rest;
  double initial_window_s = 0.1;
  bool before_stated = false;  ///< the campaign sets Rig::before
  char separator = 0;
  std::optional<double> decimate_to_hz;
  SpikeTreatment spikes = SpikeTreatment::report;
  std::optional<double> longest_bridge_s;  ///< longest bridged hole; none: holes are refused
  std::string time_column;
  UnitConversion time_to_s;
  StatedUnit stated_time;
  bool time_in_counts = false;  ///< samples are numbered, and their interval is unknown
  std::map<Channel, ChannelSetting> channels;
  Alignment alignment = Alignment::correlate;
  bool leave_out_outliers = false;  ///< repeats far from the others are not in the mean
  std::vector<AcceptanceLimit> acceptance;
  AcceptanceBounds acceptance_bounds;
  FitSettings fit;
  SimulationSettings simulation;
  ConsideredSettings considered;
  BetweenDaysSettings between_days;
  DiagnosisSettings diagnosis;
  ReportSettings report;
  std::optional<DesignSettings> design;
  std::optional<SyntheticSettings> synthetic_settings;
  std::vector<Condition> conditions;

  const Condition* find(std::string_view id) const;
  const ParameterSetting* setting(int index) const;
  /// Limits of a condition: its own, or the campaign's.
  const std::vector<AcceptanceLimit>& limits(const Condition& condition) const;
  /// Whether `not_judged` allows an output channel of a condition to have no limit.
  bool may_lack_limits(const Condition& condition, Channel channel) const;
};

/// Channel of the drive: the command, the pilot pressure, or the reference of the loop.
Channel drive_channel(const model::Rig& rig);
inline Channel drive_channel(const Campaign& campaign) { return drive_channel(campaign.rig); }

/// Channel of the motion: the position, or the angle of a joint.
Channel motion_channel(const model::Rig& rig);
inline Channel motion_channel(const Campaign& campaign) { return motion_channel(campaign.rig); }

/// Reads and checks a campaign file.
///
/// @param data_dir  base of relative record paths; the file's folder if empty
/// @param root      no file outside this folder is read, wherever links lead; empty: no restriction
/// @throws InputError  file:line:column with the key, what was found and what was expected; an
///                     unknown key names the nearest known one; a file outside `root`
Campaign load_campaign(const std::filesystem::path& file,
                       const std::filesystem::path& data_dir = {},
                       const std::filesystem::path& root = {});

/// Changes a value as `--set name="value unit"` does (a fitted parameter stays fitted, from there).
/// @throws UsageError  unknown name, wrong unit, value outside the parameter's limits or bounds, or
///                     of no effect because every condition has its own
void set_value(Campaign& campaign, std::string_view assignment);

/// Makes exactly these parameters free, as `--free a,b` does. Bounds that the campaign does not
/// give are value/10 to 10 value within the parameter's limits (its limits where the value is 0).
/// @throws UsageError  unknown name, or a parameter that cannot be fitted
void set_free(Campaign& campaign, const std::vector<std::string>& names);

/// Checks that the values are consistent. Call it after the last set_value() and set_free(), since
/// one of them alone may leave a pair incomplete.
/// @throws UsageError  names the condition, and what is missing or contradictory
void check_values(const Campaign& campaign);

/// What a condition lacks for a comparison with the model, in words: parameters without a value, an
/// unknown drive, time or unit, no output channel. Empty if it lacks nothing. load_campaign()
/// already refuses conditions of use `fit` and `validate` that lack something other than a unit.
std::vector<std::string> lacks_for_model(const Campaign& campaign, const Condition& condition);

/// Values in a condition: those of the rig, replaced by those of its leak level and its own.
model::ParameterValues values_in(const Campaign& campaign, const Condition& condition);

/// One repeat of a condition: a file and the column of each channel.
struct RepeatSource {
  std::filesystem::path path;
  std::string label;  ///< file name as in the campaign, with the column number if any
  std::map<Channel, std::string> columns;
};

/// Files of a condition, patterns expanded and sorted by name.
/// @throws InputError  a pattern matches no file (names the searched folder); a file is outside the
///                     campaign's root
std::vector<RepeatSource> repeat_sources(const Campaign& campaign, const Condition& condition);

/// Inputs of the model in a condition.
/// @param record  needed for a recorded waveform; may be null otherwise
model::SimulationInputs inputs_of(const Campaign& campaign, const Condition& condition,
                                  const model::ParameterValues& values, const Record* record);

/// Sample times of a condition: of its record, or from its duration and sample rate.
/// @throws InputError  neither is there
std::vector<double> sample_times(const Condition& condition, const Record* record);

/// The campaign file with known values in place of starts, as in `fitted.toml`. `values` are (table
/// index, level or condition or empty for the rig, SI value). Nuisance parameters stay free. A
/// start is removed if every condition has a value of its own. Changes by --set and --free are
/// included. Relative record paths are rewritten to be valid from `out_dir`. Comments of the file
/// are lost, its order is kept.
///
/// @throws InputError             the campaign file has disappeared or has become invalid
/// @throws std::invalid_argument  a value for an unknown condition
struct FittedValue {
  int index = 0;
  Scope scope = Scope::rig;
  std::string level;
  double value = 0.0;
};
std::string fitted_campaign_text(const Campaign& campaign, const std::vector<FittedValue>& values,
                                 const std::filesystem::path& out_dir);

/// The campaign file for the records of a designed test: its one condition in place of all others,
/// with the recorded drive, a file for each planned repeat, and the planned noise where the
/// campaign states none. Changes by --set and --free are included.
///
/// @param noise_sd  of a sample of one repeat, by channel, SI
/// @throws InputError  as fitted_campaign_text()
std::string designed_campaign_text(const Campaign& campaign, const DesignSettings& design,
                                   DriveFamily family, const std::map<Channel, double>& noise_sd);

}  // namespace rigcal::datasets
