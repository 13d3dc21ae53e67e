#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "report/figure/decimate.hpp"
#include "report/page/page_parts.hpp"
#include "report/text/readable.hpp"

// What the first screen shows beside the verdict: three numbers, and every condition as a small
// picture.

namespace rigcal::report {
namespace {

constexpr double kCellWidth = 190.0;
constexpr double kCellHeight = 84.0;
constexpr std::size_t kCellPoints = 260;
/// Periods that a small picture has room for.
constexpr double kPeriods = 2.0;

std::string spaced(std::string key) {
  std::replace(key.begin(), key.end(), '_', ' ');
  return key;
}

/// Position where it was compared, else the first channel.
std::string shown_channel(const Json& conditions) {
  std::string first;
  for (const Json& condition : conditions) {
    for (const auto& [channel, scores] : condition.at("metrics").items()) {
      if (channel == "position") return channel;
      if (first.empty()) first = channel;
    }
  }
  return first;
}

std::string column_name(const char* what, const std::string& channel) {
  const auto known = datasets::channel_from_key(channel);
  return fmt::format("{}_{}", what, known ? datasets::info(*known).name : channel);
}

/// The last two periods of a record, or all of it where it has fewer.
std::size_t first_shown(const Json& condition, const std::vector<double>& time_s) {
  const auto frequency = number_of(condition, "frequency_hz");
  if (!frequency || !(*frequency > 0.0)) return 0;
  const double from = time_s.back() - kPeriods / *frequency;
  return static_cast<std::size_t>(std::lower_bound(time_s.begin(), time_s.end(), from) -
                                  time_s.begin());
}

Plot small_plot(const Json& condition, const Table& series, const std::string& channel) {
  Plot plot;
  plot.title = fmt::format("{} of {}, measured and model", channel, text_of(condition, "id"));
  plot.width = kCellWidth;
  plot.height = kCellHeight;
  plot.bare = true;
  const auto* time_s = series.find("time_s");
  if (time_s == nullptr || time_s->empty()) return plot;
  const std::size_t begin = first_shown(condition, *time_s);
  const std::span<const double> times = std::span(*time_s).subspan(begin);
  const Buckets thin = buckets(times.size(), kCellPoints);
  for (const auto& [what, style] : {std::pair{"measured", "measured"}, {"simulated", "model"}}) {
    const auto* values = series.find(column_name(what, channel));
    if (values == nullptr) continue;
    Trace trace = empty_trace(Trace::Kind::line, style);
    trace.x = thinned_times(times, thin);
    trace.y = thinned(std::span(*values).subspan(begin), thin);
    plot.traces.push_back(std::move(trace));
  }
  return plot;
}

/// The condition with the least or the greatest of a metric.
struct Extreme {
  double value = 0.0;
  std::string condition;
};

template <typename Worse>
std::optional<Extreme> extreme(const Json& conditions, const std::string& channel,
                               const char* metric, Worse worse) {
  std::optional<Extreme> found;
  for (const Json& condition : conditions) {
    const auto scores = condition.at("metrics").find(channel);
    if (scores == condition.at("metrics").end()) continue;
    const auto value = number_of(*scores, metric);
    if (value && (!found || worse(*value, found->value)))
      found = Extreme{*value, text_of(condition, "id")};
  }
  return found;
}

/// Half an interval over its value of the estimate that is known the least, nuisance parameters and
/// those without an interval left out.
std::optional<Extreme> widest_interval(const Json& parameters) {
  std::optional<Extreme> widest;
  for (const Json& parameter : parameters) {
    const auto value = number_of(parameter, "value");
    const Json& ends = parameter.at("ci95");
    if (!parameter.at("fitted").get<bool>() || parameter.at("nuisance").get<bool>() ||
        !ends.is_array() || !ends.at(0).is_number() || !ends.at(1).is_number() || !value ||
        *value == 0.0 || text_of(parameter, "identifiability") == "bounded")
      continue;
    const double half =
        0.5 * (ends.at(1).get<double>() - ends.at(0).get<double>()) / std::abs(*value);
    if (!widest || half > widest->value) widest = Extreme{half, parameter_label(parameter)};
  }
  return widest;
}

Json three_numbers(const Json& result, const std::string& channel) {
  Json numbers = Json::array();
  const auto add = [&](const char* name, const std::string& text, const std::string& of) {
    numbers.push_back({{"name", name}, {"text", text}, {"of", of}});
  };
  const Json& conditions = result.at("conditions");
  if (const auto least = extreme(conditions, channel, "rho2", std::less<>()))
    add("Lowest rho2", agreement_text(least->value), least->condition);
  if (const auto largest = extreme(conditions, channel, "absolute_error_percent", std::greater<>()))
    add("Largest mean error", fmt::format("{:.3g} % of the range", largest->value),
        largest->condition);
  if (const auto widest = widest_interval(result.at("parameters")))
    add("Least certain estimate", fmt::format("± {:.2g} %", 100.0 * widest->value),
        widest->condition);
  return numbers;
}

}  // namespace

Json overview_view(const Calibration& stored) {
  const Json& conditions = stored.result.at("conditions");
  const std::string channel = shown_channel(conditions);
  Json view{{"there", !channel.empty()}, {"channel", spaced(channel)}, {"cells", Json::array()}};
  view["numbers"] = channel.empty() ? Json::array() : three_numbers(stored.result, channel);
  view["has_numbers"] = !view["numbers"].empty();
  if (channel.empty()) return view;
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    const Json& condition = conditions.at(i);
    const std::string id = text_of(condition, "id");
    const Plot plot = small_plot(condition, *stored.series(i), channel);
    view["cells"].push_back({{"id", id},
                             {"anchor", anchor(id)},
                             {"badge", badge(condition.at("verdict"))},
                             {"drawn", !plot.traces.empty()},
                             {"plot_html", plot.traces.empty() ? std::string() : svg(plot)}});
  }
  return view;
}

}  // namespace rigcal::report
