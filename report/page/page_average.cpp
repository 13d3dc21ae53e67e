#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "datasets/record.hpp"
#include "report/figure/decimate.hpp"
#include "report/figure/time_plots.hpp"
#include "report/page/page_parts.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

using Kind = doc::Column::Kind;

/// About one point per pixel of width.
constexpr std::size_t kAveragePoints = 600;

std::string offsets_text(const StoredRecord& record) {
  if (record.repeats < 2 || !record.offset_range_s) return "–";
  return fmt::format("{:.2g} ms", 1e3 * *record.offset_range_s);
}

bool is_measured(const std::string& channel) {
  const auto known = datasets::channel_from_key(channel);
  return known && datasets::info(*known).is_output;
}

void add_agreement_rows(const StoredRecord& record, doc::Table& table) {
  for (const auto& [channel, found] : record.channels) {
    if (!is_measured(channel)) continue;  // a command has no measurement error
    const std::optional<metrics::NoiseFloor>& noise_floor = found.noise_floor;
    const auto floor = [&](double metrics::NoiseFloor::*value) -> Number {
      return noise_floor ? std::optional((*noise_floor).*value) : std::nullopt;
    };
    table.rows.push_back(
        {{record.condition, channel, fmt::format("{}", record.samples),
          fmt::format("{}", found.repeats), doc::readable(found.pooled_sd, found.unit, 3),
          doc::readable(found.sd_of_mean, found.unit, 3),
          doc::agreement(floor(&metrics::NoiseFloor::rho2)),
          doc::in_unit(floor(&metrics::NoiseFloor::absolute_error_percent), 1.0, 3),
          offsets_text(record), fmt::format("{}", record.outliers())}});
  }
}

/// Collects a list of texts from all records, each with its condition.
std::vector<std::string> texts_of(const StoredAverage& average,
                                  std::vector<std::string> StoredRecord::*texts) {
  std::vector<std::string> list;
  for (const StoredRecord& record : average.records)
    for (const std::string& text : record.*texts)
      list.push_back(fmt::format("{}: {}", record.condition, text));
  return list;
}

}  // namespace

std::vector<Figure> average_figures(const std::string& condition, const Table& series) {
  std::vector<Figure> figures;
  const auto* time_s = series.find("time_s");
  if (time_s == nullptr || time_s->empty()) return figures;
  const Buckets thin = buckets(time_s->size(), kAveragePoints);
  for (const datasets::ChannelInfo& about : datasets::channel_table()) {
    const auto* mean = series.find(fmt::format("{}_mean", about.name));
    const auto* sd = series.find(fmt::format("{}_sd", about.name));
    if (mean == nullptr || !about.is_output) continue;
    std::string words(about.key);
    std::replace(words.begin(), words.end(), '_', ' ');
    const auto plot_of = [&](const std::string& title, const std::string& what, double size,
                             double& si) -> Plot {
      const ReadableUnit unit = readable_unit(size, about.unit);
      si = unit.si;
      return {title, "time [s]", fmt::format("{} [{}]", what, unit.name.empty() ? "1" : unit.name),
              620.0, 170.0};
    };
    double si = 1.0;
    Plot plot = plot_of(
        fmt::format("{} of {}, mean and standard deviation of its repeats", words, condition),
        words, largest(*mean), si);
    Trace line = empty_trace(Trace::Kind::line, "measured", "mean");
    line.x = thinned_times(*time_s, *mean, thin);
    line.y = thinned(*mean, thin);
    for (double& value : line.y) value /= si;
    const bool has_sd = sd != nullptr && largest(*sd) > 0.0;
    if (has_sd) {
      Trace band = empty_trace(Trace::Kind::band, "measured", "sd of repeats");
      band.x = line.x;
      const std::vector<double> half = thinned_where(*sd, *mean, thin);
      for (std::size_t i = 0; i < half.size(); ++i) {
        band.y.push_back(line.y[i] - half[i] / si);
        band.upper.push_back(line.y[i] + half[i] / si);
      }
      plot.traces.push_back(std::move(band));
    }
    plot.traces.push_back(std::move(line));
    figures.push_back({fmt::format("{}_{}_mean", condition, about.key), std::move(plot)});
    if (!has_sd) continue;
    Plot spread = plot_of(
        fmt::format("{} of {}, standard deviation of its repeats over time", words, condition),
        "sd of " + words, largest(*sd), si);
    spread.height = 130.0;
    Trace trace = empty_trace(Trace::Kind::line, "residual");
    // The sd varies from sample to sample: a line from one extreme to the next would show waves
    // that no record has.
    if (thin.size > 1) {
      Bars bars = column_bars(*sd, kAveragePoints);
      const double step_s =
          (time_s->back() - time_s->front()) / static_cast<double>(sd->size() - 1);
      for (double& x : bars.x) x = time_s->front() + (x - 0.5) * step_s;
      trace.x = std::move(bars.x);
      trace.y = std::move(bars.y);
    } else {
      trace.x = *time_s;
      trace.y = *sd;
    }
    for (double& value : trace.y) value /= si;
    spread.traces.push_back(std::move(trace));
    figures.push_back({fmt::format("{}_{}_sd", condition, about.key), std::move(spread)});
  }
  return figures;
}

