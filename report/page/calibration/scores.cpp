#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "report/document/quantity.hpp"
#include "report/document/words.hpp"
#include "report/page/calibration/fit_sections.hpp"
#include "report/page/calibration/shown_part.hpp"
#include "report/page/page_parts.hpp"

namespace rigcal::report {
namespace {

using doc::Line;
using Kind = doc::Column::Kind;

/// Returns the frequency to sort by, and a name such as "sine 0.1 Hz".
std::pair<double, std::string> signal_of(const calib::ConditionResult& condition) {
  const std::string waveform =
      condition.waveform ? std::string(to_string(*condition.waveform)) : std::string();
  const std::optional<double>& frequency = condition.frequency_hz;
  if (!frequency) return {0.0, waveform};
  return {*frequency, fmt::format("{} {:.6g} Hz", waveform, *frequency)};
}

std::string level_of(const calib::ConditionResult& condition) {
  return condition.leak_level.value_or("");
}

/// Returns, for example, "rho2 0.99 (warning at 0.995), ccc 0.99"; empty if the channel has no
/// limits.
std::string limits_text(const std::vector<datasets::AcceptanceLimit>& limits,
                        const std::string& channel) {
  std::string text;
  for (const datasets::AcceptanceLimit& limit : limits) {
    if (info(limit.channel).key != channel) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", limit.metric,
                        doc::in_unit(limit.limit, 1.0, 6).text);
    if (limit.warn) text += fmt::format(" (warning at {})", doc::in_unit(limit.warn, 1.0, 6).text);
  }
  return text;
}

/// Returns the caption for a channel. It states the limits, including those that single conditions
/// have instead.
Line caption_of(const StoredFit& fit, const std::string& channel) {
  const std::string limits = limits_text(fit.acceptance, channel);
  std::string rest =
      limits.empty() ? std::string(" – no limits, not judged") : " – limits: " + limits;
  for (const calib::ConditionResult& condition : fit.conditions) {
    if (!condition.acceptance) continue;
    const std::string own = limits_text(*condition.acceptance, channel);
    rest += fmt::format("; {}: {}", condition.id,
                        own.empty() ? "not judged" : "limits of its own: " + own);
  }
  return {spaced(channel), doc::Soft{rest}};
}

/// Returns the tile of a condition, or std::nullopt if the channel is not compared in that
/// condition.
std::optional<doc::Tile> tile_of(const calib::ConditionResult& condition,
                                 const std::string& channel) {
  const calib::ChannelScore* score = condition.find(channel);
  if (score == nullptr && !condition.failure) return std::nullopt;
  doc::Tile tile{doc::badge(condition.verdict_of(channel)), {}};
  tile.to = "#" + anchor(condition.id);
  tile.title = condition.id;
  if (condition.failure) {
    tile.line = {"not simulated"};
    return tile;
  }
  tile.line = {doc::agreement(score->metrics.rho2)};
  tile.below = {{doc::in_unit(score->metrics.absolute_error_percent, 1.0, 3),
                 fmt::format(" % · {}", to_string(condition.use))}};
  return tile;
}

/// Returns one tile for many conditions in a cell, with the number of each verdict and the worst
/// condition.
doc::Tile summary_of(const std::vector<const calib::ConditionResult*>& conditions,
                     const std::string& channel) {
  std::map<std::optional<calib::Verdict>, std::size_t> counts;
  const calib::ConditionResult* worst = conditions.front();
  for (const calib::ConditionResult* condition : conditions) {
    ++counts[condition->verdict_of(channel)];
    if (badness(*worst, channel) < badness(*condition, channel)) worst = condition;
  }
  doc::Tile tile = *tile_of(*worst, channel);
  std::string numbers;
  for (const auto& [verdict, count] : counts)
    numbers +=
        fmt::format("{}{} {}", numbers.empty() ? "" : ", ", count, doc::badge(verdict).words);
  tile.below = {{numbers}, {"the worst: " + worst->id}};
  return tile;
}

/// A cell with more conditions shows their number, the worst one, and as many pictures.
constexpr std::size_t kMostTiles = 8;

/// Small pictures of the channel of the motion, by condition.
using Pictures = std::map<const calib::ConditionResult*, Plot>;

Pictures pictures_of(const Calibration& stored, const std::string& channel) {
  const std::vector<calib::ConditionResult>& conditions = stored.result.conditions;
  Pictures pictures;
  if (channel.empty()) return pictures;
  for (const std::size_t i : shown_in_full(conditions)) {
    if (auto picture = condition_picture(stored, i, channel))
      pictures.emplace(&conditions[i], std::move(*picture));
  }
  return pictures;
}

/// Returns the tiles of a cell, each with its picture.
std::vector<doc::Tile> tiles_of(const std::vector<const calib::ConditionResult*>& conditions,
                                const std::string& channel, const Pictures& pictures) {
  std::vector<doc::Tile> tiles;
  const bool is_summary = conditions.size() > kMostTiles;
  if (is_summary) tiles.push_back(summary_of(conditions, channel));
  for (const calib::ConditionResult* condition : conditions) {
    const auto picture = pictures.find(condition);
    if (is_summary && (picture == pictures.end() || tiles.size() > kMostTiles)) continue;
    doc::Tile tile = *tile_of(*condition, channel);
    if (conditions.size() > 1) tile.below.push_back({tile.title});
    if (picture != pictures.end()) tile.picture = picture->second;
    tiles.push_back(std::move(tile));
  }
  return tiles;
}

/// Returns a table for each channel, with signals in rows and leak levels in columns.
std::vector<doc::Table> matrices(const Calibration& stored) {
  const StoredFit& fit = stored.result;
  const std::string motion = shown_channel(fit.conditions);
  const Pictures pictures = pictures_of(stored, motion);
  std::vector<std::string> channels;
  std::map<std::pair<double, std::string>,
           std::map<std::string, std::vector<const calib::ConditionResult*>>>
      by_signal;
  std::vector<std::string> levels;
  const auto remember = [](auto& list, const auto& item) {
    if (std::find(list.begin(), list.end(), item) == list.end()) list.push_back(item);
  };
  for (const calib::ConditionResult& condition : fit.conditions) {
    for (const calib::ChannelScore& score : condition.channels)
      remember(channels, std::string(score.key()));
    remember(levels, level_of(condition));
    by_signal[signal_of(condition)][level_of(condition)].push_back(&condition);
  }
  if (channels.empty() && !by_signal.empty()) channels.emplace_back("position");
  std::vector<doc::Table> tables;
  for (const std::string& channel : channels) {
    doc::Table table{"Scores of " + channel};
    table.caption = caption_of(fit, channel);
    table.shape = doc::Table::Shape::matrix;
    if (levels.size() == 1) table.style = "flow";
    table.columns = {{"Signal"}};
    for (const std::string& level : levels)
      table.columns.push_back({level.empty() ? "no leak level" : "leak " + level});
    for (const auto& [signal, by_level] : by_signal) {
      doc::Row row{{signal.second}};
      for (const std::string& level : levels) {
        doc::Cell& cell = row.cells.emplace_back();
        const auto found = by_level.find(level);
        if (found == by_level.end()) continue;
        std::vector<const calib::ConditionResult*> compared;
        for (const calib::ConditionResult* condition : found->second)
          if (tile_of(*condition, channel)) compared.push_back(condition);
        cell.tiles = tiles_of(compared, channel, channel == motion ? pictures : Pictures());
      }
      table.rows.push_back(std::move(row));
    }
    tables.push_back(std::move(table));
  }
  return tables;
}

doc::Table means_table(const StoredFit& fit) {
  doc::Table table{"Means by group"};
  table.heading = 1;
  table.columns = {{"By"},
                   {"Group"},
                   {"Channel"},
                   {"Conditions", Kind::number},
                   {"Mean rho2", Kind::number},
                   {"Mean ccc", Kind::number},
                   {"Mean error %", Kind::number},
                   {"Worst rho2", Kind::number},
                   {"Worst error %", Kind::number}};
  for (const calib::Group& group : fit.groups) {
    for (const auto& [channel, scores] : group.metrics) {
      table.rows.push_back({{spaced(group.by), group.label, std::string(info(channel).key),
                             fmt::format("{}", scores.conditions), doc::agreement(scores.mean.rho2),
                             doc::agreement(scores.mean.ccc),
                             doc::in_unit(scores.mean.absolute_error_percent, 1.0, 3),
                             doc::agreement(scores.worst.rho2),
                             doc::in_unit(scores.worst.absolute_error_percent, 1.0, 3)}});
    }
  }
  return table;
}

}  // namespace

