#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "common/calendar.hpp"
#include "common/significant.hpp"
#include "diagnosis/machine/state_verdict.hpp"
#include "report/document/words.hpp"
#include "report/page/budget_tables.hpp"
#include "report/page/page_parts.hpp"
#include "report/text/gathered_warnings.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

using doc::Line;
using Kind = doc::Column::Kind;

using datasets::LeakClass;
using diagnosis::ClassLimit;
using diagnosis::Diagnosis;
using diagnosis::MachineState;
using diagnosis::RecordDiagnosis;
using diagnosis::SmallestLeak;
using diagnosis::StatedSettings;

std::string class_text(const std::optional<LeakClass>& leak_class) {
  return leak_class ? std::string(to_string(*leak_class)) : std::string();
}

/// Badge for a leak below zero: supply or valve differ from the fit.
const doc::Badge kIncompatible{doc::State::bad, "incompatible with the model"};

doc::Badge leak_badge(const RecordDiagnosis& record) {
  if (record.failure) return {doc::State::bad, "not fitted"};
  if (record.is_reference) return {doc::State::none, "reference"};
  if (record.leak.compatible_with_model == false) return kIncompatible;
  if (record.explained_by_leak == false) return {doc::State::bad, "not explained by a leak"};
  if (!record.leak.class_) return {doc::State::none, "undecided"};
  return doc::badge(*record.leak.class_);
}

/// Returns a cell with a value in a unit and its 95 % interval below it.
doc::Cell value_cell(const std::optional<double>& value, const std::optional<Range>& interval,
                     double si_per_unit = 1.0, int digits = 4) {
  doc::Cell cell{Line{doc::in_unit(value, si_per_unit, digits)}};
  const auto& ends = doc::Interval(interval).ends;
  if (!ends) return cell;
  const double middle = 0.5 * (ends->low + ends->high);
  cell.below = {doc::estimate(middle, *ends, si_per_unit).interval()};
  return cell;
}

doc::Cell probability_cell(const std::optional<double>& p) {
  doc::Cell cell{Line{doc::decimals(p, 3)}};
  cell.shade = -p.value_or(0.0);  // blue
  return cell;
}

/// @param classes  the classes that have a column
doc::Row average_row(const RecordDiagnosis& record, std::size_t number,
                     const std::vector<std::string>& classes) {
  doc::Cell name = doc::Cell(record.condition);
  if (record.is_reference) name.below = {{"reference"}};
  doc::Row row{{fmt::format("{}", number), std::move(name), leak_badge(record),
                value_cell(record.leak.leak_share_percent, record.leak.leak_share_ci95_percent),
                doc::in_unit(record.leak.leak_flow_l_per_min, 1.0, 3),
                value_cell(record.leak.leakage_coefficient, record.leak.ci95)}};
  for (const std::string& each : classes) {
    const auto* p = find(record.leak.class_probabilities, each);
    row.cells.push_back(probability_cell(p != nullptr ? *p : std::nullopt));
  }
  row.cells.push_back(class_text(record.class_by_features));
  row.cells.push_back(class_text(record.true_class));
  if (record.failure) row.notes = {*record.failure};
  return row;
}

doc::Row repeat_row(const RecordDiagnosis& record) {
  doc::Cell share = value_cell(record.leak.leak_share_percent, record.leak.leak_share_ci95_percent);
  Line interval;
  if (!share.below.empty()) interval = std::move(share.below.front());
  share.below.clear();
  return {{record.condition,
           record.repeat ? fmt::format("{}", *record.repeat) : std::string(),
           leak_badge(record),
           std::move(share),
           {std::move(interval)},
           doc::in_unit(record.leak.leak_flow_l_per_min, 1.0, 3),
           doc::in_unit(record.leak.leakage_coefficient, 1.0, 4),
           class_text(record.class_by_features),
           class_text(record.true_class)}};
}

/// The averages of one signal, in the order of the table.
struct SignalRecords {
  std::string signal;
  std::vector<const RecordDiagnosis*> records;
};

