#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>

#include "report/document/words.hpp"
#include "report/figure/decimate.hpp"
#include "report/page/calibration/fit_sections.hpp"
#include "report/page/calibration/page_agreement_figures.hpp"
#include "report/page/calibration/shown_part.hpp"
#include "report/page/page_parts.hpp"
#include "report/text/readable.hpp"

// What the scores begin with: three key numbers, small pictures of the conditions, and the response
// of the rig.

namespace rigcal::report {
namespace {

constexpr double kCellWidth = 190.0;
constexpr double kCellHeight = 84.0;
constexpr std::size_t kCellPoints = 260;

std::string column_name(const char* what, const std::string& channel) {
  const auto known = datasets::channel_from_key(channel);
  return fmt::format("{}_{}", what, known ? datasets::info(*known).name : channel);
}

Plot small_plot(const calib::ConditionResult& condition, const Table& series,
                const std::string& channel) {
  Plot plot{fmt::format("{} of {}, measured and model", channel, condition.id),
            {},
            {},
            kCellWidth,
            kCellHeight};
  plot.bare = true;
  const auto* time_s = series.find("time_s");
  if (time_s == nullptr || time_s->empty()) return plot;
  const std::size_t begin = first_of_last_periods(condition, *time_s);
  const std::span<const double> times = std::span(*time_s).subspan(begin);
  const Buckets thin = buckets(times.size(), kCellPoints);
  for (const auto& [what, style] : {std::pair{"measured", "measured"}, {"simulated", "model"}}) {
    const auto* values = series.find(column_name(what, channel));
    if (values == nullptr) continue;
    Trace trace = empty_trace(Trace::Kind::line, style);
    const std::span<const double> shown = std::span(*values).subspan(begin);
    trace.x = thinned_times(times, shown, thin);
    trace.y = thinned(shown, thin);
    plot.traces.push_back(std::move(trace));
  }
  return plot;
}

/// A score of one channel in one condition.
struct Extreme {
  double value = 0.0;
  const calib::ConditionResult* condition = nullptr;
  const calib::ChannelScore* score = nullptr;
};

/// Finds the worst value of a metric over all channels and conditions.
template <typename Worse>
std::optional<Extreme> extreme(const std::vector<calib::ConditionResult>& conditions,
                               double metrics::Agreement::*metric, Worse worse) {
  std::optional<Extreme> found;
  for (const calib::ConditionResult& condition : conditions) {
    for (const calib::ChannelScore& score : condition.channels) {
      const double value = score.metrics.*metric;
      if (std::isnan(value)) continue;
      if (!found || worse(value, found->value)) found = Extreme{value, &condition, &score};
    }
  }
  return found;
}

std::optional<double> limit_of(const Extreme& worst, std::string_view metric) {
  for (const calib::LimitCheck& check : worst.condition->limit_checks)
    if (check.channel == worst.score->channel && check.metric == metric) return check.limit;
  return std::nullopt;
}

/// Returns, for example, "load pressure of sine_2Hz, limit 0.9, U 0.00021".
std::string whose(const Extreme& worst, const std::string& metric,
                  double metrics::Agreement::*value) {
  std::string text =
      fmt::format("{} of {}", spaced(std::string(worst.score->key())), worst.condition->id);
  const std::optional<double> limit = limit_of(worst, metric);
  text += limit ? fmt::format(", limit {:.6g}", *limit) : std::string(", no limit");
  const metrics::Agreement* uncertainty = worst.score->printed_uncertainty();
  if (uncertainty != nullptr && std::isfinite(uncertainty->*value))
    text += ", U " + uncertainty_text(uncertainty->*value, worst.value);
  return text;
}

/// Returns the estimate with the largest relative interval, ignoring nuisance parameters; null if
/// there is none.
const calib::FittedParameter* least_certain(const std::vector<calib::FittedParameter>& parameters) {
  const calib::FittedParameter* least = nullptr;
  for (const calib::FittedParameter& p : parameters) {
    if (!p.fitted || p.nuisance) continue;
    if (least == nullptr || relative_half_width(p) > relative_half_width(*least)) least = &p;
  }
  return least;
}

}  // namespace

doc::Facts three_numbers(const StoredFit& fit) {
  using metrics::Agreement;
  doc::Facts numbers{"Three numbers"};
  numbers.shape = doc::Facts::Shape::grid;
  const auto add = [&](const char* name, const std::string& text, const std::string& of) {
    numbers.rows.push_back({name, {doc::Strong{text}, " ", doc::Soft{of}}});
  };
  if (const auto least = extreme(fit.conditions, &Agreement::rho2, std::less<>()))
    add("Lowest rho2", doc::score("rho2", least->value, limit_of(*least, "rho2")).text,
        whose(*least, "rho2", &Agreement::rho2));
  if (const auto largest =
          extreme(fit.conditions, &Agreement::absolute_error_percent, std::greater<>()))
    add("Largest mean error",
        doc::score("absolute_error_percent", largest->value,
                   limit_of(*largest, "absolute_error_percent"))
                .text +
            " % of the range",
        whose(*largest, "absolute_error_percent", &Agreement::absolute_error_percent));
  const calib::FittedParameter* least = least_certain(fit.parameters);
  // A search that was stopped before it converged has no valid errors.
  if (least == nullptr || (fit.status == calib::FitStatus::stopped && !searched_to_the_end(fit)))
    return numbers;
  const bool bounded = least->identifiability == calib::Identifiability::bounded;
  const auto ends = doc::Interval(least->ci95).ends;
  add("Least certain estimate",
      bounded && ends && ends->low == 0.0
          ? "at most " + readable(ends->high, least->unit, kErrorDigits)
          : half_width_text(relative_half_width(*least)),
      parameter_label(*least) + (bounded ? ", not different from zero" : ""));
  return numbers;
}

namespace {

/// Returns the responses of the shown channel to the drive that most conditions have.
std::vector<ResponseCurves> rig_responses(const Calibration& stored, const std::string& channel) {
  const std::vector<calib::ConditionResult>& conditions = stored.result.conditions;
  std::vector<std::vector<ResponseCurves>> by_drive;
  for (const std::size_t i : shown_in_full(conditions)) {
    const std::shared_ptr<const Table> series = stored.series(i);
    auto found = channel_response(channel, periodic_frequency(conditions[i]), *series);
    if (!found) continue;
    auto drive = std::find_if(by_drive.begin(), by_drive.end(),
                              [&](const auto& each) { return each.front().of == found->of; });
    if (drive == by_drive.end()) drive = by_drive.emplace(by_drive.end());
    drive->push_back(std::move(*found));
  }
  const auto most =
      std::max_element(by_drive.begin(), by_drive.end(),
                       [](const auto& a, const auto& b) { return a.size() < b.size(); });
  return most == by_drive.end() ? std::vector<ResponseCurves>() : std::move(*most);
}

bool has_two_frequencies(const std::vector<ResponseCurves>& all) {
  std::optional<double> first;
  for (const ResponseCurves& curves : all) {
    for (const metrics::ResponsePoint& point : curves.record) {
      if (first && *first != point.frequency_hz) return true;
      first = point.frequency_hz;
    }
  }
  return false;
}

}  // namespace

std::vector<Figure> rig_response_figures(const Calibration& stored) {
  const std::string channel = shown_channel(stored.result.conditions);
  if (channel.empty()) return {};
  const std::vector<ResponseCurves> all = rig_responses(stored, channel);
  if (!has_two_frequencies(all)) return {};
  const std::string name = fmt::format("{} condition{}", all.size(), all.size() == 1 ? "" : "s");
  return {{"rig_" + channel + "_gain", gain_plot(name, all)},
          {"rig_" + channel + "_phase", phase_plot(name, all)}};
}

std::optional<Plot> condition_picture(const Calibration& stored, std::size_t number,
                                      const std::string& channel) {
  const calib::ConditionResult& condition = stored.result.conditions[number];
  Plot plot = small_plot(condition, *stored.series(number), channel);
  if (plot.traces.empty()) return std::nullopt;
  return plot;
}

void add_rig_response(const Calibration& stored, doc::Blocks& blocks) {
  doc::Gallery response;
  for (Figure& figure : rig_response_figures(stored))
    response.figures.push_back(figure_of(std::move(figure.plot)));
  if (response.figures.empty()) return;
  response.figures.front().caption = "How strongly does the rig respond at each frequency?";
  response.figures.back().caption = "How far does the response lag?";
  // Not on paper, where each condition has its own gain and phase.
  doc::Fold fold{"Gain and phase of the rig", {std::move(response)}, true, "screen"};
  fold.blocks.emplace_back(
      doc::reading("All conditions that are shown in full and have the most frequent kind of "
                   "drive; a line joins the points of one condition. Gain and phase depend on the "
                   "amplitude."));
  blocks.emplace_back(std::move(fold));
}

}  // namespace rigcal::report
