#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "datasets/record.hpp"
#include "report/decimate.hpp"
#include "report/page_parts.hpp"
#include "report/readable.hpp"

namespace rigcal::report {
namespace {

/// A line of a static picture has about two points per pixel.
constexpr std::size_t kStaticPoints = 1200;

double largest(const std::vector<double>& values) {
  double result = 0.0;
  for (const double value : values)
    if (std::isfinite(value)) result = std::max(result, std::abs(value));
  return result;
}

bool has_numbers(const std::vector<double>* values) {
  return values != nullptr && std::any_of(values->begin(), values->end(),
                                          [](double value) { return std::isfinite(value); });
}

/// A column of a condition's table in the unit of its plot.
struct Line {
  std::string name, style;
  const std::vector<double>* values = nullptr;
};

/// One set of axes over time.
struct TimePlot {
  std::string name, title, unit;
  double si = 1.0;
  double height = 200.0;
  std::vector<Line> lines;
  const std::vector<double>* sd = nullptr;  ///< band around the first line
};

/// The unit that suits the largest value; flows always in L/min.
void set_unit(TimePlot& plot, std::string_view si_unit) {
  double size = 0.0;
  for (const Line& line : plot.lines) size = std::max(size, largest(*line.values));
  const ReadableUnit unit = readable_unit(size, si_unit);
  plot.unit = std::string(unit.name.empty() ? "1" : unit.name);
  plot.si = unit.si;
}

std::vector<TimePlot> time_plots(const Table& table) {
  std::vector<TimePlot> plots;
  for (const datasets::ChannelInfo& about : datasets::channel_table()) {
    const auto column = [&](const char* what) {
      const auto* values = table.find(fmt::format("{}_{}", what, about.name));
      return has_numbers(values) ? values : nullptr;
    };
    const auto* measured = column("measured");
    const auto* simulated = column("simulated");
    if (measured == nullptr && simulated == nullptr) continue;
    TimePlot both;
    both.name = std::string(about.key);
    both.title = both.name + ", measured and model";
    std::replace(both.title.begin(), both.title.end(), '_', ' ');
    if (measured != nullptr) both.lines.push_back({"measured", "measured", measured});
    if (simulated != nullptr) both.lines.push_back({"model", "model", simulated});
    both.sd = measured != nullptr ? column("sd") : nullptr;
    if (about.channel == datasets::Channel::position) {
      const auto* reference = table.find("reference_m");
      if (has_numbers(reference)) both.lines.push_back({"reference", "reference", reference});
    }
    set_unit(both, about.unit);
    plots.push_back(std::move(both));
    if (const auto* residual = column("residual")) {
      TimePlot rest;
      rest.name = std::string(about.key) + "_residual";
      rest.title = std::string(about.key) + ", residual (measured minus model)";
      std::replace(rest.title.begin(), rest.title.end(), '_', ' ');
      rest.height = 150.0;
      rest.lines.push_back({"residual", "residual", residual});
      set_unit(rest, about.unit);
      plots.push_back(std::move(rest));
    }
  }
  TimePlot flows;
  flows.name = "flows";
  flows.title = "flows of the model";
  flows.height = 150.0;
  if (const auto* servo = table.find("servo_flow_m3_per_s"); has_numbers(servo))
    flows.lines.push_back({"servo valve", "servo", servo});
  if (const auto* leak = table.find("leakage_flow_m3_per_s"); has_numbers(leak))
    flows.lines.push_back({"leakage", "leak", leak});
  if (!flows.lines.empty()) {
    set_unit(flows, "m3/s");
    plots.push_back(std::move(flows));
  }
  if (const auto* command = table.find("command_v"); has_numbers(command)) {
    TimePlot drive;
    drive.name = "command";
    drive.title = "valve command";
    drive.height = 150.0;
    drive.lines.push_back({"command", "reference", command});
    set_unit(drive, "V");
    plots.push_back(std::move(drive));
  }
  return plots;
}

std::vector<double> scaled(std::vector<double> values, double si) {
  for (double& value : values) value /= si;
  return values;
}

Plot picture(const TimePlot& plot, const Table& table, const std::string& condition) {
  const std::vector<double>& time_s = table.columns.front();
  const Buckets thin = buckets(time_s.size(), kStaticPoints);
  const std::vector<double> times = thinned_times(time_s, thin);
  Plot result;
  result.title = fmt::format("{} of {} over time, in {}", plot.title, condition, plot.unit);
  result.x_label = "time [s]";
  result.y_label = fmt::format("{} [{}]", plot.name == "flows" ? "flow" : plot.title, plot.unit);
  result.height = plot.height;
  for (const Line& line : plot.lines) {
    Trace trace;
    trace.name = plot.lines.size() > 1 ? line.name : std::string();
    trace.style = line.style;
    trace.x = times;
    trace.y = scaled(thinned(*line.values, thin), plot.si);
    result.traces.push_back(std::move(trace));
  }
  // What is measured lies on top; the band beneath all.
  std::reverse(result.traces.begin(), result.traces.end());
  if (plot.sd != nullptr) {
    Trace band;
    band.kind = Trace::Kind::band;
    band.name = "sd of repeats";
    band.style = "measured";
    band.x = times;
    const std::vector<double> sd = scaled(thinned(*plot.sd, thin), plot.si);
    const std::vector<double>& middle = result.traces.back().y;
    for (std::size_t i = 0; i < middle.size(); ++i) {
      band.y.push_back(middle[i] - sd[i]);
      band.upper.push_back(middle[i] + sd[i]);
    }
    result.traces.insert(result.traces.begin(), std::move(band));
  }
  return result;
}

/// The series of a condition for the script of the page.
class SeriesData {
 public:
  SeriesData(const Table& table, std::size_t points)
      : thin_(buckets(table.columns.front().size(), points)),
        times_(thinned_times(table.columns.front(), thin_)) {
    json_["count"] = times_.size();
    json_["samples_per_point"] = thin_.size;
    const double first = times_.empty() ? 0.0 : times_.front();
    std::vector<double> offsets = times_;
    for (double& t : offsets) t -= first;
    json_["first_s"] = first;
    json_["times"] = floats_base64(offsets);
    json_["columns"] = Json::array();
  }

