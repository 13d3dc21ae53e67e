#include "report/page/page_average.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/error.hpp"
#include "datasets/campaign/condition_id.hpp"
#include "datasets/record.hpp"
#include "report/figure/decimate.hpp"
#include "report/store/result_files.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

constexpr std::size_t kAveragePoints = 300;

double size_of(const std::vector<double>& values) {
  double result = 0.0;
  for (const double value : values)
    if (std::isfinite(value)) result = std::max(result, std::abs(value));
  return result;
}

std::string offsets_text(const Json& record) {
  if (record.at("repeats").get<int>() < 2) return "–";
  const auto offset_s = number_of(record, "offset_range_s");
  return offset_s ? fmt::format("{:.2g} ms", 1e3 * *offset_s) : std::string("–");
}

long outliers_of(const Json& record) {
  const Json& reports = record.at("repeat_reports");
  return std::count_if(reports.begin(), reports.end(),
                       [](const Json& report) { return report.at("outlier").get<bool>(); });
}

bool is_measured(const std::string& channel) {
  const auto known = datasets::channel_from_key(channel);
  return known && datasets::info(*known).is_output;
}

Json agreement_rows(const Json& record) {
  Json rows = Json::array();
  for (const auto& [channel, found] : record.at("channels").items()) {
    if (!is_measured(channel)) continue;  // a command is what it was told to be
    const std::string unit = text_of(found, "unit");
    const Json& floor = found.at("noise_floor");
    rows.push_back(
        {{"condition", text_of(record, "condition")},
         {"channel", channel},
         {"samples", fmt::format("{}", record.at("samples").get<long>())},
         {"repeats", fmt::format("{}", found.at("repeats").get<int>())},
         {"sd", shown(found.at("pooled_sd"), unit, 3)},
         {"sd_of_mean", shown(found.at("sd_of_mean"), unit, 3)},
         {"rho2", shown_agreement(floor.is_object() ? floor.at("rho2") : Json())},
         {"error",
          shown_in(floor.is_object() ? floor.at("absolute_error_percent") : Json(), 1.0, 3)},
         {"offsets", offsets_text(record)},
         {"outliers", fmt::format("{}", outliers_of(record))}});
  }
  return rows;
}

Json warning_texts(const Json& average, const char* key) {
  Json list = Json::array();
  for (const Json& record : average.at("records"))
    for (const Json& text : record.at(key))
      list.push_back(fmt::format("{}: {}", text_of(record, "condition"), text.get<std::string>()));
  return list;
}

}  // namespace

AverageFiles load_average(const ReadFile& read, const std::string& where) {
  AverageFiles stored{load_json(read, where, "average.json"), {}};
  const ReadFile own = files_of_run(read, stored.average, where, "average.json");
  for (const Json& record : stored.average.at("records")) {
    const std::string id = text_of(record, "condition");
    if (!datasets::is_condition_id(id))
      throw InputError({(std::filesystem::path(where) / "average.json").string()},
                       fmt::format("key 'condition' of a record: found \"{}\", expected {}",
                                   id.substr(0, 40), datasets::condition_id_rule()));
    const std::string name = "averaged/" + id + ".csv";
    const auto text = own(name);
    stored.series.push_back(
        text ? parse_table(*text, (std::filesystem::path(where) / name).string()) : Table{});
  }
  return stored;
}

std::vector<Figure> average_figures(const std::string& condition, const Table& series) {
  std::vector<Figure> figures;
  const auto* time_s = series.find("time_s");
  if (time_s == nullptr || time_s->empty()) return figures;
  const Buckets thin = buckets(time_s->size(), kAveragePoints);
  const std::vector<double> times = thinned_times(*time_s, thin);
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
        words, size_of(*mean), si);
    Trace line = empty_trace(Trace::Kind::line, "measured", "mean");
    line.x = times;
    line.y = thinned(*mean, thin);
    for (double& value : line.y) value /= si;
    const bool scatter = sd != nullptr && size_of(*sd) > 0.0;
    if (scatter) {
      Trace band = empty_trace(Trace::Kind::band, "measured", "sd of repeats");
      band.x = times;
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
        "sd of " + words, size_of(*sd), si);
    spread.height = 130.0;
    Trace trace = empty_trace(Trace::Kind::line, "residual");
    trace.x = times;
    trace.y = thinned(*sd, thin);
    for (double& value : trace.y) value /= si;
    spread.traces.push_back(std::move(trace));
    figures.push_back({fmt::format("{}_{}_sd", condition, about.key), std::move(spread)});
  }
  return figures;
}

Plot offset_plot(const Json& record) {
  Plot plot;
  plot.title = fmt::format("offset of each repeat of {}", text_of(record, "condition"));
  plot.x_label = "repeat";
  plot.y_label = "offset [ms]";
  plot.width = 620.0;
  plot.height = 150.0;
  plot.whole_x = true;
  plot.levels = {0.0};
  Trace points = empty_trace(Trace::Kind::points, "residual");
  for (const Json& report : record.at("repeat_reports")) {
    const auto offset_s = number_of(report, "offset_s");
    points.x.push_back(static_cast<double>(points.x.size() + 1));
    points.y.push_back(offset_s ? 1e3 * *offset_s : std::nan(""));
  }
  if (points.x.size() > 1) plot.traces = {std::move(points)};
  return plot;
}

Json average_headline(const Json& average) {
  const Json& records = average.at("records");
  long outliers = 0;
  long repeats = 0;
  double offset_s = 0.0;
  for (const Json& record : records) {
    outliers += outliers_of(record);
    repeats += record.at("repeats").get<long>();
    offset_s = std::max(offset_s, number_of(record, "offset_range_s").value_or(0.0));
  }
  const Json warnings = warning_texts(average, "warnings");
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
  for (const Json& text : warnings) add_reason(view, text.get<std::string>(), "repeatability");
  return view;
}

Json average_view(const AverageFiles& stored) {
  Json view;
  view["rows"] = Json::array();
  view["records"] = Json::array();
  const Json& records = stored.average.at("records");
  for (std::size_t i = 0; i < records.size(); ++i) {
    const Json& record = records.at(i);
    for (Json& row : agreement_rows(record)) view["rows"].push_back(std::move(row));
    const std::string id = text_of(record, "condition");
    Json figures = Json::array();
    for (const Figure& figure : average_figures(id, stored.series[i]))
      figures.push_back({{"svg_html", svg(figure.plot)}});
    const Plot offsets = offset_plot(record);
    view["records"].push_back({{"condition", id},
                               {"open", i == 0 || records.size() <= kFew},
                               {"figures", std::move(figures)},
                               {"has_offsets", !offsets.traces.empty()},
                               {"offsets_html", offsets.traces.empty() ? "" : svg(offsets)}});
  }
  view["warnings"] = warning_texts(stored.average, "warnings");
  view["has_warnings"] = !view["warnings"].empty();
  view["few_warnings"] = view["warnings"].size() <= kFew;
  view["warning_count"] = fmt::format("{}", view["warnings"].size());
  view["notes"] = warning_texts(stored.average, "notes");
  view["has_notes"] = !view["notes"].empty();
  view["note_count"] = fmt::format("{}", view["notes"].size());
  return view;
}

}  // namespace rigcal::report