std::vector<SignalRecords> averages_by_signal(const Diagnosis& diagnosis) {
  std::vector<SignalRecords> signals;
  for (const RecordDiagnosis& record : diagnosis.records) {
    if (!record.is_average()) continue;
    auto found = std::find_if(signals.begin(), signals.end(), [&](const SignalRecords& each) {
      return each.signal == record.signal;
    });
    if (found == signals.end()) found = signals.insert(signals.end(), {record.signal, {}});
    found->records.push_back(&record);
  }
  return signals;
}

/// Plots the leak shares with their intervals by signal, and the limits of the classes. The records
/// of a signal lie side by side, in the order of the table.
Plot share_plot(const Diagnosis& diagnosis) {
  // Fraction of the room of a signal; the rest separates it from the next.
  constexpr double kUsed = 0.8;
  const std::vector<SignalRecords> signals = averages_by_signal(diagnosis);
  Plot plot{fmt::format("Share of the servo flow that leaks, with 95 % intervals and the limits of "
                        "the classes, by signal ({} in all)",
                        signals.size()),
            "signal", "share of the servo flow [%]"};
  plot.height = 252.0;
  Trace spans = empty_trace(Trace::Kind::intervals, "model");
  Trace middles = empty_trace(Trace::Kind::points, "model", "found");
  Trace known = empty_trace(Trace::Kind::points, "residual", "known");
  for (const SignalRecords& signal : signals) {
    plot.x_names.push_back(signal.signal);
    const double step = kUsed / static_cast<double>(signal.records.size());
    double place = static_cast<double>(plot.x_names.size()) - 0.5 * (kUsed + step);
    for (const RecordDiagnosis* record : signal.records) {
      place += step;
      if (record->true_share_percent) {
        known.x.push_back(place);
        known.y.push_back(*record->true_share_percent);
      }
      if (!record->leak.leak_share_percent) continue;
      middles.x.push_back(place);
      middles.y.push_back(*record->leak.leak_share_percent);
      add_interval(spans, place, record->leak.leak_share_ci95_percent);
    }
  }
  double most = 0.0;
  for (const double upper : spans.upper) most = std::max(most, upper);
  for (const double share : middles.y) most = std::max(most, share);
  for (const auto& [name, limit] : diagnosis.settings.limits_percent)
    if (limit > 0.0 && limit <= 1.2 * most) plot.levels.push_back(limit);
  plot.traces.push_back(std::move(spans));
  if (!known.x.empty()) plot.traces.push_back(std::move(known));
  plot.traces.push_back(std::move(middles));
  return plot;
}

/// Days on which a trend reaches the next limit, counted from its first date.
struct ForeseenDays {
  double reached = 0.0, earliest = 0.0, latest = 0.0;
};

/// Returns std::nullopt if no limit is foreseen.
///
/// @param first  first date of the trend, in days since 1970-01-01
/// @param end    last day that can be foreseen; replaces a later end, or one that is not known
std::optional<ForeseenDays> foreseen_days(const std::optional<diagnosis::NextLimit>& limit,
                                          int first, double end) {
  if (!limit) return std::nullopt;
  const auto reached = day_of(limit->reached);
  const auto earliest = day_of(limit->earliest);
  if (!reached || !earliest || *reached - first > end) return std::nullopt;
  const auto latest = limit->latest ? day_of(*limit->latest) : std::nullopt;
  return ForeseenDays{static_cast<double>(*reached - first), static_cast<double>(*earliest - first),
                      latest ? std::min<double>(*latest - first, end) : end};
}

bool is_of(const MachineState& state, const diagnosis::LeakTrend& trend) {
  return state.key.leak_level == trend.leak_level && state.key.specimen == trend.specimen;
}

