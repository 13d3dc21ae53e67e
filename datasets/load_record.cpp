#include "datasets/load_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "common/parallel.hpp"
#include "datasets/average.hpp"
#include "datasets/load_csv.hpp"

namespace rigcal::datasets {
namespace {

AverageOptions options_of(const Campaign& campaign, const Condition& condition) {
  AverageOptions options;
  options.align = campaign.alignment == Alignment::correlate;
  options.repeats_averaged = condition.averaged ? condition.repeats_averaged : 1;
  for (const auto& [channel, setting] : campaign.channels)
    if (setting.sd) options.known_sd[channel] = *setting.sd;
  return options;
}

}  // namespace

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
  CsvRequest request;
  request.separator = campaign.separator;
  request.time_column = campaign.time_column;
  request.columns.push_back(campaign.time_column);
  for (const auto& [channel, column] : source.columns) request.columns.push_back(column);
  const CsvTable table = load_csv(source.path, request);

  const auto converted = [&](std::size_t column, const UnitConversion& to_si) {
    std::vector<double> values = table.columns[column];
    std::transform(values.begin(), values.end(), values.begin(), to_si);
    return values;
  };
  Repeat repeat;
  repeat.source = source.label;
  repeat.time_s = converted(0, campaign.time_to_s);
  std::size_t column = 1;
  for (const auto& [channel, name] : source.columns)
    repeat.values[channel] = converted(column++, campaign.channels.at(channel).to_si);
  return repeat;
}

Record load_record(const Campaign& campaign, const Condition& condition) {
  std::vector<Repeat> repeats;
  std::vector<std::string> files;
  for (const RepeatSource& source : repeat_sources(campaign, condition)) {
    repeats.push_back(load_repeat(campaign, source));
    const std::string file = source.path.string();
    if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
  }
  if (repeats.empty())
    throw InputError(condition.where, fmt::format("condition \"{}\" has no record: expected "
                                                  "repeats or averaged",
                                                  condition.id));
  try {
    Record record = average(condition.id, repeats, options_of(campaign, condition));
    record.files = std::move(files);
    return record;
  } catch (const std::invalid_argument& error) {
    throw InputError(condition.where,
                     fmt::format("condition \"{}\": {}", condition.id, error.what()));
  }
}

std::vector<Record> load_records(const Campaign& campaign, const std::vector<Use>& uses,
                                 int threads) {
  std::vector<const Condition*> wanted;
  for (const Condition& condition : campaign.conditions)
    if (std::find(uses.begin(), uses.end(), condition.use) != uses.end())
      wanted.push_back(&condition);
  std::vector<Record> records(wanted.size());
  parallel_for(wanted.size(), threads,
               [&](std::size_t i) { records[i] = load_record(campaign, *wanted[i]); });
  return records;
}

}  // namespace rigcal::datasets
