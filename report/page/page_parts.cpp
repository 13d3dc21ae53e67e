#include "report/page/page_parts.hpp"

#include <algorithm>

#include "datasets/record.hpp"
#include "metrics/metric_table.hpp"
#include "report/text/estimate_text.hpp"

namespace rigcal::report {

void add_reason(doc::Verdict& verdict, const std::string& text, const std::string& link) {
  constexpr std::size_t kReasonsShown = 3;
  if (verdict.reasons.size() == kReasonsShown) {
    ++verdict.more;
    return;
  }
  verdict.reasons.push_back(link.empty() ? doc::Line{text}
                                         : doc::Line{doc::Link{"#" + link, text}});
}

doc::Verdict verdict_without_result(LeakStatus status, const std::string& sentence,
                                    const std::vector<std::string>& reasons,
                                    const std::string& link) {
  doc::Verdict verdict{{doc::State::bad, status == LeakStatus::declined ? "DECLINED" : "FAILED"},
                       {sentence}};
  for (const std::string& reason : reasons) add_reason(verdict, reason, link);
  return verdict;
}

doc::List list_of(const std::vector<std::string>& texts, std::optional<doc::State> state) {
  doc::List list;
  list.state = state;
  for (const std::string& text : texts) list.items.push_back({text});
  return list;
}

doc::Figure figure_of(Plot plot, std::string caption, std::string reading) {
  doc::Figure figure{[plot = std::move(plot)] { return plot; }};
  figure.caption = std::move(caption);
  figure.reading = std::move(reading);
  return figure;
}

std::string capitalised(std::string text) {
  if (!text.empty() && text.front() >= 'a' && text.front() <= 'z')
    text.front() = static_cast<char>(text.front() - 'a' + 'A');
  return text;
}

bool searched_to_the_end(const StoredFit& fit) {
  return fit.status == calib::FitStatus::converged ||
         (fit.status == calib::FitStatus::stopped && fit.stopped_in &&
          fit.stopped_in != calib::StoppedIn::starts);
}

bool is_doubtful(const std::optional<calib::Identifiability>& grade) {
  return grade && grade != calib::Identifiability::identified;
}

std::string spaced(std::string key) {
  std::replace(key.begin(), key.end(), '_', ' ');
  return key;
}

std::string anchor(const std::string& condition) { return "condition-" + condition; }

Plot ranked_points(const std::string& title, const std::string& y_label,
                   const std::vector<double>& values) {
  Plot plot{title, {}, y_label};
  plot.whole_x = true;
  plot.log_y = true;
  plot.height = 170.0;
  Trace trace = empty_trace(Trace::Kind::points, "model");
  for (const double value : values) {
    trace.x.push_back(static_cast<double>(trace.x.size() + 1));
    trace.y.push_back(value);
  }
  plot.traces = {std::move(trace)};
  return plot;
}

void add_interval(Trace& intervals, double x, const Interval& interval, double si_per_unit) {
  if (!interval.ends) return;
  intervals.x.push_back(x);
  intervals.y.push_back(interval.ends->low / si_per_unit);
  intervals.upper.push_back(interval.ends->high / si_per_unit);
}

void add_trend_line(Plot& plot, const calib::EstimateTrend& trend,
                    const std::vector<calib::PlacedEstimate>& estimates, const Range& places,
                    double si_per_unit) {
  if (!trend.slope || !trend.intercept) return;
  const auto value_at = [&](double place) { return *trend.intercept + *trend.slope * place; };
  constexpr int kBandPieces = 32;  // the edges of the band are curved
  Trace band = empty_trace(Trace::Kind::band, "model");
  for (int i = 0; i <= kBandPieces; ++i) {
    const double place = places.low + (places.high - places.low) * i / kBandPieces;
    const std::optional<double> half = calib::half_width_of_band(trend, estimates, place);
    if (!half) break;
    band.x.push_back(place);
    band.y.push_back((value_at(place) - *half) / si_per_unit);
    band.upper.push_back((value_at(place) + *half) / si_per_unit);
  }
  if (!band.x.empty()) plot.traces.push_back(std::move(band));
  Trace line = empty_trace(Trace::Kind::line, "reference");
  line.x = {places.low, places.high};
  for (const double place : line.x) line.y.push_back(value_at(place) / si_per_unit);
  plot.traces.push_back(std::move(line));
}

std::string_view channel_unit(std::string_view channel) {
  const auto known = datasets::channel_from_key(channel);
  return known ? datasets::info(*known).unit : std::string_view("1");
}

}  // namespace rigcal::report
