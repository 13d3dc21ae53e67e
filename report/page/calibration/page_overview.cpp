#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/significant.hpp"
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

/// Position where it was compared, else the first channel.
std::string shown_channel(const std::vector<StoredCondition>& conditions) {
  std::string first;
  for (const StoredCondition& condition : conditions) {
    for (const auto& [channel, scores] : condition.metrics) {
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
std::size_t first_shown(const StoredCondition& condition, const std::vector<double>& time_s) {
  const std::optional<double>& frequency = condition.frequency_hz;
  if (!frequency || !(*frequency > 0.0)) return 0;
  const double from = time_s.back() - kPeriods / *frequency;
  return static_cast<std::size_t>(std::lower_bound(time_s.begin(), time_s.end(), from) -
                                  time_s.begin());
}

/// The parts of an id, between which a line may break: "square_", "10Hz_", "open".
Json words_of(const std::string& id) {
  Json words = Json::array();
  for (std::size_t begin = 0; begin < id.size();) {
    const std::size_t end = std::min(id.find('_', begin), id.size() - 1) + 1;
    words.push_back(id.substr(begin, end - begin));
    begin = end;
  }
  return words;
}

Plot small_plot(const StoredCondition& condition, const Table& series, const std::string& channel) {
  Plot plot;
  plot.title = fmt::format("{} of {}, measured and model", channel, condition.id);
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
  std::string of;
};

template <typename Worse>
std::optional<Extreme> extreme(const std::vector<StoredCondition>& conditions,
                               const std::string& channel, double metrics::Agreement::*metric,
                               Worse worse) {
  std::optional<Extreme> found;
  for (const StoredCondition& condition : conditions) {
    const StoredScore* scores = find(condition.metrics, channel);
    if (scores == nullptr || std::isnan(scores->*metric)) continue;
    if (!found || worse(scores->*metric, found->value))
      found = Extreme{scores->*metric, condition.id};
  }
  return found;
}

/// Half an interval over its value of the estimate that is known the least, nuisance parameters and
/// those without an interval left out.
std::optional<Extreme> widest_interval(const std::vector<StoredParameter>& parameters) {
  std::optional<Extreme> widest;
  for (const StoredParameter& p : parameters) {
    const Interval interval(p.ci95);
    if (!p.fitted || p.nuisance || !interval.ends || !p.value || *p.value == 0.0 ||
        p.identifiability == calib::Identifiability::bounded)
      continue;
    const double half = interval.half_width() / std::abs(*p.value);
    if (!widest || half > widest->value) widest = Extreme{half, parameter_label(p)};
  }
  return widest;
}

Json three_numbers(const StoredFit& fit, const std::string& channel) {
  using metrics::Agreement;
  Json numbers = Json::array();
  const auto add = [&](const char* name, const std::string& text, const std::string& of) {
    numbers.push_back({{"name", name}, {"text", text}, {"of", of}});
  };
  if (const auto least = extreme(fit.conditions, channel, &Agreement::rho2, std::less<>()))
    add("Lowest rho2", agreement_text(least->value), least->of);
  if (const auto largest =
          extreme(fit.conditions, channel, &Agreement::absolute_error_percent, std::greater<>()))
    add("Largest mean error", fmt::format("{:.3g} % of the range", largest->value), largest->of);
  if (const auto widest = widest_interval(fit.parameters))
    add("Least certain estimate", fmt::format("± {} %", significant(100.0 * widest->value, 2)),
        widest->of);
  return numbers;
}

}  // namespace

Json overview_view(const Calibration& stored) {
  const std::vector<StoredCondition>& conditions = stored.result.conditions;
  const std::string channel = shown_channel(conditions);
  Json view{{"there", !channel.empty()}, {"channel", spaced(channel)}, {"cells", Json::array()}};
  view["numbers"] = channel.empty() ? Json::array() : three_numbers(stored.result, channel);
  view["has_numbers"] = !view["numbers"].empty();
  if (channel.empty()) return view;
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    const Plot plot = small_plot(conditions[i], *stored.series(i), channel);
    view["cells"].push_back({{"words", words_of(conditions[i].id)},
                             {"anchor", anchor(conditions[i].id)},
                             {"badge", badge(conditions[i].verdict)},
                             {"drawn", !plot.traces.empty()},
                             {"plot_html", plot.traces.empty() ? std::string() : svg(plot)}});
  }
  return view;
}

}  // namespace rigcal::report