/// Plots the shares of a machine over its dates with the rate of their change, and, if it is
/// foreseen, when they reach the next limit. Line and band pass through the last share, because the
/// days of the limit are counted from there. Returns std::nullopt without that share.
std::optional<Plot> leak_trend_plot(const Diagnosis& diagnosis, const diagnosis::LeakTrend& trend) {
  const auto first = day_of(trend.first_date);
  const auto last_day = day_of(trend.last_date);
  if (!first || !last_day) return std::nullopt;
  const double last = *last_day - *first;
  Trace spans = empty_trace(Trace::Kind::intervals, "model");
  Trace middles = empty_trace(Trace::Kind::points, "model", "found");
  std::optional<double> last_share;
  for (const MachineState& state : diagnosis.states) {
    const auto day = state.key.date && is_of(state, trend) ? day_of(*state.key.date) : std::nullopt;
    if (!day || !state.leak.leak_share_percent) continue;
    if (*day == *last_day) last_share = state.leak.leak_share_percent;
    middles.x.push_back(*day - *first);
    middles.y.push_back(*state.leak.leak_share_percent);
    add_interval(spans, middles.x.back(), state.leak.leak_share_ci95_percent);
  }
  if (!last_share) return std::nullopt;
  const auto foreseen = foreseen_days(trend.next_limit, *first, (1.0 + diagnosis::kAhead) * last);
  Plot plot{fmt::format(
                "Share of the servo flow that leaks from {} to {}, and its rate with the 95 % band",
                trend.first_date, trend.last_date),
            "days since " + trend.first_date, "share of the servo flow [%]", 460.0, 220.0};
  const auto share_at = [&](double day, double rate) { return *last_share + rate * (day - last); };
  Trace band = empty_trace(Trace::Kind::band, "model");
  Trace line = empty_trace(Trace::Kind::line, "reference");
  const Range& rates = trend.share_percent_per_day_ci95;
  for (const double day : {0.0, last, foreseen ? foreseen->latest : last}) {
    const double low = share_at(day, rates.low);
    const double high = share_at(day, rates.high);
    band.x.push_back(day);
    band.y.push_back(std::min(low, high));
    band.upper.push_back(std::max(low, high));
    line.x.push_back(day);
    line.y.push_back(share_at(day, trend.share_percent_per_day));
  }
  plot.traces = {std::move(band), std::move(line), std::move(spans), std::move(middles)};
  if (!foreseen) return plot;
  const double limit = trend.next_limit->percent;
  plot.title += fmt::format("; it reaches {} ({:g} %) about {}",
                            to_string(trend.next_limit->class_), limit, trend.next_limit->reached);
  plot.levels = {limit};
  Trace interval = empty_trace(Trace::Kind::line, "residual");
  interval.x = {foreseen->earliest, foreseen->latest};
  interval.y = {limit, limit};
  Trace reached = empty_trace(Trace::Kind::points, "residual",
                              fmt::format("reaches {}", to_string(trend.next_limit->class_)));
  reached.x = {foreseen->reached};
  reached.y = {limit};
  plot.traces.push_back(std::move(interval));
  plot.traces.push_back(std::move(reached));
  return plot;
}

struct MethodName {
  diagnosis::Accuracy diagnosis::Methods::*accuracy;
  const char* name;
};
constexpr std::array kMethods{
    MethodName{&diagnosis::Methods::fitted_leak_single, "Fitted leak, single repeats"},
    MethodName{&diagnosis::Methods::fitted_leak_averaged, "Fitted leak, averages"},
    MethodName{&diagnosis::Methods::features_leave_one_repeat_out,
               "Features of the paper, clusters without the repeat"},
    MethodName{&diagnosis::Methods::features_leave_one_signal_out,
               "Features of the paper, clusters without the signal"}};

doc::Row accuracy_row(const diagnosis::Accuracy& method, const char* name) {
  const auto percent = [](double value) { return doc::in_unit(100.0 * value, 1.0, 4); };
  doc::Cell accuracy;
  if (method.accuracy) accuracy.line = {percent(*method.accuracy)};
  if (const auto& ci = method.accuracy_ci95)
    accuracy.below = {{percent(ci->low), " … ", percent(ci->high)}};
  return {{name, fmt::format("{} of {}", method.right, method.records), std::move(accuracy),
           fmt::format("{}", method.undecided), fmt::format("{}", method.off_by_two_or_more)}};
}

