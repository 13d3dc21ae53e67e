#include "report/figure/time_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "datasets/record.hpp"
#include "metrics/distributions.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

/// A line in a static picture has about two points per pixel.
constexpr std::size_t kStaticPoints = 1200;

bool has_numbers(const std::vector<double>* values) {
  return values != nullptr && std::any_of(values->begin(), values->end(),
                                          [](double value) { return std::isfinite(value); });
}

/// Chooses the unit that suits the largest value; flows are always in L/min.
void set_unit(TimePlot& plot, std::string_view si_unit) {
  double size = 0.0;
  for (const TimeLine& line : plot.lines) size = std::max(size, largest(*line.values));
  const ReadableUnit unit = readable_unit(size, si_unit);
  plot.unit = std::string(unit.name.empty() ? "1" : unit.name);
  plot.si = unit.si;
}

std::vector<double> scaled(std::vector<double> values, double si) {
  for (double& value : values) value /= si;
  return values;
}

}  // namespace

double largest(std::span<const double> values) {
  double result = 0.0;
  for (const double value : values)
    if (std::isfinite(value)) result = std::max(result, std::abs(value));
  return result;
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
    const bool is_position = about.channel == datasets::Channel::position;
    const std::string wanted =
        is_position ? "reference_m"
                    : fmt::format("{}_reference{}", about.key, about.name.substr(about.key.size()));
    if (const auto* reference = table.find(wanted); has_numbers(reference))
      both.lines.push_back({"reference", "reference", reference});
    both.prediction_sd = simulated != nullptr ? column("prediction_sd") : nullptr;
    both.prediction_middle = simulated;
    const auto* prediction_sd = both.prediction_sd;
    set_unit(both, about.unit);
    plots.push_back(std::move(both));
    if (const auto* residual = column("residual")) {
      TimePlot rest;
      rest.name = std::string(about.key) + "_residual";
      rest.title = std::string(about.key) + ", residual (measured minus model)";
      std::replace(rest.title.begin(), rest.title.end(), '_', ' ');
      rest.height = 150.0;
      rest.lines.push_back({"residual", "residual", residual});
      rest.prediction_sd = prediction_sd;
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

namespace {

/// Number of points in a band that does not follow a signal; such a band varies slowly.
constexpr std::size_t kBandPoints = 300;

Trace prediction_band(const TimePlot& plot, const std::vector<double>& time_s) {
  Trace band = empty_trace(Trace::Kind::band, "model", "95 % prediction");
  const bool follows = plot.prediction_middle != nullptr;
  const Buckets thin = buckets(time_s.size(), follows ? kStaticPoints : kBandPoints);
  band.x = follows ? thinned_times(time_s, *plot.prediction_middle, thin)
                   : thinned_times(time_s, *plot.prediction_sd, thin);
  const std::vector<double> sd =
      follows ? thinned_where(*plot.prediction_sd, *plot.prediction_middle, thin)
              : thinned(*plot.prediction_sd, thin);
  const std::vector<double> middle =
      follows ? thinned(*plot.prediction_middle, thin) : std::vector<double>(sd.size(), 0.0);
  for (std::size_t i = 0; i < sd.size(); ++i) {
    band.y.push_back((middle[i] - metrics::kNormal95 * sd[i]) / plot.si);
    band.upper.push_back((middle[i] + metrics::kNormal95 * sd[i]) / plot.si);
  }
  return band;
}

/// Returns true if a band around a curve should be drawn: only if it is wider than the line. The
/// script on the page shows narrower bands after zooming in.
bool shows_band(const TimePlot& plot) {
  constexpr double kLeastShare = 0.01;
  return plot.prediction_middle == nullptr || metrics::kNormal95 * largest(*plot.prediction_sd) >
                                                  kLeastShare * largest(*plot.prediction_middle);
}

}  // namespace

Plot picture(const TimePlot& plot, const Table& table, const std::string& condition) {
  const std::vector<double>& time_s = table.columns.front();
  const Buckets thin = buckets(time_s.size(), kStaticPoints);
  Plot result{fmt::format("{} of {} over time, in {}", plot.title, condition, plot.unit),
              "time [s]",
              fmt::format("{} [{}]", plot.name == "flows" ? "flow" : plot.title, plot.unit)};
  result.height = plot.height;
  for (const TimeLine& line : plot.lines) {
    Trace trace;
    trace.name = plot.lines.size() > 1 ? line.name : std::string();
    trace.style = line.style;
    trace.x = thinned_times(time_s, *line.values, thin);
    trace.y = scaled(thinned(*line.values, thin), plot.si);
    result.traces.push_back(std::move(trace));
  }
  // Measured signals are drawn on top, and bands below everything.
  std::reverse(result.traces.begin(), result.traces.end());
  if (plot.prediction_sd != nullptr && shows_band(plot))
    result.traces.insert(result.traces.begin(), prediction_band(plot, time_s));
  if (plot.sd != nullptr) {
    Trace band = empty_trace(Trace::Kind::band, "measured", "sd of repeats");
    band.x = result.traces.back().x;
    const std::vector<double> sd =
        scaled(thinned_where(*plot.sd, *plot.lines.front().values, thin), plot.si);
    const std::vector<double>& middle = result.traces.back().y;
    for (std::size_t i = 0; i < middle.size(); ++i) {
      band.y.push_back(middle[i] - sd[i]);
      band.upper.push_back(middle[i] + sd[i]);
    }
    result.traces.insert(result.traces.begin(), std::move(band));
  }
  return result;
}

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

SeriesData::SeriesData(const Table& table, std::size_t points)
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

std::size_t SeriesData::add(const std::vector<double>& values, double si) {
  return add(values, values, si);
}

std::size_t SeriesData::add(const std::vector<double>& values, const std::vector<double>& extremes,
                            double si) {
  const Quantised q = quantised(thinned_where(values, extremes, thin_));
  json_["columns"].push_back({{"low", q.low / si}, {"step", q.step / si}, {"data", q.base64}});
  return json_["columns"].size() - 1;
}

std::string SeriesData::text() const {
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

}  // namespace rigcal::report