doc::Section scores_section(const Calibration& stored, bool unfinished) {
  const StoredFit& fit = stored.result;
  doc::Section section{"matrix", "Scores"};
  if (unfinished)
    section.blocks.emplace_back(doc::Paragraph{
        {"Stopped before it converged: these are scores of the best values so far, not of a "
         "calibration."},
        doc::Paragraph::Tone::problem});
  std::vector<doc::Table> tables = matrices(stored);
  if (tables.empty()) {
    section.blocks.emplace_back(doc::reading("Nothing was scored."));
    return section;
  }
  section.blocks.emplace_back(three_numbers(fit));
  section.blocks.emplace_back(doc::reading(
      "Agreement of model and measured mean: rho2 (1 is perfect) and, below it, the mean absolute "
      "error in percent of the range."));
  section.blocks.emplace_back(doc::about_picture(
      "The pictures show the last two periods, or the whole record of a recorded drive: measured "
      "(dark, wide) and simulated (orange). Each cell links to its condition."));
  for (doc::Table& table : tables) section.blocks.emplace_back(std::move(table));
  doc::Table groups = means_table(fit);
  const std::string summary = fmt::format(
      "Means by use, signal, frequency, waveform and leak level ({})", groups.rows.size());
  section.blocks.emplace_back(doc::Fold{summary, {std::move(groups)}});
  add_rig_response(stored, section.blocks);
  return section;
}

}  // namespace rigcal::report
