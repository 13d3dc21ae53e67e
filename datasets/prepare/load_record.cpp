#include "datasets/prepare/load_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <system_error>

#include "common/parallel.hpp"
#include "datasets/campaign/campaign_parameters.hpp"
#include "datasets/campaign/reading_root.hpp"
#include "datasets/checks/record_checks.hpp"
#include "datasets/checks/sensor_warnings.hpp"
#include "datasets/checks/short_records.hpp"
#include "datasets/checks/swapped_chambers.hpp"
#include "datasets/prepare/average.hpp"
#include "datasets/prepare/bridged_holes.hpp"
#include "datasets/prepare/condition_repeats.hpp"
#include "datasets/prepare/moving_windows.hpp"
#include "datasets/prepare/recognised_drive.hpp"
#include "datasets/prepare/stated_units.hpp"
#include "datasets/prepare/time_holes.hpp"
#include "datasets/read/record_reader.hpp"

namespace rigcal::datasets {
namespace {

AverageOptions options_of(const Campaign& campaign, const Condition& condition) {
  AverageOptions options;
  options.align = campaign.alignment == Alignment::correlate;
  if (condition.frequency_hz && !condition.end_frequency_hz)
    options.drive_hz = *condition.frequency_hz;
  options.repeats_averaged = condition.averaged ? condition.repeats_averaged : 1;
  for (const auto& [channel, setting] : campaign.channels)
    if (setting.sd) options.known_sd[channel] = *setting.sd;
  return options;
}

[[noreturn]] void refuse(const Condition& condition, const std::string& message) {
  throw InputError(condition.where, fmt::format("condition \"{}\": {}", condition.id, message));
}

/// Whether error messages may quote a file. A campaign may name any file, so content is shown only
/// if the file is in a folder that the user chose, or if it has the name of a recording after all
/// links are resolved.
bool may_be_shown(const Campaign& campaign, const std::filesystem::path& path) {
  std::error_code error;
  if (has_record_name(std::filesystem::weakly_canonical(path, error)) && !error) return true;
  return lies_within(campaign.data_dir, path) || lies_within(campaign.file.parent_path(), path) ||
         (!campaign.root.empty() && lies_within(campaign.root, path));
}

/// Reads columns from a file of any format; the first one is the time. Adds doubts about the file
/// to the repeat.
RecordTable read_columns(const Campaign& campaign, const std::filesystem::path& path,
                         const std::vector<std::string>& names, Repeat& repeat) {
  try {
    RecordTable table =
        record_reader(path).load(path, {names, campaign.time_column, campaign.separator});
    if (!table.warning.empty()) repeat.warnings.push_back(table.warning);
    table.labels.resize(names.size());
    for (std::size_t i = 0; i < names.size(); ++i)
      if (table.labels[i].name.empty()) table.labels[i].name = names[i];
    return table;
  } catch (const InputError& error) {
    if (may_be_shown(campaign, path)) throw;
    throw InputError(
        error.where(),
        "is not a recording that this campaign describes. The content of the file is not shown, "
        "because it is neither in the campaign's folder nor in that of --data and is not named "
        "like a recording; expected a recording (`rigcal init` and its name may help)");
  }
}

/// Rejects values above 1e100, whose squares could overflow when summed. Corrupt files contain such
/// numbers.
void require_measurable(const RepeatSource& source, const std::string& column,
                        const std::vector<double>& values) {
  constexpr double kLargest = 1e100;
  const auto bad = std::find_if(values.begin(), values.end(),
                                [](double value) { return !(std::abs(value) <= kLargest); });
  if (bad != values.end())
    throw InputError({source.path.string()},
                     fmt::format("number {} of '{}' is {:g} in SI units, more than any sensor can "
                                 "measure; expected at most {:g}",
                                 bad - values.begin() + 1, column, *bad, kLargest));
}

/// Whether a term of the campaign depends on the drive before the first sample.
bool delays_its_drive(const Campaign& campaign) {
  return std::any_of(
      campaign.parameters.begin(), campaign.parameters.end(), [&](const ParameterSetting& setting) {
        const auto key = model::parameter_spec(campaign.rig.plant, setting.index).key;
        return key == "transport_delay" || key == "valve_time_constant" || key == "valve_frequency";
      });
}

/// Finds the windows for `windows = "moving"`.
void find_moving_windows(const Campaign& campaign, const Condition& condition, Record& record) {
  const Channel moving = motion_channel(campaign);
  const auto position = record.channels.find(moving);
  if (position == record.channels.end())
    refuse(condition,
           fmt::format("windows = \"moving\" are found from the {0}, which its records do not "
                       "contain: expected a channel {0}, or window = [\"0.5 s\", \"12 s\"]",
                       info(moving).key));
  const Series& x = position->second;
  const auto motions =
      find_motions(record.time_s, drive_at_samples(campaign, condition, record), x.mean, x.sd);
  if (motions.empty())
    refuse(condition,
           fmt::format("windows = \"moving\": no step of the {} moves the piston in its record; "
                       "expected a command of steps, or window = [\"0.5 s\", \"12 "
                       "s\"]",
                       info(drive_channel(campaign)).key));
  const bool turns = moving == Channel::angle;
  const double per_unit = turns ? 180.0 / std::numbers::pi : 1e3;
  const char* unit = turns ? "deg" : "mm";
  for (const Motion& motion : motions) {
    record.windows.push_back(motion.window);
    record.notes.push_back(fmt::format(
        "moving window {}: {:.6g} s to {:.6g} s, {:.5g} {} to {:.5g} {}, {}", record.windows.size(),
        motion.window.start_s, motion.window.end_s, per_unit * motion.from_m, unit,
        per_unit * motion.to_m, unit,
        motion.arrived
            ? fmt::format("ends {:.3g} {} before the stop", per_unit * motion.margin_m, unit)
            : "still moving at its end"));
  }
}

}  // namespace

std::vector<FileState> files_of(const Campaign& campaign, const Condition& condition) {
  std::vector<FileState> files;
  for (const RepeatSource& source : repeat_sources(campaign, condition)) {
    const FileState file = state_of_file(source.path);
    if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
  }
  return files;
}

Repeat load_repeat(const Campaign& campaign, const RepeatSource& source) {
  if (campaign.time_column.empty())
    throw InputError(
        {campaign.file.string()},
        "recording.channels.time is missing: expected the column and unit of the time");
  if (source.columns.empty())
    throw InputError({campaign.file.string()},
                     fmt::format("no channel of '{}' is declared; expected at least one, such as "
                                 "recording.channels.position",
                                 source.label));
  std::vector<std::string> names{campaign.time_column};
  for (const auto& [channel, column] : source.columns) names.push_back(column);
  // A column that a repeat names itself has no `minus`.
  const auto minus_of = [&](Channel channel, const std::string& column) {
    const ChannelSetting& setting = campaign.channels.at(channel);
    return column == setting.column ? setting.minus : std::string();
  };
  for (const auto& [channel, column] : source.columns)
    if (const auto minus = minus_of(channel, column); !minus.empty()) names.push_back(minus);
  Repeat repeat;
  repeat.source = source.label;
  RecordTable table = read_columns(campaign, source.path, names, repeat);
  std::vector<std::vector<double>>& columns = table.columns;
  const auto require_unit = [&](std::size_t index, const StatedUnit& stated,
                                const std::string& key) {
    require_stated_unit(stated, key, source.path, table.labels[index]);
  };

  const auto converted = [&](std::size_t column, const std::string& name,
                             const UnitConversion& to_si) {
    std::vector<double> values = std::move(columns[column]);
    std::transform(values.begin(), values.end(), values.begin(), to_si);
    require_measurable(source, name, values);
    return values;
  };
  require_unit(0, campaign.stated_time, "time");
  repeat.time_s = converted(0, campaign.time_column, campaign.time_to_s);
  if (!campaign.time_in_counts) repeat.holes = time_holes(repeat.time_s);
  std::size_t column = 1;
  std::size_t minus = 1 + source.columns.size();
  for (const auto& [channel, name] : source.columns) {
    const ChannelSetting& setting = campaign.channels.at(channel);
    const std::string key(info(channel).key);
    require_unit(column, setting.stated, key);
    if (!minus_of(channel, name).empty()) {
      require_unit(minus, setting.stated, key);
      const std::vector<double>& taken_off = columns[minus++];
      std::transform(columns[column].begin(), columns[column].end(), taken_off.begin(),
                     columns[column].begin(), std::minus<>());
    }
    repeat.values[channel] = converted(column++, name, setting.to_si);
  }
  bridge_holes(campaign, repeat);
  return repeat;
}

std::vector<Repeat> load_all_repeats(const Campaign& campaign, const Condition& condition) {
  std::vector<Repeat> repeats;
  for (const RepeatSource& source : repeat_sources(campaign, condition))
    repeats.push_back(load_repeat(campaign, source));
  if (repeats.empty()) refuse(condition, "has no record: expected repeats or averaged");
  return repeats;
}

namespace {

/// Returns the average without outliers, and removes these from `repeats`, too. Returns `all` if
/// there are no outliers, or if fewer than two repeats would be left.
Record without_outliers(const Condition& condition, std::vector<Repeat>& repeats,
                        const AverageOptions& options, const Record& all) {
  const auto is_outlier = [](const RepeatReport& each) { return each.outlier; };
  const auto outliers =
      std::count_if(all.repeat_reports.begin(), all.repeat_reports.end(), is_outlier);
  if (outliers == 0 || all.repeats - outliers < 2) return all;
  std::vector<Repeat> kept;
  for (std::size_t r = 0; r < repeats.size(); ++r)
    if (!all.repeat_reports[r].outlier) kept.push_back(std::move(repeats[r]));
  repeats = std::move(kept);
  std::vector<std::string> reworded;
  for (const std::string& warning : all.warnings)
    if (warning.ends_with(kStaysInMean))
      reworded.push_back(warning.substr(0, warning.size() - kStaysInMean.size()) +
                         "it is left out, as outliers in [averaging] specifies");
  Record record = average(condition.id, repeats, options);
  record.warnings.insert(record.warnings.begin(), reworded.begin(), reworded.end());
  return record;
}

}  // namespace

Record average_of(const Campaign& campaign, const Condition& condition,
                  std::vector<Repeat>& repeats, bool keep_deviations) {
  try {
    const auto faults = sensor_faults(campaign, condition, repeats);
    std::vector<std::string> seen;
    for (const Repeat& repeat : repeats)
      seen.insert(seen.end(), repeat.warnings.begin(), repeat.warnings.end());
    const Conditioning done = condition_repeats(campaign, repeats);
    AverageOptions options = options_of(campaign, condition);
    options.keep_deviations = keep_deviations;
    for (auto& [channel, sd] : options.known_sd) sd *= done.noise_gain;
    Record record = average(condition.id, repeats, options);
    if (campaign.leave_out_outliers) record = without_outliers(condition, repeats, options, record);
    record.notes = bridged_notes(repeats);
    record.notes.insert(record.notes.end(), done.notes.begin(), done.notes.end());
    seen.insert(seen.end(), done.warnings.begin(), done.warnings.end());
    record.warnings.insert(record.warnings.end(), seen.begin(), seen.end());
    recognise_drive(campaign, condition, record);
    record.windows = condition.windows;
    if (condition.moving_windows) find_moving_windows(campaign, condition, record);
    record.holes = holes_in_what_counts(campaign, condition, repeats, record.windows);
    record.warnings.insert(record.warnings.end(), record.holes.begin(), record.holes.end());
    const std::string mirrored = mirrored_motion_warning(campaign, condition, record);
    for (const std::string& warning :
         {drive_sampling_warning(condition, record), travel_warning(campaign, condition, record),
          stated_drive_warning(campaign, condition, record), mirrored,
          mirrored.empty() ? swapped_chambers_warning(campaign, record) : std::string(),
          guessed_drive_warning(campaign, condition, record)})
      if (!warning.empty()) record.warnings.push_back(warning);
    if (auto proposal = drive_start_proposal(campaign, condition, record); !proposal.empty())
      (delays_its_drive(campaign) ? record.warnings : record.notes).push_back(std::move(proposal));
    const auto stuck = sensor_warnings(faults, record.windows);
    record.warnings.insert(record.warnings.end(), stuck.begin(), stuck.end());
    return record;
  } catch (const std::invalid_argument& error) {
    refuse(condition, error.what());
  }
}

Record load_record(const Campaign& campaign, const Condition& condition, bool keep_deviations) {
  std::vector<FileState> files = files_of(campaign, condition);
  std::vector<Repeat> repeats = load_all_repeats(campaign, condition);
  Record record = average_of(campaign, condition, repeats, keep_deviations);
  record.files = std::move(files);
  return record;
}

std::vector<Record> load_records(const Campaign& campaign, const std::vector<Use>& uses,
                                 int threads, bool keep_deviations) {
  std::vector<const Condition*> wanted;
  for (const Condition& condition : campaign.conditions)
    if (std::find(uses.begin(), uses.end(), condition.use) != uses.end())
      wanted.push_back(&condition);
  std::vector<Record> records(wanted.size());
  parallel_for(wanted.size(), threads, [&](std::size_t i) {
    records[i] = load_record(campaign, *wanted[i], keep_deviations);
    require_no_holes(campaign, records[i]);
  });
  std::vector<Record*> all;
  for (Record& record : records) all.push_back(&record);
  warn_of_short_records(campaign, all);
  return records;
}

void drop_deviations(std::vector<Record>& records) {
  for (Record& record : records)
    for (auto& [channel, series] : record.channels) series.deviations = {};
}

}  // namespace rigcal::datasets
