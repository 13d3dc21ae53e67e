#include "report/page/page_average.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "datasets/record.hpp"
#include "report/figure/decimate.hpp"
#include "report/figure/time_plots.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

/// About one for each pixel of the width.
constexpr std::size_t kAveragePoints = 600;

std::string offsets_text(const StoredRecord& record) {
  if (record.repeats < 2 || !record.offset_range_s) return "–";
  return fmt::format("{:.2g} ms", 1e3 * *record.offset_range_s);
}

bool is_measured(const std::string& channel) {
  const auto known = datasets::channel_from_key(channel);
  return known && datasets::info(*known).is_output;
}

Json agreement_rows(const StoredRecord& record) {
  Json rows = Json::array();
  for (const auto& [channel, found] : record.channels) {
    if (!is_measured(channel)) continue;  // a command is what it was told to be
    const std::optional<StoredNoiseFloor>& noise_floor = found.noise_floor;
    const auto floor = [&](double StoredNoiseFloor::*value) -> Number {
      return noise_floor ? std::optional((*noise_floor).*value) : std::nullopt;
    };
    rows.push_back({{"condition", record.condition},
                    {"channel", channel},
                    {"samples", fmt::format("{}", record.samples)},
                    {"repeats", fmt::format("{}", found.repeats)},
                    {"sd", shown(found.pooled_sd, found.unit, 3)},
                    {"sd_of_mean", shown(found.sd_of_mean, found.unit, 3)},
                    {"rho2", shown_agreement(floor(&StoredNoiseFloor::rho2))},
                    {"error", shown_in(floor(&StoredNoiseFloor::absolute_error_percent), 1.0, 3)},
                    {"offsets", offsets_text(record)},
                    {"outliers", fmt::format("{}", record.outliers())}});
  }
  return rows;
}

/// What is said of every record, with its condition.
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
                             double& si) {
      const ReadableUnit unit = readable_unit(size, about.unit);
      si = unit.si;
      Plot plot;
      plot.title = title;
      plot.x_label = "time [s]";
      plot.y_label = fmt::format("{} [{}]", what, unit.name.empty() ? "1" : unit.name);
      plot.width = 620.0;
      plot.height = 170.0;
      return plot;
    };
    double si = 1.0;
    Plot plot = plot_of(
        fmt::format("{} of {}, mean and standard deviation of its repeats", words, condition),
        words, largest(*mean), si);
    Trace line = empty_trace(Trace::Kind::line, "measured", "mean");
    line.x = thinned_times(*time_s, *mean, thin);
    line.y = thinned(*mean, thin);
    for (double& value : line.y) value /= si;
    const bool scatter = sd != nullptr && largest(*sd) > 0.0;
    if (scatter) {
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
    if (!scatter) continue;
    Plot spread = plot_of(
        fmt::format("{} of {}, standard deviation of its repeats over time", words, condition),
        "sd of " + words, largest(*sd), si);
    spread.height = 130.0;
    Trace trace = empty_trace(Trace::Kind::line, "residual");
    trace.x = thinned_times(*time_s, *sd, thin);
    trace.y = thinned(*sd, thin);
    for (double& value : trace.y) value /= si;
    spread.traces.push_back(std::move(trace));
    figures.push_back({fmt::format("{}_{}_sd", condition, about.key), std::move(spread)});
  }
  return figures;
}

std::vector<Figure> average_figures(const AverageFiles& stored) {
  std::vector<Figure> figures;
  for (std::size_t i = 0; i < stored.series.size(); ++i)
    for (Figure& figure : average_figures(stored.result.records[i].condition, stored.series[i]))
      figures.push_back(std::move(figure));
  return figures;
}

Plot offset_plot(const StoredRecord& record) {
  Plot plot;
  plot.title = fmt::format("offset of each repeat of {}", record.condition);
  plot.x_label = "repeat";
  plot.y_label = "offset [ms]";
  plot.width = 620.0;
  plot.height = 150.0;
  plot.whole_x = true;
  plot.levels = {0.0};
  Trace points = empty_trace(Trace::Kind::points, "residual");
  for (const StoredRepeat& repeat : record.repeat_reports) {
    points.x.push_back(static_cast<double>(points.x.size() + 1));
    points.y.push_back(repeat.offset_s ? 1e3 * *repeat.offset_s : std::nan(""));
  }
  if (points.x.size() > 1) plot.traces = {std::move(points)};
  return plot;
}

Json average_headline(const AverageFiles& stored) {
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
  Json view = make_headline(
      "AVERAGED", doubtful ? "!" : "✓", doubtful ? "warn" : "good",
      fmt::format(
          "{} condition{}, {} repeat{}; repeats of a condition start up to {:.2g} ms apart.",
          records.size(), records.size() == 1 ? "" : "s", repeats, repeats == 1 ? "" : "s",
          1e3 * offset_s));
  if (outliers > 0)
    add_reason(view, fmt::format("{} repeat{} named outlier", outliers, outliers == 1 ? "" : "s"),
               "repeatability");
  for (const std::string& text : warnings) add_reason(view, text, "repeatability");
  return view;
}

Json average_view(const AverageFiles& stored) {
  Json view;
  view["rows"] = Json::array();
  view["records"] = Json::array();
  const std::vector<StoredRecord>& records = stored.result.records;
  for (std::size_t i = 0; i < records.size(); ++i) {
    for (Json& row : agreement_rows(records[i])) view["rows"].push_back(std::move(row));
    const std::string& id = records[i].condition;
    Json figures = Json::array();
    for (const Figure& figure : average_figures(id, stored.series[i]))
      figures.push_back({{"svg_html", svg(figure.plot)}});
    const Plot offsets = offset_plot(records[i]);
    view["records"].push_back({{"condition", id},
                               {"open", i == 0 || records.size() <= kFew},
                               {"figures", std::move(figures)},
                               {"has_offsets", !offsets.traces.empty()},
                               {"offsets_html", offsets.traces.empty() ? "" : svg(offsets)}});
  }
  view["warnings"] = texts_of(stored.result, &StoredRecord::warnings);
  view["has_warnings"] = !view["warnings"].empty();
  view["few_warnings"] = view["warnings"].size() <= kFew;
  view["warning_count"] = fmt::format("{}", view["warnings"].size());
  view["notes"] = texts_of(stored.result, &StoredRecord::notes);
  view["has_notes"] = !view["notes"].empty();
  view["note_count"] = fmt::format("{}", view["notes"].size());
  return view;
}

void add_average(const AverageFiles& /*stored*/, Part& part) {
  part.nav.emplace_back("means", "Means");
}

}  // namespace rigcal::report
