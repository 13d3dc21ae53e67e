#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/error.hpp"
#include "datasets/campaign/campaign.hpp"

namespace rigcal::datasets {

class TomlNode;  // toml_reader.hpp, whose package takes long to compile

/// A coefficient as a publication prints it.
struct PrintedCoefficient {
  double value = 0.0;
  double half_digit = 0.0;  ///< half a unit of the last printed digit
  std::string note;         ///< remark about this entry; empty: none
};

/// One column of a leak table: a periodic drive and the published numbers for it.
struct LeakSignal {
  Waveform waveform = Waveform::sine;  ///< sine or square
  double frequency_hz = 0.0;
  double amplitude = 0.0;                        ///< [m], or [V] where no controller is in the loop
  std::map<double, PrintedCoefficient> printed;  ///< by target share [percent]
  std::optional<PrintedCoefficient> normal;      ///< coefficient of the rig without a fault

  /// "sine_0.1Hz"
  std::string name() const;
};

/// Columns of a published table of flows and residual features.
enum class Feature { servo_flow, leak_flow, mean, rms, std };
std::string_view to_string(Feature feature);

/// One row of it. Flows in m3/s, features in the unit that was printed.
struct PrintedFeatures {
  std::string level;
  double coefficient = 0.0;
  bool leaking = true;  ///< false: the rig without a fault
  std::map<Feature, double> printed;
  std::vector<Feature> left_out;  ///< left out of a fit, because of `reason`
  std::string reason;
};

/// A value that the table rests on, and where it comes from.
struct Assumption {
  int index = 0;       ///< row of the parameter table, or kResidualScale
  double value = 0.0;  ///< SI
  std::string source;
  bool fit = false;    ///< `fit-tables` estimates it, from `start` within the bounds
  double start = 0.0;  ///< SI, as the bounds
  double lower = 0.0;
  double upper = 0.0;
  bool fitted = false;  ///< the value is that of an earlier fit to records
};

/// Index of the factor from metres to the unit of the printed features [1/m]: no parameter of the
/// rig, but unstated and so assumed like one.
inline constexpr int kResidualScale = -1;

/// Row of an assumption: that of the parameter table, or of the residual scale.
const model::ParameterSpec& assumption_spec(model::PlantKind plant, int index);

/// [leak_table]: settings of `leak-table` and `fit-tables`, and the published numbers.
struct LeakTableSettings {
  std::vector<double> targets_percent{10.0, 20.0, 30.0, 50.0};  ///< fractions of the servo flow
  double lowest_coefficient = 1e-3;                             ///< roots are searched from here
  double highest_coefficient = 100.0;                           ///< end of the range
  std::vector<LeakSignal> signals;
  std::optional<LeakSignal> feature_signal;
  std::vector<PrintedFeatures> features;
  std::vector<Assumption> assumptions;

  const Assumption* assumption(int index) const;
};

struct CampaignKey;

/// Keys of [leak_table].
const std::vector<CampaignKey>& leak_table_keys();

/// Reads the section.
///
/// @throws InputError  file:line:column with the key, what was found and what was expected
LeakTableSettings read_leak_table(const TomlNode& node, const Campaign& campaign);

/// Reads the section of a campaign's file. Without signals in it: the sines and squares of the
/// campaign's conditions, each once.
///
/// @throws InputError  the file has disappeared or is invalid, or there are no signals
LeakTableSettings leak_table_settings(const Campaign& campaign);

/// Parses "sine@0.1Hz" or "sine@0.1Hz@50mm" as a signal. Published numbers of the same signal in
/// `settings` are kept. Without an amplitude it takes that of the settings' signals, if they all
/// have one.
///
/// @throws UsageError  what was found and what was expected
LeakSignal signal_from_text(const Campaign& campaign, const LeakTableSettings& settings,
                            std::string_view text);

/// Applies --set: the assumption of that name takes the campaign's value, or that of the assignment
/// itself for "residual_scale=39.37 1/m", which is no parameter of the campaign.
///
/// @throws UsageError  the residual scale is no number per metre above zero
void override_assumption(LeakTableSettings& settings, const Campaign& campaign,
                         std::string_view assignment);

/// Replaces assumptions by the values that an earlier fit estimated; their source says what they
/// replace. Values that the fit did not estimate stay. A leakage coefficient is skipped, since the
/// table varies it.
///
/// @throws InputError  a value was fitted per leak level or condition, so that the rig has no
///                     single one, and no assumption gives it
void take_fitted(LeakTableSettings& settings, const Campaign& campaign,
                 const std::vector<FittedValue>& fitted);

/// Applies --free: `fit-tables` estimates exactly these. Bounds that the section does not give are
/// value/10 to 10 value.
///
/// @throws UsageError  unknown name, or one that cannot be estimated
void free_assumptions(LeakTableSettings& settings, const Campaign& campaign,
                      const std::vector<std::string>& names);

/// Puts the values of the assumptions over those of the rig.
///
/// @throws InputError  a parameter of the plant has no value
model::ParameterValues leak_table_values(const Campaign& campaign,
                                         const LeakTableSettings& settings);

/// The campaign file with these assumptions in [leak_table.assumptions]: the `fitted.toml` of
/// `fit-tables`. Comments are lost; record paths are rewritten to be valid from `out_dir`.
///
/// @throws InputError  the campaign file has disappeared or has become invalid
std::string fitted_leak_table_text(const Campaign& campaign, const LeakTableSettings& settings,
                                   const std::filesystem::path& out_dir);

}  // namespace rigcal::datasets
