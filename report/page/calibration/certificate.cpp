#include "report/page/calibration/certificate.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "calib/score/acceptance.hpp"
#include "calib/score/assessment.hpp"
#include "metrics/agreement.hpp"
#include "report/document/quantity.hpp"
#include "report/document/words.hpp"
#include "report/figure/decimate.hpp"
#include "report/page/calibration/assessed.hpp"
#include "report/page/calibration/fit_sections.hpp"
#include "report/page/page_parts.hpp"
#include "report/store/validity.hpp"
#include "report/text/readable.hpp"
#include "report/text/stopped_sentence.hpp"

namespace rigcal::report {
namespace {

using calib::AspectState;
using calib::FitStatus;
using calib::Verdict;
using doc::Line;
using doc::State;

/// Maximum numbers of rows on the first page; further rows are only counted.
constexpr std::size_t kSignals = 8;
constexpr std::size_t kValues = 12;
constexpr std::size_t kDoubts = 9;
constexpr std::size_t kFewestSignals = 3;

/// Returns how many signals the first printed sheet has room for, below its doubts and values.
/// Heights are those of the print style.
std::size_t signals_with_room(std::size_t doubt_lines, std::size_t values, bool is_signed) {
  constexpr double kRoomMm = 156.0;   // an A4 sheet less headings, verdict, rule and item
  constexpr double kSignedMm = 25.0;  // sensors and signatures
  constexpr double kDoubtMm = 3.2;
  constexpr double kValueMm = 5.4;
  constexpr double kSignalMm = 8.6;
  const double room = kRoomMm - (is_signed ? kSignedMm : 0.0) -
                      kDoubtMm * static_cast<double>(doubt_lines) -
                      kValueMm * static_cast<double>(values);
  const auto fits = static_cast<std::size_t>(std::max(0.0, room / kSignalMm));
  return std::clamp(fits, kFewestSignals, kSignals);
}

std::string plural(std::size_t count, const std::string& noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

/// A signal for which there is a limit.
struct Judged {
  const calib::ConditionResult* condition = nullptr;
  std::size_t number = 0;  ///< index of the condition
  std::string channel;
  const calib::LimitCheck* check = nullptr;  ///< the check that uses most of its tolerance

  calib::Badness how_bad() const { return badness(*condition, channel); }
  double used() const {
    if (check == nullptr || !check->value || !check->tolerance_used) return HUGE_VAL;
    return *check->tolerance_used;
  }
  bool held_back() const { return condition->use == datasets::Use::validate; }
  Verdict verdict() const { return check != nullptr ? check->verdict : Verdict::fail; }
};

/// Returns all judged signals in the order of calib::shown_before().
std::vector<Judged> judged_signals(const StoredFit& fit) {
  std::vector<Judged> signals;
  for (std::size_t i = 0; i < fit.conditions.size(); ++i) {
    const calib::ConditionResult& condition = fit.conditions[i];
    if (condition.failure || condition.not_scored) {
      if (!fit.acceptance.empty()) signals.push_back({&condition, i, {}, nullptr});
      continue;
    }
    for (const calib::LimitCheck& check : condition.limit_checks) {
      const auto same = std::find_if(signals.begin(), signals.end(), [&](const Judged& each) {
        return each.condition == &condition && each.channel == info(check.channel).key;
      });
      const Judged one{&condition, i, std::string(info(check.channel).key), &check};
      if (same == signals.end()) {
        signals.push_back(one);
      } else if (std::pair(one.verdict(), one.used()) > std::pair(same->verdict(), same->used())) {
        *same = one;
      }
    }
  }
  std::stable_sort(signals.begin(), signals.end(), [](const Judged& a, const Judged& b) {
    return calib::shown_before(a.condition->use, a.how_bad(), b.condition->use, b.how_bad());
  });
  return signals;
}

/// Returns the estimates for the certificate, without nuisance parameters.
std::vector<const calib::FittedParameter*> signed_estimates(const StoredFit& fit) {
  std::vector<const calib::FittedParameter*> found;
  for (const calib::FittedParameter& p : fit.parameters)
    if (p.fitted && !p.nuisance) found.push_back(&p);
  return found;
}

/// Returns, for example, "with at most 13 % of the permitted error".
std::string tolerance_words(const std::vector<Judged>& signals) {
  double used = 0.0;
  for (const Judged& each : signals) used = std::max(used, each.used());
  return fmt::format("with at most {} of the permitted error", calib::tolerance_used_text(used));
}

/// Adds how well the identified parameters are known, and how many are not identified.
void add_grades(const StoredFit& fit, Line& sentence) {
  double widest = 0.0;
  std::size_t identified = 0;
  std::size_t bounded = 0;
  const auto found = signed_estimates(fit);
  for (const calib::FittedParameter* p : found) {
    // A bounded parameter is described by its limit, not by a half-width.
    if (p->identifiability == calib::Identifiability::bounded) ++bounded;
    if (p->identifiability != calib::Identifiability::identified) continue;
    widest = std::max(widest, relative_half_width(*p));
    ++identified;
  }
  if (identified == 0 || !is_determined(widest)) return;
  const std::size_t all = found.size();
  const std::size_t weak = all - identified - bounded;
  const std::string which = all == 1            ? std::string("The one parameter is")
                            : identified == all ? fmt::format("All {} parameters are", all)
                                                : fmt::format("{} of {} parameters {}", identified,
                                                              all, identified == 1 ? "is" : "are");
  sentence.emplace_back(fmt::format(" {} determined to {}{}", which, half_width_text(widest),
                                    identified == 1 ? "" : " or better"));
  if (weak > 0)
    sentence.emplace_back(
        fmt::format("; {} {} not well determined", weak, weak == 1 ? "is" : "are"));
  if (bounded > 0)
    sentence.emplace_back(
        identified + bounded == all
            ? std::string(bounded > 1 ? ", the others bounded" : ", the other is bounded")
            : fmt::format(", {} bounded", bounded));
  sentence.emplace_back(".");
}

/// Adds to a sentence how many signals the model reproduces and how well its parameters are known.
void add_numbers(const StoredFit& fit, Line& sentence) {
  const std::vector<Judged> signals = judged_signals(fit);
  if (!signals.empty()) {
    std::vector<std::string> unseen;
    for (const Judged& each : signals) {
      const std::string& id = each.condition->id;
      if (each.held_back() && (unseen.empty() || unseen.back() != id)) unseen.push_back(id);
    }
    sentence.emplace_back(
        signals.size() == 1 ? std::string("The model reproduces the test signal")
        : signals.size() == 2
            ? std::string("The model reproduces both test signals")
            : fmt::format("The model reproduces all {} test signals", signals.size()));
    if (is_fit_schema(fit.schema) && !unseen.empty()) {
      constexpr std::size_t kNamed = 2;
      const auto of_these = std::count_if(signals.begin(), signals.end(),
                                          [](const Judged& each) { return each.held_back(); });
      sentence.emplace_back(", ");
      sentence.emplace_back(doc::Strong{
          unseen.size() > kNamed ? fmt::format("{} of them not used in the fit", of_these)
                                 : fmt::format("{} of them ({}) not used in the fit", of_these,
                                               fmt::join(unseen, ", "))});
      sentence.emplace_back(",");
    }
    sentence.emplace_back(" " + tolerance_words(signals) + ".");
  }
  add_grades(fit, sentence);
}

doc::Verdict failed_verdict(const StoredFit& fit) {
  const auto failed = std::count_if(fit.conditions.begin(), fit.conditions.end(),
                                    [](const auto& each) { return each.verdict == Verdict::fail; });
  Line sentence;
  if (failed == 0) {
    sentence.emplace_back(
        "A limit of the campaign could not be evaluated: the model is not validated.");
  } else {
    sentence.emplace_back(fmt::format(
        "{} of {} conditions {} outside the campaign's limits: the model is not validated.", failed,
        fit.conditions.size(), failed == 1 ? "is" : "are"));
  }
  const std::vector<Judged> signals = judged_signals(fit);
  const auto worst =
      std::max_element(signals.begin(), signals.end(),
                       [](const Judged& a, const Judged& b) { return a.how_bad() < b.how_bad(); });
  if (worst != signals.end() && worst->check != nullptr && worst->check->value &&
      worst->check->limit) {
    sentence.emplace_back(
        fmt::format(" The worst, {} of {}, has {} {} (limit {:.6g}).", spaced(worst->channel),
                    worst->condition->id, spaced(worst->check->metric),
                    doc::score(worst->check->metric, worst->check->value, worst->check->limit).text,
                    *worst->check->limit));
  }
  return {{State::bad, "FAIL"}, std::move(sentence)};
}

/// Returns a reason with a link to its evidence and the number of similar ones.
Line doubt_line(const StoredFit& fit, const calib::Reason& reason, const char* section,
                std::size_t others) {
  Line line{doc::Link{"#" + evidence_of(fit, reason, section), reason.words}};
  if (others > 0) line.emplace_back(fmt::format(" (and {} more of this kind)", others));
  return line;
}

/// Returns true for reasons that the small print below the calibrated values states.
bool is_below_values(const calib::Reason& reason) {
  return reason.code == "exact_values" || reason.code == "unseen_error";
}

/// Collects one doubt of each kind, the most serious first: reasons against the result, notes, and
/// warnings.
doc::Doubts doubts_of(const StoredFit& fit) {
  doc::Doubts doubts;
  std::vector<std::pair<AspectState, Line>> found;
  if (fit.assessment) {
    for (const AspectName& aspect : kAspects) {
      const std::vector<calib::Reason>& reasons = ((*fit.assessment).*aspect.aspect).reasons;
      for (std::size_t i = 0; i < reasons.size(); ++i) {
        const calib::Reason& reason = reasons[i];
        // Two reasons are not doubts: exact values are listed below the table of values, and
        // "further_starts" only reports that further starts were evaluated.
        if (reason.state == AspectState::pass || is_below_values(reason) ||
            reason.code == "further_starts")
          continue;
        const auto same = [&](const calib::Reason& other) {
          return other.code == reason.code && other.state == reason.state;
        };
        const auto here = reasons.begin() + static_cast<std::ptrdiff_t>(i);
        if (std::any_of(reasons.begin(), here, same)) continue;
        const auto others = static_cast<std::size_t>(std::count_if(here + 1, reasons.end(), same));
        found.emplace_back(reason.state, doubt_line(fit, reason, aspect.link, others));
      }
    }
  }
  const auto gravity = [](AspectState state) {
    switch (state) {
      case AspectState::fail:
        return 0;
      case AspectState::not_assessed:
      case AspectState::reservation:
        return 1;
      case AspectState::note:
      case AspectState::pass:
        return 2;
    }
    return 2;
  };
  std::stable_sort(found.begin(), found.end(), [&](const auto& a, const auto& b) {
    return gravity(a.first) < gravity(b.first);
  });
  // Agreement and validation may give the same reason.
  std::vector<std::string> listed;
  for (auto& [state, line] : found) {
    std::string words = std::get<doc::Link>(line.front()).words;
    if (std::find(listed.begin(), listed.end(), words) != listed.end()) continue;
    listed.push_back(std::move(words));
    doubts.items.push_back(std::move(line));
  }
  if (doubts.items.size() > kDoubts) {
    const std::size_t more = doubts.items.size() - kDoubts;
    doubts.items.resize(kDoubts);
    doubts.items.push_back({doc::Link{"#assessment", fmt::format("{} more points", more)}});
  }
  const std::vector<std::string> warnings = warnings_to_show(fit);
  if (!warnings.empty()) {
    Line line{doc::Link{"#warnings", plural(warnings.size(), "warning")}, ": "};
    line.emplace_back(warnings.front());
    if (warnings.size() > 1) line.emplace_back(" …");
    doubts.warnings = std::move(line);
  }
  return doubts;
}

/// Returns the number of printed lines, with the heading.
std::size_t printed_lines(const doc::Doubts& doubts) {
  constexpr std::size_t kCharacters = 115;  // on a line of the first sheet
  std::size_t lines = 0;
  const auto add = [&](const Line& line) {
    std::size_t characters = 0;
    for (const doc::Inline& part : line) {
      if (const auto* link = std::get_if<doc::Link>(&part)) characters += link->words.size();
      if (const auto* text = std::get_if<std::string>(&part)) characters += text->size();
    }
    lines += characters / kCharacters + 1;
  };
  for (const Line& line : doubts.items) add(line);
  if (doubts.warnings) add(*doubts.warnings);
  return lines == 0 ? 0 : lines + 1;
}

/// Returns half the length of an interval that is symmetric about the value. Returns std::nullopt
/// if it is asymmetric or unknown.
std::optional<double> expanded_uncertainty(const calib::FittedParameter& p,
                                           const doc::Interval& interval) {
  constexpr double kSymmetric = 0.01;
  const auto& ends = interval.ends;
  if (!ends || !std::isfinite(p.value)) return std::nullopt;
  const double below = p.value - ends->low;
  const double above = ends->high - p.value;
  if (!(std::abs(above - below) <= kSymmetric * std::max(above, below))) return std::nullopt;
  return 0.5 * (above + below);
}

/// Returns the expanded uncertainty U divided by the standard error it was derived from.
std::optional<double> coverage_factor(const calib::FittedParameter& p) {
  if (p.budget) return p.budget->coverage_factor;
  const auto half = expanded_uncertainty(p, p.ci95);
  const auto error = interval_error(p);
  if (!half || !error || !(error->standard_error > 0.0)) return std::nullopt;
  return *half / error->standard_error;
}

/// Formats the uncertainty as "± 0.05", or as both ends if the interval is asymmetric.
Line uncertainty_line(const calib::FittedParameter& p, const doc::Interval& interval,
                      const ReadableUnit& unit) {
  if (const auto half = expanded_uncertainty(p, interval))
    return {"± ", doc::Quantity{half, uncertainty_text(*half / unit.si, p.value / unit.si)}};
  const doc::Estimate estimate =
      doc::estimate(p.value, interval, unit.si,
                    {p.lower.value_or(kAnywhere.low), p.upper.value_or(kAnywhere.high)});
  return estimate.has_interval ? estimate.interval() : Line{"–"};
}

/// Keeps a short text, such as "33.33 %", on one line.
std::string unbroken(std::string text) {
  constexpr std::string_view kNoBreakSpace = "\u00a0";
  for (std::size_t i = 0; (i = text.find(' ', i)) != std::string::npos; i += kNoBreakSpace.size())
    text.replace(i, 1, kNoBreakSpace);
  return text;
}

/// @param both  whether to include the uncertainty that would apply if the model were exact
doc::Row value_row(const calib::FittedParameter& p, bool judged, bool both) {
  const ReadableUnit unit = unit_of(p);
  const doc::Estimate estimate =
      doc::estimate(p.value, judged ? p.ci95 : std::nullopt, unit.si,
                    {p.lower.value_or(kAnywhere.low), p.upper.value_or(kAnywhere.high)});
  Line name{capitalised(spaced(p.key)), " ", doc::Symbol{p.symbol}};
  if (p.level) name.emplace_back(", " + unbroken(*p.level));
  doc::Row row{{{std::move(name)},
                estimate.value,
                {judged ? uncertainty_line(p, p.ci95, unit) : Line{"–"}}}};
  if (both) row.cells.push_back({uncertainty_line(p, p.ci95_if_exact, unit)});
  row.cells.push_back(unit.name);
  row.cells.push_back(doc::badge(p.identifiability, p.at_bound, judged));
  return row;
}

/// Returns, for example, "k = 1.96" or "k = 1.96 to 2.1"; empty if no value has an expanded
/// uncertainty.
std::string coverage_words(const std::vector<const calib::FittedParameter*>& found) {
  double least = HUGE_VAL;
  double largest = 0.0;
  for (const calib::FittedParameter* p : found) {
    const auto k = coverage_factor(*p);
    if (!k) continue;
    least = std::min(least, *k);
    largest = std::max(largest, *k);
  }
  if (largest == 0.0) return {};
  const std::string low = fmt::format("{:.3g}", least);
  const std::string high = fmt::format("{:.3g}", largest);
  return low == high ? fmt::format("k = {}, ", low) : fmt::format("k = {} to {}, ", low, high);
}

/// Adds the calibrated values. A validation that did not estimate anything has none.
void add_values(const StoredFit& fit, bool judged, doc::Blocks& blocks) {
  std::vector<const calib::FittedParameter*> found = signed_estimates(fit);
  if (found.empty()) return;
  const std::size_t more = found.size() > kValues ? found.size() - kValues : 0;
  // The least certain values come first because the table is truncated.
  if (more > 0)
    std::stable_sort(found.begin(), found.end(), [](const auto* a, const auto* b) {
      return relative_half_width(*a) > relative_half_width(*b);
    });
  found.resize(found.size() - more);
  blocks.emplace_back(doc::Heading{
      {judged
           ? fmt::format("Result: calibrated values with expanded uncertainty U ({}coverage 95 %)",
                         coverage_words(found))
           : std::string("Best values so far: no uncertainty is known")},
      2});
  doc::Table table{"Calibrated values"};
  table.shape = doc::Table::Shape::cards;
  table.style = "values";
  const bool both = judged && std::any_of(found.begin(), found.end(),
                                          [](const auto* p) { return p->budget.has_value(); });
  const bool has_skewed =
      judged && std::any_of(found.begin(), found.end(), [](const auto* p) {
        return doc::Interval(p->ci95).ends && !expanded_uncertainty(*p, p->ci95);
      });
  table.columns = {{"Quantity"},
                   {"Value", doc::Column::Kind::number},
                   {has_skewed ? "U, or 95 % interval" : "U"}};
  if (both) table.columns.push_back({"U if the model is exact"});
  table.columns.push_back({"Unit", doc::Column::Kind::unit});
  table.columns.push_back({"Determined?"});
  for (const calib::FittedParameter* p : found) table.rows.push_back(value_row(*p, judged, both));
  blocks.emplace_back(std::move(table));
  Line notes;
  if (both) {
    notes.emplace_back("U counts small effects that the model leaves out (");
    notes.emplace_back(doc::Link{"#parameters", "budget"});
    notes.emplace_back("). ");
  }
  if (more > 0) {
    notes.emplace_back(doc::Link{"#parameters", plural(more, "more value")});
    notes.emplace_back(", each with a smaller relative uncertainty. ");
  }
  if (fit.assessment) {
    for (const calib::Reason& reason : fit.assessment->parameters.reasons)
      if (is_below_values(reason)) notes.emplace_back(capitalised(reason.words) + ". ");
  }
  const std::string correlated =
      correlation_words(correlation_by_key(fit.correlation, fit.parameters));
  if (!correlated.empty()) notes.emplace_back(correlated);
  if (!notes.empty())
    blocks.emplace_back(doc::Paragraph{std::move(notes), doc::Paragraph::Tone::small});
}

/// Plots the residual of a whole record against the band that its limit allows.
Plot residual_strip(const Judged& signal, const std::vector<double>& residual, double allowed) {
  constexpr std::size_t kColumns = 250;  // width in pixels
  Plot plot{fmt::format("Measured minus model, {} of {}, whole record", spaced(signal.channel),
                        signal.condition->id),
            {},
            {},
            static_cast<double>(kColumns),
            40.0};
  plot.bare = true;
  Trace band = empty_trace(Trace::Kind::band, "allowed");
  const auto last = static_cast<double>(residual.size());
  if (allowed > 0.0) {
    band.x = {0.0, last};
    band.y = {-allowed, -allowed};
    band.upper = {allowed, allowed};
    plot.traces.push_back(std::move(band));
  }
  Trace trace = empty_trace(Trace::Kind::line, "residual");
  Bars bars = column_bars(residual, kColumns);
  trace.x = std::move(bars.x);
  trace.y = std::move(bars.y);
  plot.traces.push_back(std::move(trace));
  return plot;
}

/// Returns the finite samples of one column of a channel that are inside the windows.
std::vector<double> counted_samples(const Table& series, const std::string& column) {
  const auto* values = series.find(column);
  const auto* in_window = series.find("in_window");
  std::vector<double> kept;
  if (values == nullptr) return kept;
  for (std::size_t i = 0; i < values->size(); ++i) {
    const bool counts = in_window == nullptr || (*in_window)[i] != 0.0;
    if (counts && std::isfinite((*values)[i])) kept.push_back((*values)[i]);
  }
  return kept;
}

std::string signal_words(const calib::ConditionResult& condition) {
  std::string text;
  const auto add = [&](const std::string& word) {
    if (!word.empty()) text += (text.empty() ? "" : ", ") + word;
  };
  if (condition.waveform) add(std::string(to_string(*condition.waveform)));
  if (condition.frequency_hz) add(readable(*condition.frequency_hz, "Hz", 4));
  if (condition.amplitude_m) add(readable(*condition.amplitude_m, "m", 4));
  if (condition.leak_level) add("leak " + *condition.leak_level);
  return text;
}

/// Returns the range on the value's side of a limit. A rounded score must remain in it.
Range side_of_limit(double value, const std::optional<double>& limit) {
  if (!limit) return kAnywhere;
  return value <= *limit ? Range{kAnywhere.low, *limit}
                         : Range{std::nextafter(*limit, HUGE_VAL), kAnywhere.high};
}

/// Adds the score in the deciding check: "rho2 0.9987 ± 0.0002, limit 0.99".
void add_score(const Judged& signal, doc::Cell& cell) {
  const calib::LimitCheck& check = *signal.check;
  const bool is_error = check.metric == "absolute_error_percent";
  doc::Quantity printed = doc::score(check.metric, check.value, check.limit);
  Line limit;
  const calib::ChannelScore* score = signal.condition->find(signal.channel);
  if (const auto* known = score == nullptr ? nullptr : score->printed_uncertainty()) {
    for (const metrics::MetricSpec& metric : metrics::kMetrics) {
      const double half = known->*metric.value;
      if (metric.name != check.metric || !std::isfinite(half)) continue;
      limit = {"U ", doc::Quantity{half, uncertainty_text(half, check.value.value_or(0.0))}, ", "};
      if (is_error && check.value)
        printed.text = matched(*check.value, half, side_of_limit(*check.value, check.limit));
    }
  }
  if (check.limit) {
    limit.emplace_back("limit ");
    limit.emplace_back(doc::in_unit(check.limit, 1.0, 6));
  }
  cell.line = {is_error ? "error % " : spaced(check.metric) + " ", std::move(printed)};
  cell.below = {std::move(limit)};
}

doc::Row signal_row(const Calibration& stored, const Judged& signal) {
  const calib::ConditionResult& condition = *signal.condition;
  doc::Cell name{Line{doc::Link{"#" + anchor(condition.id), condition.id}}};
  const std::string whose = signal_words(condition);
  Line use{doc::Aside{whose + (whose.empty() ? "" : " · ")}};
  if (!signal.channel.empty()) use.emplace_back(spaced(signal.channel) + " · ");
  if (signal.held_back())
    use.emplace_back(doc::Strong{"held back"});
  else
    use.emplace_back("used in the fit");
  name.below = {std::move(use)};
  doc::Cell strip, rms, score, used;
  if (signal.check == nullptr) {
    strip = {Line{doc::Badge{State::bad, condition.failure ? "not simulated" : "not scored"}}};
    return {{std::move(name), std::move(strip), rms, score, used}};
  }
  const std::shared_ptr<const Table> series = stored.series(signal.number);
  const auto known = datasets::channel_from_key(signal.channel);
  const std::string column = known ? std::string(datasets::info(*known).name) : signal.channel;
  const std::vector<double> residual = counted_samples(*series, "residual_" + column);
  double allowed = 0.0;
  for (const calib::LimitCheck& check : condition.limit_checks) {
    if (info(check.channel).key == signal.channel && check.metric == "rho2" && check.limit)
      allowed = metrics::allowed_rms(counted_samples(*series, "measured_" + column), *check.limit);
  }
  if (!residual.empty()) strip.picture = residual_strip(signal, residual, allowed);
  if (const calib::ChannelScore* found = condition.find(signal.channel)) {
    rms.line = {doc::readable(found->metrics.rmse, channel_unit(signal.channel), 3)};
    if (allowed > 0.0) rms.below = {{"limit ", readable(allowed, channel_unit(signal.channel), 2)}};
  }
  add_score(signal, score);
  used.portion = signal.used();
  Line words;
  if (signal.verdict() != Verdict::pass) words = {doc::badge(signal.verdict()), " "};
  words.emplace_back(calib::tolerance_used_text(signal.used()) + " of the tolerance");
  used.below = {std::move(words)};
  return {{std::move(name), std::move(strip), std::move(rms), std::move(score), std::move(used)}};
}

/// Returns, for example, "Not judged, no limit agreed: load pressure (lowest rho2 0.973,
/// sine_3Hz)."
std::string not_judged_words(const StoredFit& fit) {
  std::vector<std::string> found;
  std::vector<std::string> seen;
  for (const calib::ConditionResult& condition : fit.conditions) {
    for (const calib::ChannelScore& each : condition.channels) {
      const std::string channel(each.key());
      if (condition.verdict_of(channel) ||
          std::find(seen.begin(), seen.end(), channel) != seen.end())
        continue;
      seen.push_back(channel);
      const calib::ConditionResult* lowest = nullptr;
      double least = HUGE_VAL;
      for (const calib::ConditionResult& other : fit.conditions) {
        const calib::ChannelScore* score =
            other.verdict_of(channel) ? nullptr : other.find(channel);
        if (score == nullptr || !(score->metrics.rho2 < least)) continue;
        least = score->metrics.rho2;
        lowest = &other;
      }
      found.push_back(spaced(channel) + (lowest == nullptr
                                             ? std::string()
                                             : fmt::format(" (lowest rho2 {}, {})",
                                                           agreement_text(least), lowest->id)));
    }
  }
  if (found.empty()) return {};
  return fmt::format("Recorded but not judged, because no limit was agreed: {}.",
                     fmt::join(found, "; "));
}

/// @param room  number of signals that the table lists
void add_signals(const Calibration& stored, std::size_t room, doc::Blocks& blocks) {
  const StoredFit& fit = stored.result;
  std::vector<Judged> signals = judged_signals(fit);
  const std::string not_judged = not_judged_words(fit);
  if (!signals.empty()) {
    blocks.emplace_back(doc::Heading{{"Agreement: residual of each signal against its limit",
                                      doc::Aside{" (grey: the rms that rho2 allows)"}},
                                     2});
    const std::size_t more = signals.size() > room ? signals.size() - room : 0;
    doc::Table table{"Agreement of each signal with its limit"};
    table.style = "signals";
    table.shape = doc::Table::Shape::cards;
    table.columns = {{"Signal"},
                     {"Measured − model, whole record"},
                     {"rms", doc::Column::Kind::number},
                     {"Score", doc::Column::Kind::number},
                     {"Used"}};
    for (std::size_t i = 0; i + more < signals.size(); ++i)
      table.rows.push_back(signal_row(stored, signals[i]));
    blocks.emplace_back(std::move(table));
    if (more > 0) {
      const auto beyond = static_cast<std::size_t>(
          std::count_if(signals.end() - static_cast<std::ptrdiff_t>(more), signals.end(),
                        [](const Judged& each) { return each.verdict() == Verdict::fail; }));
      blocks.emplace_back(doc::Paragraph{
          {doc::Link{"#matrix", plural(more, "more signal")},
           beyond == 0      ? std::string(", all within their limits.")
           : beyond == more ? std::string(", all outside their limits.")
                            : fmt::format(", {} of them outside their limits.", beyond)},
          doc::Paragraph::Tone::small});
    }
  }
  if (!not_judged.empty())
    blocks.emplace_back(doc::Paragraph{{not_judged}, doc::Paragraph::Tone::small});
}

void add_aspects(const StoredFit& fit, doc::Blocks& blocks) {
  if (!fit.assessment) return;
  blocks.emplace_back(doc::Heading{{"Why this verdict"}, 2});
  doc::Aspects aspects;
  for (const AspectName& aspect : kAspects) {
    const calib::Aspect& found = (*fit.assessment).*aspect.aspect;
    doc::Aspects::Aspect one{doc::badge(found.state), aspect.short_name, {}};
    const auto against = static_cast<std::size_t>(
        std::count_if(found.reasons.begin(), found.reasons.end(), [&](const calib::Reason& each) {
          return calib::is_against(each.state) && each.state == found.state;
        }));
    const auto in_favour =
        std::find_if(found.reasons.begin(), found.reasons.end(),
                     [](const calib::Reason& each) { return each.state == AspectState::pass; });
    if (against > 0)
      one.lines.push_back({doc::Link{"#assessment", found.state == AspectState::fail
                                                        ? "fails for " + plural(against, "reason")
                                                        : plural(against, "reservation")}});
    if (in_favour != found.reasons.end())
      one.lines.push_back({in_favour->words});
    else if (against == 0)
      one.lines.push_back({one.badge.words});
    aspects.aspects.push_back(std::move(one));
  }
  blocks.emplace_back(std::move(aspects));
}

/// Formats the range of one quantity in the fitted conditions and in the validation.
std::string coverage_text(const std::optional<Range>& fitted, const std::optional<Range>& validated,
                          std::string_view unit) {
  if (!validated || (fitted && fitted->low == validated->low && fitted->high == validated->high))
    return in_words(*fitted, unit);
  if (!fitted) return fmt::format("validated {}", in_words(*validated, unit));
  return fmt::format("fitted {}, validated {}", in_words(*fitted, unit),
                     in_words(*validated, unit));
}

/// Adds the decision rule and the range of validity, or the tested range if there was no
/// validation.
void add_scope(const StoredFit& fit, doc::Blocks& blocks) {
  if (!fit.acceptance.empty()) {
    const auto rule = fit.decision.value_or(datasets::DecisionRule::simple);
    blocks.emplace_back(doc::Paragraph{{fmt::format("Decision rule: {} (ISO/IEC 17025, 7.8.6). {}",
                                                    calib::words_of(rule), rule_words(rule))},
                                       doc::Paragraph::Tone::small});
  }
  if (fit.status == FitStatus::failed) return;
  std::vector<std::string> ranges;
  const auto add = [&](std::optional<Range> calib::Validity::*range, const char* name,
                       std::string_view unit) {
    const std::optional<Range>& fitted = fit.validity.*range;
    // For a validation without a fit, `validity` already contains the ranges.
    const std::optional<Range> validated =
        is_fit_schema(fit.schema) && fit.validated ? (*fit.validated).*range : std::nullopt;
    if (fitted || validated)
      ranges.push_back(fmt::format("{} {}", name, coverage_text(fitted, validated, unit)));
  };
  add(&calib::Validity::frequency_hz, "frequency", "Hz");
  if (ranges.empty()) ranges.emplace_back("frequency not stated: the signals are recorded ones");
  add(&calib::Validity::amplitude_m, "amplitude (half of peak to peak)", "m");
  add(&calib::Validity::amplitude_v, "amplitude (half of peak to peak)", "V");
  add(&calib::Validity::supply_pressure_pa, "supply pressure", "Pa");
  add(&calib::Validity::leakage_coefficient, "leakage coefficient", "1");
  if (!fit.validity.leak_levels.empty())
    ranges.push_back(fmt::format("leak levels {}", fmt::join(fit.validity.leak_levels, ", ")));
  const bool valid = is_fit_schema(fit.schema) && fit.assessment &&
                     calib::has_range_of_validity(fit.assessment->agreement.state,
                                                  fit.assessment->validation.state);
  blocks.emplace_back(
      doc::Paragraph{{doc::Strong{valid ? "Validated for: " : "Conditions tested: "},
                      fmt::format("{}.", fmt::join(ranges, "; "))},
                     doc::Paragraph::Tone::small});
}

}  // namespace

doc::Verdict fit_verdict(const StoredFit& fit) {
  const auto unfinished = [&](doc::Badge badge, const std::string& sentence) {
    doc::Verdict verdict{std::move(badge), {sentence}};
    add_reason(verdict, fit.message, "starts");
    return verdict;
  };
  if (fit.status == FitStatus::failed) return unfinished({State::bad, "FAILED"}, kNoUsableResult);
  const bool stopped = fit.status == FitStatus::stopped;
  if (stopped && !searched_to_the_end(fit))
    return unfinished({State::bad, "STOPPED"}, stopped_sentence(calib::StoppedIn::starts));
  if (fit.verdict == Verdict::fail) {
    doc::Verdict verdict = failed_verdict(fit);
    if (stopped) add_reason(verdict, fit.message, "starts");
    return verdict;
  }
  // FAIL comes first, because an exceeded limit remains exceeded whatever was left unfinished.
  if (stopped) return unfinished({State::warn, "STOPPED"}, stopped_sentence(*fit.stopped_in));
  if (fit.verdict) {
    doc::Verdict verdict{doc::badge(*fit.verdict), {}};
    if (fit.verdict == Verdict::warn)
      verdict.sentence.emplace_back(
          fmt::format("Passed with reservations ({}). ", open_aspects(fit)));
    add_numbers(fit, verdict.sentence);
    return verdict;
  }
  if (names_reason(fit, &calib::Assessment::agreement, "poor_agreement"))
    return {{State::bad, "POOR"},
            {"No limits were given, but the model does not describe the records."}};
  return {{State::none, "NOT JUDGED"},
          {fit.conditions.empty() ? "No condition was scored."
                                  : "The campaign sets no limits, so the result was not judged."}};
}

doc::Blocks certificate(const Calibration& stored) {
  const StoredFit& fit = stored.result;
  const bool unfinished = fit.status == FitStatus::stopped && !searched_to_the_end(fit);
  doc::Blocks blocks;
  doc::Doubts doubts = doubts_of(fit);
  const std::size_t room =
      signals_with_room(printed_lines(doubts), std::min(signed_estimates(fit).size(), kValues),
                        fit.report.is_object() && !fit.report.empty());
  blocks.emplace_back(std::move(doubts));
  if (fit.status != FitStatus::failed) add_values(fit, !unfinished, blocks);
  add_signals(stored, room, blocks);
  add_aspects(fit, blocks);
  add_scope(fit, blocks);
  return blocks;
}

}  // namespace rigcal::report