/// Returns the confusion matrix of a classification method.
doc::Table confusion_table(const diagnosis::Accuracy& method, const char* name) {
  doc::Table table{fmt::format("Confusion: {}", name)};
  table.style = "correlation confusion";
  table.caption = {name};
  table.columns = {{"Known"}};
  const diagnosis::Confusion& confusion = method.confusion;
  for (const std::string& found : confusion.found) table.columns.push_back({found, Kind::number});
  for (std::size_t i = 0; i < confusion.counts.size(); ++i) {
    const auto& counts = confusion.counts[i];
    const long total = std::accumulate(counts.begin(), counts.end(), 0L);
    if (total == 0) continue;
    doc::Row row{{confusion.truth[i]}};
    for (std::size_t j = 0; j < counts.size(); ++j) {
      doc::Cell cell = doc::Cell(fmt::format("{}", counts[j]));
      const double fraction = static_cast<double>(counts[j]) / static_cast<double>(total);
      cell.shade = i == j ? -fraction : fraction;  // blue for correct classifications
      row.cells.push_back(std::move(cell));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// Returns the general warnings, followed by those of the records, without duplicates.
std::vector<std::string> diagnosis_warnings(const Diagnosis& diagnosis) {
  std::vector<std::pair<std::string, std::string>> by_record;
  for (const RecordDiagnosis& record : diagnosis.records) {
    const std::string name = record.is_average()
                                 ? record.condition
                                 : fmt::format("{} repeat {}", record.condition, *record.repeat);
    for (const std::string& warning : record.warnings) by_record.emplace_back(name, warning);
  }
  std::vector<std::string> list = diagnosis.warnings;
  for (std::string& line : gathered_by_text(by_record)) list.push_back(std::move(line));
  return list;
}

/// Lists the rows of the leak table that define the limits; empty if [diagnosis] defines them.
doc::Table limits_of_classes(const Diagnosis& diagnosis) {
  doc::Table table{"Coefficient at each limit, by signal"};
  table.columns = {{"Signal"},
                   {"Share, %", Kind::number},
                   {"Ends the class"},
                   {"Coefficient", Kind::number, 0, "95 % interval"}};
  for (const ClassLimit& limit : diagnosis.class_limits) {
    doc::Cell roots;
    for (std::size_t i = 0; i < limit.coefficients.size(); ++i) {
      doc::Cell root = value_cell(limit.coefficients[i], limit.coefficients_ci95[i]);
      Line& line = roots.paragraphs.emplace_back(std::move(root.line));
      if (root.below.empty()) continue;
      line.emplace_back(", ");
      for (doc::Inline& part : root.below.front()) line.push_back(std::move(part));
    }
    table.rows.push_back({{limit.signal, doc::in_unit(limit.share_percent, 1.0, 4),
                           class_text(limit.class_), std::move(roots)}});
  }
  return table;
}

doc::Badge state_badge(const MachineState& state) {
  if (state.is_reference) return {doc::State::none, "reference"};
  if (state.leak.compatible_with_model == false) return kIncompatible;
  if (state.leak.class_) return doc::badge(*state.leak.class_);
  return {doc::State::none, state.leak.leakage_coefficient ? "undecided" : "no verdict"};
}

std::string distance_text(const std::optional<diagnosis::LimitDistance>& limit) {
  if (!limit) return "";
  const double points = limit->distance_percentage_points;
  const std::string_view name = to_string(limit->class_);
  if (limit->on_limit) return fmt::format("on that of {} ({:g} %)", name, limit->percent);
  return fmt::format("{:.1f} points {} {} ({:g} %)", std::abs(points),
                     points < 0.0 ? "below" : "above", name, limit->percent);
}

std::string agreement_text_of(const std::optional<diagnosis::SignalsAgreement>& agreement) {
  if (!agreement) return "one signal";
  return fmt::format("{} ({})", agreement->agree ? "agree" : "disagree",
                     p_value_text(agreement->p));
}

/// Returns the heading of the column of fitted leaks.
std::string coefficient_heading(const StatedSettings& settings) {
  return settings.is_laminar() ? "Conductance, m³/(s Pa)" : "Coefficient";
}

doc::Table state_table(const Diagnosis& diagnosis) {
  constexpr double kSquareMillimetre = 1e-6;
  doc::Table table{"State of the machine"};
  table.style = "states";
  table.caption = {
      "State of the machine: all signals and repeats of a leak level, specimen and date together"};
  table.columns = {{"State"},
                   {"Class"},
                   {"Share, %", Kind::number, 0, "95 % interval"},
                   {"At the duty"},
                   {coefficient_heading(diagnosis.settings), Kind::number, 0, "95 % interval"},
                   {"Leak area, mm²", Kind::number, 0, "95 % interval"},
                   {"Nearest limit"},
                   {"Signals"}};
  for (const MachineState& state : diagnosis.states) {
    doc::Row row{{state.state, state_badge(state),
                  value_cell(state.leak.leak_share_percent, state.leak.leak_share_ci95_percent),
                  state.duty.value_or(""),
                  value_cell(state.leak.leakage_coefficient, state.leak.ci95),
                  value_cell(state.leak_area_m2, state.leak_area_ci95_m2, kSquareMillimetre),
                  distance_text(state.nearest_limit),
                  state.is_reference ? std::string() : agreement_text_of(state.agreement)}};
    if (!state.left_out.empty() && !state.is_reference) {
      std::string note = "Left out:";
      for (const std::string& each : state.left_out) note += " " + each + ".";
      row.notes = {std::move(note)};
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

doc::Badge badge_of(diagnosis::Finding finding) {
  switch (finding) {
    case diagnosis::Finding::leak:
      return {doc::State::warn, "LEAK"};
    case diagnosis::Finding::no_leak:
      return {doc::State::good, "NO LEAK"};
    case diagnosis::Finding::unclear:
      return {doc::State::warn, "UNCLEAR"};
    case diagnosis::Finding::not_judged:
      return {doc::State::none, "NOT JUDGED"};
  }
  return {};
}

doc::Verdict headline_of_states(const Diagnosis& diagnosis, const std::string& sentence) {
  doc::Verdict verdict{badge_of(diagnosis::finding_of(diagnosis.states)), {sentence}};
  for (const diagnosis::LeakTrend& trend : diagnosis.trends)
    if (trend.significant) add_reason(verdict, trend.sentence, "diagnosis");
  const std::vector<const MachineState*> states = judged_states(diagnosis.states);
  for (std::size_t i = 1; i < states.size(); ++i)
    add_reason(verdict, states[i]->sentence, "diagnosis");
  return verdict;
}

std::string diagnosis_sentence(const StoredDiagnosis& diagnosis) {
  if (diagnosis.status == LeakStatus::declined)
    return "These records cannot be diagnosed: do not use any leak below.";
  if (diagnosis.status == LeakStatus::failed)
    return "No record could be diagnosed: do not use any number below.";
  const std::vector<const MachineState*> states = judged_states(diagnosis.found.states);
  if (states.size() == 1) return states.front()->sentence;
  if (!states.empty()) {
    return fmt::format("Worst of {} states of the machine: {}", states.size(),
                       states.front()->sentence);
  }
  return "Every condition is the healthy reference of its signal: there is nothing to judge.";
}

}  // namespace

doc::Verdict diagnosis_headline(const StoredDiagnosis& diagnosis) {
  const std::string sentence = diagnosis_sentence(diagnosis);
  if (diagnosis.status == LeakStatus::done) return headline_of_states(diagnosis.found, sentence);
  return verdict_without_result(diagnosis.status, sentence, diagnosis.reasons, "diagnosis");
}

std::vector<Figure> diagnosis_figures(const StoredDiagnosis& diagnosis) {
  std::vector<Figure> figures;
  const Diagnosis& found = diagnosis.found;
  if (std::any_of(found.records.begin(), found.records.end(),
                  [](const auto& record) { return record.is_average(); }))
    figures.push_back({"diagnosis", share_plot(found)});
  for (const diagnosis::LeakTrend& trend : found.trends) {
    auto plot = leak_trend_plot(found, trend);
    if (!plot) continue;
    const std::string machine = trend.leak_level.value_or("") + " " + trend.specimen.value_or("");
    figures.push_back({plain_name("diagnosis_trend_" + machine), std::move(*plot)});
  }
  return figures;
}

namespace {

void add_averages(const Diagnosis& diagnosis, doc::Blocks& blocks) {
  doc::Table table{"Leak of each condition"};
  table.style = "diagnosis";
  table.caption = {"Average of each condition"};
  table.heading = 1;
  table.columns = {{"No.", Kind::number},
                   {"Condition"},
                   {"Class"},
                   {"Share, %", Kind::number, 0, "95 % interval"},
                   {"Leak, L/min", Kind::number},
                   {coefficient_heading(diagnosis.settings), Kind::number, 0, "95 % interval"}};
  std::vector<std::string> classes;
  if (!diagnosis.records.empty()) {
    for (const auto& [name, value] : diagnosis.records.front().leak.class_probabilities)
      classes.push_back(name);
  }
  for (const std::string& each : classes)
    table.columns.push_back({each, Kind::number, 0, "probability"});
  table.columns.push_back({"By features"});
  table.columns.push_back({"Known"});
  for (const RecordDiagnosis& record : diagnosis.records)
    if (record.is_average())
      table.rows.push_back(average_row(record, table.rows.size() + 1, classes));
  if (table.rows.empty()) return;
  blocks.emplace_back(
      figure_of(share_plot(diagnosis), "How large is the leak according to each signal?"));
  blocks.emplace_back(doc::about_picture(
      "The records of a signal are in the order of the table. Dashed: limits of the classes. Class "
      "by share; shading: probability of each class."));
  blocks.emplace_back(std::move(table));
}

void add_methods(const diagnosis::Methods& methods, doc::Blocks& blocks) {
  doc::Table accuracies{"How often each method is right"};
  accuracies.columns = {{"Method"},
                        {"Right", Kind::number},
                        {"Accuracy, %", Kind::number, 0, "95 % interval (Wilson)"},
                        {"Undecided", Kind::number},
                        {"Off by two classes or more", Kind::number}};
  doc::Fold confusions{"Which classes each method confuses", {}};
  for (const MethodName& each : kMethods) {
    const diagnosis::Accuracy& method = methods.*each.accuracy;
    if (method.records == 0) continue;
    accuracies.rows.push_back(accuracy_row(method, each.name));
    confusions.blocks.emplace_back(confusion_table(method, each.name));
  }
  if (accuracies.rows.empty()) return;
  blocks.emplace_back(doc::Heading{{"Comparison with the known classes"}});
  blocks.emplace_back(
      doc::reading("Undecided counts as an error. Intervals treat each condition as one trial."));
  blocks.emplace_back(std::move(accuracies));
  confusions.blocks.insert(
      confusions.blocks.begin(),
      doc::about_picture("Rows: known class; columns: assigned class. Blue is correct."));
  blocks.emplace_back(std::move(confusions));
}

void add_smallest_leaks(const Diagnosis& diagnosis, doc::Blocks& blocks) {
  if (diagnosis.smallest_leak_l_per_min.empty()) return;
  doc::Table table{"Smallest leaks"};
  table.caption = {
      fmt::format("Smallest leak detected ({:g} % false alarms, found in {:g} % of cases)",
                  100.0 * diagnosis.settings.false_alarms, 100.0 * diagnosis.settings.detection)};
  table.columns = {{"Signal"},
                   {"Single record, L/min", Kind::number},
                   {"Average, L/min", Kind::number},
                   {"Average, share %", Kind::number}};
  const auto& limits = diagnosis.smallest_leak_l_per_min;
  const bool another_day = std::any_of(limits.begin(), limits.end(), [](const auto& each) {
    return each.of_another_day.value_or(false);
  });
  if (another_day) {
    table.columns.push_back({"Same day, single", Kind::number});
    table.columns.push_back({"Same day, average", Kind::number});
  }
  table.columns.push_back({"Note"});
  for (const SmallestLeak& each : limits) {
    std::vector<doc::Cell> row{each.signal, doc::in_unit(each.single, 1.0, 3),
                               doc::in_unit(each.averaged, 1.0, 3),
                               doc::in_unit(each.averaged_share_percent, 1.0, 3)};
    if (another_day) {
      row.push_back(doc::in_unit(each.single_same_day, 1.0, 3));
      row.push_back(doc::in_unit(each.averaged_same_day, 1.0, 3));
    }
    row.push_back(each.reason.value_or(""));
    table.rows.push_back({std::move(row)});
  }
  if (another_day)
    blocks.emplace_back(
        doc::reading("The smallest detectable leaks apply to a record made on another day than its "
                     "reference; on the same day smaller ones are detected."));
  blocks.emplace_back(std::move(table));
}

void add_repeats(const Diagnosis& diagnosis, doc::Blocks& blocks) {
  doc::Table table{"Leak of each repeat"};
  table.columns = {{"Condition"},
                   {"Repeat", Kind::number},
                   {"Class"},
                   {"Share, %", Kind::number},
                   {"95 % interval", Kind::number},
                   {"Leak, L/min", Kind::number},
                   {coefficient_heading(diagnosis.settings), Kind::number},
                   {"By features"},
                   {"Known"}};
  for (const RecordDiagnosis& record : diagnosis.records)
    if (!record.is_average()) table.rows.push_back(repeat_row(record));
  if (!table.rows.empty()) blocks.emplace_back(doc::Fold{"Every repeat", {std::move(table)}});
}

/// Adds the contributions to the uncertainty of the shares of states and averages.
void add_share_budgets(const Diagnosis& diagnosis, doc::Blocks& blocks) {
  const ReadableUnit points{"%", 1.0};
  std::vector<BudgetOf> budgets;
  for (const MachineState& state : diagnosis.states)
    if (state.leak.share_budget)
      budgets.push_back({state.state, points, &*state.leak.share_budget});
  for (const RecordDiagnosis& record : diagnosis.records)
    if (record.is_average() && record.leak.share_budget)
      budgets.push_back({record.condition, points, &*record.leak.share_budget});
  if (budgets.empty()) return;
  doc::Fold fold{"Uncertainty budgets of the shares", {}};
  fold.blocks.emplace_back(doc::reading(
      "First-order contributions at the estimated share. The interval of a share follows from its "
      "full distribution, which is truncated at zero. The rows of a state are its conditions."));
  fold.blocks.emplace_back(budget_table("Share of", budgets));
  doc::Fold one_by_one = contributions("Share of", budgets);
  one_by_one.style = "screen";  // a line for each effect of each record would fill sheets of paper
  fold.blocks.emplace_back(std::move(one_by_one));
  blocks.emplace_back(std::move(fold));
}

}  // namespace

std::vector<doc::Section> diagnosis_sections(const StoredDiagnosis& diagnosis) {
  const Diagnosis& found = diagnosis.found;
  doc::Section section{"diagnosis", "Diagnosis"};
  doc::Blocks& blocks = section.blocks;
  if (diagnosis.status != LeakStatus::done)
    blocks.emplace_back(list_of(diagnosis.reasons, doc::State::warn));
  if (!found.states.empty()) blocks.emplace_back(state_table(found));
  if (!found.trends.empty()) {
    blocks.emplace_back(doc::Heading{{"Trend"}});
    doc::Gallery gallery;
    gallery.wide = true;
    for (const diagnosis::LeakTrend& trend : found.trends) {
      blocks.emplace_back(doc::reading(trend.sentence));
      auto plot = leak_trend_plot(found, trend);
      if (!plot) continue;
      const bool foreseen = !plot->levels.empty();
      gallery.figures.push_back(
          figure_of(std::move(*plot), foreseen ? "When does the leak reach the next limit?"
                                               : "Does the leak change?"));
    }
    if (!gallery.figures.empty()) {
      blocks.emplace_back(std::move(gallery));
      blocks.emplace_back(doc::about_picture(
          "Line and band: the rate of the trend and its 95 % interval, drawn through the last "
          "share. Blue: the day on which the next limit is expected to be reached, with its 95 % "
          "interval, if it can be predicted."));
    }
  }
  add_averages(found, blocks);
  add_share_budgets(found, blocks);
  add_methods(found.methods, blocks);
  if (!found.class_limits.empty())
    blocks.emplace_back(doc::Fold{"Limits of the classes, from the leak table",
                                  {limits_of_classes(found)},
                                  found.class_limits.size() <= kFew});
  add_smallest_leaks(found, blocks);
  const std::vector<std::string> warnings = diagnosis_warnings(found);
  if (!warnings.empty()) {
    blocks.emplace_back(doc::Heading{{"Warnings"}});
    blocks.emplace_back(list_of(warnings, doc::State::warn));
  }
  add_repeats(found, blocks);
  return {std::move(section)};
}

}  // namespace rigcal::report