  /// Adds a column and returns its number.
  std::size_t add(const std::vector<double>& values, double si) {
    const Quantised q = quantised(thinned(values, thin_));
    json_["columns"].push_back({{"low", q.low / si}, {"step", q.step / si}, {"data", q.base64}});
    return json_["columns"].size() - 1;
  }

  /// JSON that no HTML parser can take for markup.
  std::string text() const {
    std::string result;
    for (const char c : json_.dump(-1, ' ', false, Json::error_handler_t::replace)) {
      if (c == '<') {
        result += "\\u003c";
      } else {
        result += c;
      }
    }
    return result;
  }

  Json& json() { return json_; }

 private:
  Buckets thin_;
  std::vector<double> times_;
  Json json_;
};

Json score_rows(const Json& result, const Json& condition) {
  Json rows = Json::array();
  for (const auto& [channel, scores] : condition.at("metrics").items()) {
    const std::string_view unit = channel_unit(channel);
    const Judgement judgement = judge_channel(result.at("acceptance"), condition, channel);
    Json verdict = nullptr;
    if (judgement.verdict) verdict = *judgement.verdict;
    const auto floors = condition.at("noise_floor").find(channel);
    const bool floor = floors != condition.at("noise_floor").end() && floors->is_object();
    rows.push_back({{"channel", channel},
                    {"badge", badge(verdict)},
                    {"rho2", shown_agreement(scores.at("rho2"))},
                    {"r", shown_agreement(scores.at("r"))},
                    {"ccc", shown_agreement(scores.at("ccc"))},
                    {"error", shown_in(scores.at("absolute_error_percent"), 1.0, 4)},
                    {"fit", shown_in(scores.at("nrmse_fit_percent"), 1.0, 5)},
                    {"rmse", shown(scores.at("rmse"), unit, 4)},
                    {"maximum", shown(scores.at("maximum_error"), unit, 4)},
                    {"floor", shown_agreement(floor ? floors->at("rho2") : Json())},
                    {"gain", shown_in(scores.at("gain_ratio"), 1.0, 6)},
                    {"phase", shown_in(scores.at("phase_deg"), 1.0, 4)},
                    {"delay", shown(scores.at("delay_s"), "s", 4)},
                    {"problem", text_of(scores, "problem")},
                    {"has_problem", !text_of(scores, "problem").empty()}});
  }
  return rows;
}

std::vector<double> numbers_of(const Json& list) {
  std::vector<double> values;
  for (const Json& value : list) {
    values.push_back(value.is_number() ? value.get<double>()
                                       : std::numeric_limits<double>::quiet_NaN());
  }
  return values;
}

Plot small_plot(const std::string& title, const std::string& x_label, const std::string& y_label) {
  Plot plot;
  plot.title = title;
  plot.x_label = x_label;
  plot.y_label = y_label;
  plot.width = 300.0;
  plot.height = 170.0;
  return plot;
}

Plot correlation_plot(const Json& curve, const std::string& title, bool bars) {
  const double step = curve.at("lag_step_s").get<double>();
  const double first = curve.at("first_lag_s").get<double>();
  Trace trace;
  trace.kind = bars ? Trace::Kind::bars : Trace::Kind::line;
  trace.style = "residual";
  trace.y = numbers_of(curve.at("values"));
  double size = 0.0;
  for (std::size_t i = 0; i < trace.y.size(); ++i) {
    trace.x.push_back(first + step * static_cast<double>(i));
    size = std::max(size, std::abs(trace.x.back()));
  }
  const ReadableUnit unit = readable_unit(size, "s");
  for (double& x : trace.x) x /= unit.si;
  Plot plot = small_plot(title, fmt::format("lag [{}]", unit.name), title);
  plot.traces = {std::move(trace)};
  const double band = curve.at("band").get<double>();
  plot.levels = {-band, band};
  return plot;
}

std::vector<Plot> test_plots(const Json& curves, std::string_view channel_unit_name) {
  std::vector<Plot> plots;
  plots.push_back(correlation_plot(curves.at("autocorrelation"), "autocorrelation", true));
  if (curves.at("cross_correlation").is_object()) {
    plots.push_back(
        correlation_plot(curves.at("cross_correlation"), "cross-correlation with input", false));
  }
  Plot power = small_plot("periodogram", "frequency [Hz]",
                          fmt::format("power density [{}^2/Hz]", channel_unit_name));
  power.log_x = true;
  power.log_y = true;
  Trace density;
  density.style = "residual";
  density.x = numbers_of(curves.at("periodogram").at("frequency_hz"));
  density.y = numbers_of(curves.at("periodogram").at("density"));
  power.traces = {std::move(density)};
  plots.push_back(std::move(power));
  Plot quantiles = small_plot("quantiles", "normal quantile", "residual quantile [std]");
  Trace line;
  line.style = "reference";
  Trace points;
  points.kind = Trace::Kind::points;
  points.style = "residual";
  points.x = numbers_of(curves.at("normality").at("normal_quantile"));
  points.y = numbers_of(curves.at("normality").at("residual_quantile"));
  line.x = line.y = {points.x.front(), points.x.back()};
  quantiles.traces = {std::move(line), std::move(points)};
  plots.push_back(std::move(quantiles));
  return plots;
}

struct TestName {
  const char* key;
  const char* name;
};
constexpr std::array kTests{TestName{"autocorrelation", "Autocorrelation"},
                            TestName{"cross_correlation", "Cross-correlation with the input"},
                            TestName{"periodogram", "Periodogram"},
                            TestName{"normality", "Normality"}, TestName{"drift", "Drift"}};

Json tests_view(const Json& condition, const Json& curves) {
  Json list = Json::array();
  for (const auto& [channel, tests] : condition.at("residual_tests").items()) {
    Json view{{"channel", channel}, {"rows", Json::array()}, {"plots", Json::array()}};
    view["known"] = tests.is_object();
    if (!tests.is_object()) {
      list.push_back(std::move(view));
      continue;
    }
    for (const TestName& test : kTests) {
      const Json& found = tests.at(test.key);
      if (!found.is_object()) continue;
      const bool passed = found.at("passed").get<bool>();
      view["rows"].push_back({{"name", test.name},
                              {"mark", passed ? "✓" : "!"},
                              {"class", passed ? "good" : "warn"},
                              {"verdict", text_of(found, "verdict")}});
    }
    if (curves.is_object() && curves.contains(channel) && curves.at(channel).is_object()) {
      for (const Plot& plot : test_plots(curves.at(channel), channel_unit(channel)))
        view["plots"].push_back({{"svg_html", svg(plot)}});
    }
    list.push_back(std::move(view));
  }
  return list;
}

Json facts_of(const Json& condition) {
  Json facts = Json::array();
  const auto add = [&](const std::string& text) { facts.push_back({{"text", text}}); };
  if (const std::string waveform = text_of(condition, "waveform"); !waveform.empty()) add(waveform);
  const auto quantity = [&](const char* key, const char* unit, const char* name) {
    if (const auto value = number_of(condition, key))
      add(fmt::format("{}{}", name, readable(*value, unit, 5)));
  };
  quantity("frequency_hz", "Hz", "");
  quantity("amplitude_m", "m", "amplitude ");
  quantity("amplitude_v", "V", "amplitude ");
  if (const std::string level = text_of(condition, "leak_level"); !level.empty())
    add("leak " + level);
  if (const auto kelvin = number_of(condition, "temperature_k"))
    add(fmt::format("{:.4g} °C", *kelvin - 273.15));
  if (const std::string date = text_of(condition, "date"); !date.empty()) add(date);
  add("used to " + text_of(condition, "use"));
  add(fmt::format("{} samples", condition.at("samples").get<long>()));
  return facts;
}

/// What the plot tells, for those who cannot see it.
std::string description(const TimePlot& plot, const Table& table) {
  const std::vector<double>& values = *plot.lines.front().values;
  std::size_t peak = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i]) &&
        (!std::isfinite(values[peak]) || std::abs(values[i]) > std::abs(values[peak])))
      peak = i;
  }
  return fmt::format(
      "{}: largest {} {:.4g} {} at {:.4g} s. Zoom with plus and minus, move with the "
      "arrow keys, 0 shows all.",
      plot.title, plot.lines.front().name, values[peak] / plot.si, plot.unit,
      table.columns.front()[peak]);
}

}  // namespace