std::vector<Figure> average_figures(const AverageFiles& stored) {
  std::vector<Figure> figures;
  for (std::size_t i = 0; i < stored.series.size(); ++i)
    for (Figure& figure : average_figures(stored.result.records[i].condition, *stored.series[i]))
      figures.push_back(std::move(figure));
  return figures;
}

Plot offset_plot(const StoredRecord& record) {
  Plot plot{fmt::format("offset of each repeat of {}", record.condition), "repeat", "offset [ms]",
            620.0, 150.0};
  plot.whole_x = true;
  plot.levels = {0.0};
  Trace points = empty_trace(Trace::Kind::points, "residual");
  for (const datasets::RepeatReport& repeat : record.repeat_reports) {
    points.x.push_back(static_cast<double>(points.x.size() + 1));
    points.y.push_back(1e3 * repeat.offset_s);
  }
  if (points.x.size() > 1) plot.traces = {std::move(points)};
  return plot;
}

doc::Verdict average_headline(const AverageFiles& stored) {
  const std::vector<StoredRecord>& records = stored.result.records;
  long outliers = 0;
  long repeats = 0;
  double offset_s = 0.0;
  for (const StoredRecord& record : records) {
    outliers += record.outliers();
    repeats += record.repeats;
    offset_s = std::max(offset_s, record.offset_range_s.value_or(0.0));
  }
  const std::vector<std::string> warnings = texts_of(stored.result, &StoredRecord::warnings);
  const bool doubtful = outliers > 0 || !warnings.empty();
  doc::Verdict verdict{
      {doubtful ? doc::State::warn : doc::State::good, "AVERAGED"},
      {fmt::format(
          "{} condition{}, {} repeat{}; repeats of a condition start up to {:.2g} ms apart.",
          records.size(), records.size() == 1 ? "" : "s", repeats, repeats == 1 ? "" : "s",
          1e3 * offset_s)}};
  if (outliers > 0)
    add_reason(verdict,
               fmt::format("{} repeat{} flagged as outlier", outliers, outliers == 1 ? "" : "s"),
               "repeatability");
  for (const std::string& text : warnings) add_reason(verdict, text, "repeatability");
  return verdict;
}

std::vector<doc::Section> average_sections(const AverageFiles& stored) {
  doc::Table table{"Repeatability of every condition and channel"};
  table.shape = doc::Table::Shape::cards;
  table.style = "repeatability";
  table.columns = {{"Condition"},
                   {"Channel"},
                   {"Samples", Kind::number, 1},
                   {"Repeats", Kind::number},
                   {"sd of one", Kind::number},
                   {"sd of the mean", Kind::number, 3},
                   {"Floor of rho2", Kind::number, 2},
                   {"Floor of the error, %", Kind::number},
                   {"Offsets", Kind::number},
                   {"Outliers", Kind::number}};
  table.keys = 2;
  doc::Section means{"means", "Means"};
  const std::vector<StoredRecord>& records = stored.result.records;
  for (std::size_t i = 0; i < records.size(); ++i) {
    add_agreement_rows(records[i], table);
    const std::string& id = records[i].condition;
    doc::Gallery gallery;
    gallery.wide = true;
    for (Figure& figure : average_figures(id, *stored.series[i]))
      gallery.figures.push_back(figure_of(std::move(figure.plot)));
    Plot offsets = offset_plot(records[i]);
    if (!offsets.traces.empty()) gallery.figures.push_back(figure_of(std::move(offsets)));
    means.blocks.emplace_back(
        doc::Fold{id, {std::move(gallery)}, i == 0 || records.size() <= kFew});
  }
  doc::Section section{
      "repeatability",
      "Repeatability",
      {doc::reading(
           "Agreement of the repeats of each condition. Noise floor: the best score that a perfect "
           "model could reach. Offsets: time differences between the starts of the repeats."),
       std::move(table)}};
  const std::vector<std::string> warnings = texts_of(stored.result, &StoredRecord::warnings);
  if (!warnings.empty())
    section.blocks.emplace_back(doc::Fold{fmt::format("Warnings ({})", warnings.size()),
                                          {list_of(warnings, doc::State::warn)},
                                          warnings.size() <= kFew});
  const std::vector<std::string> notes = texts_of(stored.result, &StoredRecord::notes);
  if (!notes.empty())
    section.blocks.emplace_back(doc::Fold{
        fmt::format("Processing of the recordings ({})", notes.size()), {list_of(notes)}});
  return {std::move(section), std::move(means)};
}

}  // namespace rigcal::report
