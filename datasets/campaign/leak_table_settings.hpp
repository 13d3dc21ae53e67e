#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/describe.hpp"
#include "common/error.hpp"
#include "datasets/campaign/campaign.hpp"

namespace rigcal::datasets {

class TomlNode;  // not included: toml_reader.hpp takes long to compile

/// A coefficient as printed in a publication.
struct PrintedCoefficient {
  double value = 0.0;
  double half_digit = 0.0;  ///< half a unit in the last printed digit
  std::string note;         ///< remark about this entry; empty: none
};

/// One column of a leak table: a periodic drive and the published numbers for it.
struct LeakSignal {
  Waveform waveform = Waveform::sine;  ///< sine or square
  double frequency_hz = 0.0;
  double amplitude = 0.0;                        ///< [m], or [V] without a controller
  std::map<double, PrintedCoefficient> printed;  ///< by target share [percent]
  std::optional<PrintedCoefficient> normal;      ///< coefficient for the rig without a fault

  /// Returns the name of the signal, such as "sine_0.1Hz".
  std::string name() const;
};

/// Columns in a published table of flows and residual features.
enum class Feature { servo_flow, leak_flow, mean, rms, std };
RIGCAL_NAMES(Feature, servo_flow, leak_flow, mean, rms, std)

/// One row of a published table of features. Flows in m3/s, features in the printed unit.
struct PrintedFeatures {
  std::string level;
  double coefficient = 0.0;
  bool leaking = true;  ///< false: the rig without a fault
  std::map<Feature, double> printed;
  std::vector<Feature> left_out;  ///< features excluded from a fit, for `reason`
  std::string reason;
};

/// A value that the leak table is based on, with its source.
struct Assumption {
  int index = 0;       ///< row of the parameter table, or kResidualScale
  double value = 0.0;  ///< SI
  std::string source;
  bool fit = false;    ///< `fit-tables` estimates the value, from `start`, within the bounds
  double start = 0.0;  ///< SI, like the bounds
  double lower = 0.0;
  double upper = 0.0;
  bool fitted = false;  ///< the value comes from an earlier fit to records
};

/// Index for the factor from metres to the unit of the printed features [1/m]. It is not a
/// parameter of the rig, but publications do not state it, so it is assumed like one.
inline constexpr int kResidualScale = -1;

/// Returns the specification of an assumption: a row of the parameter table, or the specification
/// of the residual scale.
const model::ParameterSpec& assumption_spec(model::PlantKind plant, int index);

/// [leak_table]: settings for `leak-table` and `fit-tables`, and the published numbers.
struct LeakTableSettings {
  std::vector<double> targets_percent{10.0, 20.0, 30.0, 50.0};  ///< leak shares
  double lowest_coefficient = 1e-3;                             ///< lower end of the root search
  double highest_coefficient = 100.0;                           ///< upper end of the root search
  std::vector<LeakSignal> signals;
  std::optional<LeakSignal> feature_signal;
  std::vector<PrintedFeatures> features;
  std::vector<Assumption> assumptions;

  const Assumption* assumption(int index) const;
};

struct CampaignKey;

const std::vector<CampaignKey>& leak_table_keys();

/// Reads the section [leak_table].
///
/// @throws InputError  if the section is invalid; names file:line:column, the key, what was found
///                     and what was expected
LeakTableSettings read_leak_table(const TomlNode& node, const Campaign& campaign);

/// Reads [leak_table] from a campaign's file. If it has no signals, uses the sine and square waves
/// of the campaign's conditions, without duplicates.
///
/// @throws InputError  if the file has disappeared or is invalid, or there are no signals
LeakTableSettings leak_table_settings(const Campaign& campaign);

/// Parses a signal such as "sine@0.1Hz" or "sine@0.1Hz@50mm". Adopts the published numbers for the
/// same signal in `settings`. Without an amplitude, takes the common amplitude of the signals in
/// `settings`.
///
/// @throws UsageError  if the text is not a signal; says what was found and what was expected
LeakSignal signal_from_text(const Campaign& campaign, const LeakTableSettings& settings,
                            std::string_view text);

/// Applies --set to the assumption with that name. It takes the value that --set has given the
/// campaign. "residual_scale=39.37 1/m" is parsed here, since it is not a parameter in the
/// campaign.
///
/// @throws UsageError  if the residual scale is not a positive number in 1/m, or the value is
///                     outside the bounds of `fit-tables`
void override_assumption(LeakTableSettings& settings, const Campaign& campaign,
                         std::string_view assignment);

/// Replaces assumptions with values from an earlier fit. The `source` of each says what it
/// replaces. Assumptions that the fit did not estimate are kept. Skips the leakage coefficient,
/// since the table varies it.
///
/// @throws InputError  if a value was fitted per leak level or condition, so that there is no
///                     single value for the rig, and no assumption gives one
void take_fitted(LeakTableSettings& settings, const Campaign& campaign,
                 const std::vector<FittedValue>& fitted);

/// Applies --free: `fit-tables` estimates exactly these assumptions. Bounds default to value/10 and
/// 10 value.
///
/// @throws UsageError  if a name is unknown or cannot be estimated
void free_assumptions(LeakTableSettings& settings, const Campaign& campaign,
                      const std::vector<std::string>& names);

/// Returns the values of the rig after applying the assumptions.
///
/// @throws InputError  if a parameter of the plant has no value
model::ParameterValues leak_table_values(const Campaign& campaign,
                                         const LeakTableSettings& settings);

/// Writes the `fitted.toml` of `fit-tables`: the campaign file with these assumptions in
/// [leak_table.assumptions]. Comments are lost; record paths are rewritten to be valid from
/// `out_dir`.
///
/// @throws InputError  if the campaign file has disappeared or become invalid
std::string fitted_leak_table_text(const Campaign& campaign, const LeakTableSettings& settings,
                                   const std::filesystem::path& out_dir);

}  // namespace rigcal::datasets