std::vector<Figure> condition_figures(const Json& condition, const Table& series) {
  std::vector<Figure> figures;
  if (series.columns.empty() || series.columns.front().empty()) return figures;
  for (const TimePlot& plot : time_plots(series))
    figures.push_back({plot.name, picture(plot, series, text_of(condition, "id"))});
  return figures;
}

Json condition_view(const Json& result, const Json& condition, const Table& series,
                    const Json& curves, std::size_t points) {
  const std::string id = text_of(condition, "id");
  Json view;
  view["id"] = id;
  view["anchor"] = anchor(id);
  view["badge"] = badge(condition.at("verdict"));
  view["failure"] = text_of(condition, "failure");
  view["failed"] = !text_of(condition, "failure").empty();
  view["facts"] = facts_of(condition);
  view["reasons"] = Json::array();
  for (const Json& reason : condition.at("reasons")) view["reasons"].push_back({{"text", reason}});
  view["has_reasons"] = !condition.at("reasons").empty();
  view["scores"] = score_rows(result, condition);
  view["has_scores"] = !view["scores"].empty();
  view["plots"] = Json::array();
  view["has_plots"] = false;
  if (!series.columns.empty() && !series.columns.front().empty()) {
    SeriesData data(series, points);
    Json& plots = data.json()["plots"] = Json::array();
    for (const TimePlot& plot : time_plots(series)) {
      Json lines = Json::array();
      for (const Line& line : plot.lines) {
        lines.push_back({{"column", data.add(*line.values, plot.si)},
                         {"name", line.name},
                         {"style", line.style}});
      }
      Json entry{{"name", plot.name}, {"unit", plot.unit}, {"height", plot.height}};
      entry["lines"] = std::move(lines);
      entry["sd"] = plot.sd != nullptr ? Json(data.add(*plot.sd, plot.si)) : Json(nullptr);
      plots.push_back(std::move(entry));
      view["plots"].push_back({{"name", plot.name},
                               {"title", plot.title},
                               {"unit", plot.unit},
                               {"number", fmt::format("{}", plots.size() - 1)},
                               {"description", description(plot, series)},
                               {"svg_html", svg(picture(plot, series, id))}});
    }
    view["has_plots"] = !view["plots"].empty();
    view["thinned"] = data.json()["samples_per_point"].get<std::size_t>() > 1;
    view["samples_per_point"] =
        fmt::format("{}", data.json()["samples_per_point"].get<std::size_t>());
    view["data_html"] = data.text();
  }
  view["tests"] = tests_view(condition, curves);
  view["has_tests"] = !view["tests"].empty();
  return view;
}

}  // namespace rigcal::report
