#include "report/text/terminal.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "calib/score/acceptance.hpp"
#include "common/significant.hpp"
#include "report/text/estimate_text.hpp"
#include "report/text/groups.hpp"
#include "report/text/readable.hpp"
#include "report/text/stopped_sentence.hpp"
#include "report/text/text_table.hpp"

namespace rigcal::report {
namespace {

using calib::AspectState;
using calib::FitStatus;
using calib::Verdict;
using datasets::Channel;
using Align = TextTable::Align;

std::string coloured(const std::string& text, const char* code, const Style& style) {
  return style.colour ? fmt::format("\x1b[{}m{}\x1b[0m", code, text) : text;
}

std::string coloured(Verdict verdict, const Style& style) {
  const char* code = verdict == Verdict::pass ? "32" : verdict == Verdict::warn ? "33" : "31";
  return coloured(std::string(to_string(verdict)), code, style);
}

/// The channel that is worst by the verdict on its limits, then by rho2; null if none was compared.
const calib::ChannelScore* worst_channel(const calib::ConditionScore& condition) {
  const auto badness = [&](const calib::ChannelScore& score) {
    const bool known = score.agreement && std::isfinite(score.agreement->rho2);
    return std::pair(condition.verdict_of(score.channel).value_or(Verdict::pass),
                     known ? -score.agreement->rho2 : -std::numeric_limits<double>::infinity());
  };
  const auto found = std::max_element(
      condition.channels.begin(), condition.channels.end(),
      [&](const auto& one, const auto& other) { return badness(one) < badness(other); });
  return found == condition.channels.end() ? nullptr : &*found;
}

std::set<Channel> compared_channels(const calib::Fit& fit) {
  std::set<Channel> channels;
  for (const calib::ConditionScore& condition : fit.conditions)
    for (const calib::ChannelScore& score : condition.channels) channels.insert(score.channel);
  return channels;
}

std::string percent(double value) { return fmt::format("{:.3f}", value); }

/// Sort key of a condition, larger for a worse one. Conditions without a score come last; the
/// others are sorted by verdict, then by used tolerance, or by error if there are no limits.
std::tuple<bool, Verdict, double> gravity_of(const calib::ConditionScore& score) {
  const bool lost = !score.failure.empty() || !score.not_scored.empty();
  double used = 0.0;
  for (const calib::LimitCheck& check : score.checks) used = std::max(used, check.used);
  if (score.checks.empty()) {
    for (const calib::ChannelScore& channel : score.channels)
      if (channel.agreement) used = std::max(used, channel.agreement->absolute_error_percent);
  }
  return {lost, score.verdict.value_or(Verdict::pass), used};
}

/// All conditions in order, or the worst ones if there is not enough room.
std::vector<const calib::ConditionScore*> shown_conditions(const calib::Fit& fit,
                                                           std::size_t most) {
  std::vector<const calib::ConditionScore*> shown;
  for (const calib::ConditionScore& score : fit.conditions) shown.push_back(&score);
  if (shown.size() <= most) return shown;
  std::stable_sort(shown.begin(), shown.end(),
                   [](const auto* a, const auto* b) { return gravity_of(*a) > gravity_of(*b); });
  shown.resize(most);
  return shown;
}

/// Says what a cut table omits; empty if nothing.
std::string more_text(std::size_t all, std::size_t most, const char* what) {
  if (all <= most) return {};
  return fmt::format("  and {} {} (--verbose shows all)\n", all - most, what);
}

/// @param several  whether several channels were compared, so that each row names its channel
TextTable condition_table(const Result& result, bool several, std::size_t most,
                          const Style& style) {
  std::vector<TextTable::Column> columns{{"condition"},
                                         {"use", Align::left, 2},
                                         {"waveform", Align::left, 7},
                                         {"frequency", Align::right, 6},
                                         {"leak level", Align::left, 5}};
  if (several) columns.push_back({"channel"});
  columns.insert(columns.end(), {{"rho2", Align::right},
                                 {"R", Align::right, 4},
                                 {"CCC", Align::right, 1},
                                 {"error %", Align::right},
                                 {"floor %", Align::right, 3},
                                 {"verdict"}});
  TextTable table(columns);
  for (const calib::ConditionScore* shown : shown_conditions(result.fit, most)) {
    const calib::ConditionScore& score = *shown;
    const datasets::Condition* condition = result.campaign.find(score.id);
    std::vector<std::string> row{score.id, std::string(to_string(score.use)), "-", "-", "-"};
    if (condition != nullptr) {
      row[2] = to_string(condition->waveform);
      if (condition->frequency_hz) row[3] = fmt::format("{:.6g} Hz", *condition->frequency_hz);
      row[4] = condition->leak_level.value_or("-");
    }
    const calib::ChannelScore* found = worst_channel(score);
    const bool scored = found != nullptr && found->agreement;
    if (several) row.emplace_back(found != nullptr ? info(found->channel).key : "-");
    row.push_back(scored ? agreement_text(found->agreement->rho2) : "-");
    row.push_back(scored ? agreement_text(found->agreement->r) : "-");
    row.push_back(scored ? agreement_text(found->agreement->ccc) : "-");
    row.push_back(scored ? percent(found->agreement->absolute_error_percent) : "-");
    row.push_back(scored && found->noise_floor ? percent(found->noise_floor->absolute_error_percent)
                                               : "-");
    row.push_back(!score.not_scored.empty() ? coloured("not scored", "33", style)
                  : !score.failure.empty()  ? coloured("not simulated", "31", style)
                  : score.verdict           ? coloured(*score.verdict, style)
                                            : "-");
    table.add(std::move(row));
  }
  return table;
}

/// Table with the worst channel, by rho2, of each group.
TextTable group_table(const std::vector<Group>& gathered, bool several, std::size_t most) {
  std::vector<TextTable::Column> columns{{"by"}, {"group"}, {"conditions", Align::right, 2}};
  if (several) columns.push_back({"channel"});
  columns.insert(columns.end(), {{"rho2", Align::right},
                                 {"R", Align::right, 5},
                                 {"CCC", Align::right, 4},
                                 {"error %", Align::right},
                                 {"worst rho2", Align::right, 1},
                                 {"worst error %", Align::right, 3}});
  TextTable table(columns);
  for (const Group& group : gathered) {
    if (table.rows() == most) break;
    const auto found = std::min_element(group.channels.begin(), group.channels.end(),
                                        [](const auto& one, const auto& other) {
                                          return one.second.worst.rho2 < other.second.worst.rho2;
                                        });
    if (found == group.channels.end()) continue;
    const GroupScore& score = found->second;
    std::vector<std::string> row{group.by == "leak_level" ? "leak level" : group.by, group.label,
                                 fmt::format("{}", score.conditions)};
    if (several) row.emplace_back(info(found->first).key);
    row.insert(row.end(),
               {agreement_text(score.mean.rho2), agreement_text(score.mean.r),
                agreement_text(score.mean.ccc), percent(score.mean.absolute_error_percent),
                agreement_text(score.worst.rho2), percent(score.worst.absolute_error_percent)});
    table.add(std::move(row));
  }
  return table;
}

/// Names what a narrow terminal omits.
std::string narrow_note(const TextTable& table, const char* file, const Style& style) {
  const std::vector<std::string> left_out = table.left_out(style.columns);
  if (left_out.empty()) return {};
  return wrapped(fmt::format("  columns hidden (narrow terminal): {}; see {}",
                             fmt::join(left_out, ", "), file),
                 style.columns, 2) +
         "\n";
}

/// @param judged  whether the search converged
std::string identifiability_text(const calib::FittedParameter& p, bool judged, const Style& style) {
  using calib::Identifiability;
  if (!judged) return coloured("not judged", "33", style);
  std::string text = p.identifiability == Identifiability::not_identifiable
                         ? "not identifiable"
                         : std::string(to_string(p.identifiability));
  if (p.at_bound) text += ", at a bound";
  const char* code = p.identifiability == Identifiability::not_identifiable           ? "31"
                     : p.at_bound || p.identifiability != Identifiability::identified ? "33"
                                                                                      : "32";
  return coloured(text, code, style);
}

/// Numbers of one parameter, all in the unit of its value.
std::string in_unit(double value_si, const ReadableUnit& unit, int digits) {
  if (!std::isfinite(value_si)) return "-";
  return significant(value_si / unit.si, digits);
}

std::string limits(double low, double high, const ReadableUnit& unit, int digits) {
  return fmt::format("{} .. {}", in_unit(low, unit, digits), in_unit(high, unit, digits));
}

/// The standard error on which the interval rests.
double error_of(const calib::FittedParameter& p) {
  return p.interval == calib::IntervalSource::robust_standard_error
             ? p.robust_standard_error.value_or(0.0)
             : p.standard_error.value_or(0.0);
}

/// One line per reason, with the names of the parameters that it applies to; "all" if it applies to
/// all of several parameters.
///
/// @param most  number of lines
std::string foot_notes(const std::vector<std::pair<std::string, std::string>>& reasons,
                       std::size_t parameters, std::size_t most, std::size_t columns) {
  std::string text;
  std::size_t told = 0;
  for (std::size_t i = 0; i < reasons.size() && told < most; ++i) {
    const auto same = [&](const auto& other) { return other.second == reasons[i].second; };
    const auto here = reasons.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::any_of(reasons.begin(), here, same)) continue;  // shown already
    ++told;
    std::vector<std::string> whose;
    for (const auto& reason : reasons) {
      if (same(reason)) whose.push_back(reason.first);
    }
    const bool all = whose.size() > 1 && whose.size() == parameters;
    text += wrapped(fmt::format("  {}: {}", all ? "all" : fmt::format("{}", fmt::join(whose, ", ")),
                                reasons[i].second),
                    columns, 4);
    text += "\n";
  }
  return text;
}

std::vector<std::pair<std::string_view, const calib::Aspect*>> aspects_of(
    const calib::Assessment& assessment) {
  return {{"agreement", &assessment.agreement},
          {"validation", &assessment.validation},
          {"adequacy", &assessment.adequacy},
          {"parameters", &assessment.parameters}};
}

std::string state_text(AspectState state, const Style& style) {
  const char* const code = state == AspectState::pass   ? "32"
                           : state == AspectState::fail ? "31"
                                                        : "33";
  return coloured(
      state == AspectState::not_assessed ? "not assessed" : std::string(to_string(state)), code,
      style);
}

/// "rho2 0.9997", "error 0.373 %"
std::string metric_text(const std::string& metric, double value) {
  return metric == "absolute_error_percent" ? fmt::format("error {:.3f} %", value)
                                            : fmt::format("{} {}", metric, agreement_text(value));
}

/// The three worst conditions: those without a score, then by the used fraction of their tolerance,
/// or by their errors if there are no limits.
std::vector<std::string> worst_conditions(const calib::Fit& fit) {
  constexpr std::size_t kShown = 3;
  constexpr double kWithoutScore = std::numeric_limits<double>::infinity();
  std::vector<std::pair<double, std::string>> ranked;
  for (const calib::ConditionScore& score : fit.conditions) {
    const std::string& why = score.failure.empty() ? score.not_scored : score.failure;
    if (!why.empty()) {
      ranked.emplace_back(kWithoutScore, fmt::format("{}: {}", score.id, why));
      continue;
    }
    const auto check =
        std::max_element(score.checks.begin(), score.checks.end(),
                         [](const calib::LimitCheck& a, const calib::LimitCheck& b) {
                           return std::pair(a.verdict, a.used) < std::pair(b.verdict, b.used);
                         });
    if (check != score.checks.end()) {
      ranked.emplace_back(
          check->value ? check->used : kWithoutScore,
          check->value
              ? fmt::format("{}: {} of {}, {} of the tolerance used", score.id,
                            metric_text(check->metric, *check->value), info(check->channel).key,
                            calib::tolerance_used_text(check->used))
              : fmt::format("{}: {}", score.id, check->words));
      continue;
    }
    for (const calib::ChannelScore& channel : score.channels) {
      if (!channel.agreement) continue;
      ranked.emplace_back(
          channel.agreement->absolute_error_percent,
          fmt::format("{}: error of {} {:.3f} %", score.id, info(channel.channel).key,
                      channel.agreement->absolute_error_percent));
    }
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::string> worst;
  for (std::size_t i = 0; i < std::min(kShown, ranked.size()); ++i)
    worst.push_back(ranked[i].second);
  return worst;
}

/// Decision rule of the comparison with limits; empty if there was none.
std::string rule_text(const Result& result) {
  const auto& scores = result.fit.conditions;
  const bool judged = std::any_of(scores.begin(), scores.end(),
                                  [](const auto& score) { return !score.checks.empty(); });
  if (!judged) return {};
  return fmt::format(" by {}", calib::words_of(result.campaign.acceptance_bounds.decision));
}

const char* mark_of(AspectState state) {
  if (state == AspectState::note) return "note:";
  return calib::is_against(state) ? "-" : "+";
}

/// What the user must know before any verdict; empty for a finished result.
std::string unfinished_text(const calib::Fit& fit, const Style& style) {
  if (fit.status == FitStatus::converged) return {};
  const bool stopped = fit.status == FitStatus::stopped;
  return coloured(stopped ? "STOPPED" : "FAILED", stopped ? "33" : "31", style) + ": " +
         fit.message + ". " +
         (stopped ? stopped_sentence(fit.stopped_in) : std::string(kNoUsableResult));
}

/// Replaces the reason of a parameter in a text by its grade, since the table of parameters shows
/// the reason. Nothing if the text has no such reason.
std::optional<std::string> without_reason(const calib::Fit& fit, const std::string& text) {
  for (const calib::FittedParameter& parameter : fit.parameters) {
    if (!parameter.fitted || parameter.reason.empty()) continue;
    const std::size_t at = text.find(": " + parameter.reason);
    if (at == std::string::npos) continue;
    return text.substr(0, at + 2) + identifiability_text(parameter, true, {}) +
           text.substr(at + 2 + parameter.reason.size());
  }
  return std::nullopt;
}

/// State of an aspect; the reasons against it, the gravest first; then the reasons for it.
///
/// @param most  reasons of one state
std::string aspect_text(std::string_view name, const calib::Aspect& aspect, const calib::Fit& fit,
                        std::size_t most, const Style& style) {
  const std::size_t shown = std::min<std::size_t>(3, most);  // the result files list all
  std::string text = fmt::format("  {}: {}\n", name, state_text(aspect.state, style));
  std::map<AspectState, std::size_t> told;
  for (const calib::Reason& reason : aspect.reasons) {
    if (++told[reason.state] > shown) continue;
    const char* mark = mark_of(reason.state);
    const std::string words = without_reason(fit, reason.words).value_or(reason.words);
    text += wrapped(fmt::format("    {} {}", mark, words), style.columns, 6) + "\n";
  }
  for (const auto& [state, count] : told) {
    if (count <= shown) continue;
    text += fmt::format("    {} and {} more\n", mark_of(state), count - shown);
  }
  return text;
}

}  // namespace

std::string scorecard_text(const Result& result, const Style& style, std::size_t most) {
  const std::set<Channel> channels = compared_channels(result.fit);
  if (channels.empty()) return "No channel was compared.\n";
  const bool several = channels.size() > 1;
  const TextTable conditions = condition_table(result, several, most, style);
  const std::string title = several ? "Agreement of the worst channel of each condition"
                                    : fmt::format("Agreement of {}", info(*channels.begin()).key);
  std::string text = coloured(title, "1", style) + "\n" + conditions.text(style.columns) +
                     more_text(result.fit.conditions.size(), most, "better conditions") +
                     narrow_note(conditions, "scorecard.csv", style);
  const std::vector<Group> all = groups(result.campaign, result.fit);
  const TextTable gathered = group_table(all, several, most);
  if (!gathered.empty()) {
    text += "\n" + coloured("Summary by group (mean and worst)", "1", style) + "\n" +
            gathered.text(style.columns) + more_text(all.size(), most, "groups") +
            narrow_note(gathered, result.kind == ResultKind::fit ? "fit.json" : "validation.json",
                        style);
  }
  return text;
}

/// Half of the interval that would hold if the model were exact.
std::string exact_text(const calib::FittedParameter& p, const ReadableUnit& unit) {
  if (!p.budget || !p.ci95_if_exact) return "-";
  return "+- " +
         in_unit(0.5 * (p.ci95_if_exact->second - p.ci95_if_exact->first), unit, kErrorDigits);
}

/// With what the model leaves out, where that was considered.
double standard_uncertainty(const calib::FittedParameter& p) {
  return p.budget ? p.budget->combined : error_of(p);
}

/// The effect that adds most to an interval.
std::string widened_by(const calib::FittedParameter& p) {
  const calib::BudgetLine* largest = nullptr;
  if (p.budget) {
    for (const calib::BudgetLine& line : p.budget->lines) {
      if (largest == nullptr || line.uncertainty > largest->uncertainty) largest = &line;
    }
  }
  return largest == nullptr || largest->kind != "effect" ? "-" : largest->source;
}

std::string parameters_text(const Result& result, const Style& style, std::size_t most) {
  const auto table = model::parameter_table(result.campaign.rig.plant);
  std::vector<TextTable::Column> columns{{"parameter"},
                                         {"for"},
                                         {"value", Align::right},
                                         {"unit"},
                                         {"std. error", Align::right, 1},
                                         {"95 % interval", Align::right}};
  const bool considered = result.fit.considered.has_value();
  if (considered) {
    columns.push_back({"if model exact", Align::right, 1});
    columns.push_back({"widened by", Align::left, 3});
  }
  columns.push_back({"bounds", Align::right, 2});
  columns.push_back({"identifiability"});
  TextTable text(std::move(columns), 2);
  std::vector<std::pair<std::string, std::string>> reasons;  // whose, why
  // Errors and intervals are those of a minimum, at which a search that was stopped is not.
  const bool judged = result.fit.status != FitStatus::stopped || result.fit.has_converged();
  std::vector<const calib::FittedParameter*> fitted;
  for (const calib::FittedParameter& p : result.fit.parameters)
    if (p.fitted) fitted.push_back(&p);
  if (fitted.size() > most) {
    const auto doubtful = [](const calib::FittedParameter* p) {
      return p->identifiability != calib::Identifiability::identified || p->at_bound;
    };
    std::stable_partition(fitted.begin(), fitted.end(), doubtful);
  }
  for (const calib::FittedParameter* each : fitted) {
    if (text.rows() == most) break;
    const calib::FittedParameter& p = *each;
    const model::ParameterSpec& spec = table[static_cast<std::size_t>(p.index)];
    const ReadableUnit unit = readable_unit(p.value, spec.unit);
    const std::string whose = p.scope == datasets::Scope::rig ? "rig" : p.level;
    std::optional<Range> ci95;
    if (p.ci95) ci95 = {p.ci95->first / unit.si, p.ci95->second / unit.si};
    const EstimateText estimate =
        estimate_text(p.value / unit.si, ci95, {p.lower / unit.si, p.upper / unit.si});
    std::vector<std::string> row{
        std::string(spec.key) + (p.nuisance ? " (nuisance)" : ""),
        whose,
        estimate.value,
        std::string(unit.name),
        judged && p.standard_error ? in_unit(standard_uncertainty(p), unit, kErrorDigits) : "-",
        judged && ci95 ? fmt::format("{} .. {}", estimate.low, estimate.high) : "-"};
    if (considered) {
      row.push_back(judged ? exact_text(p, unit) : "-");
      row.push_back(judged ? widened_by(p) : "-");
    }
    row.push_back(limits(p.lower, p.upper, unit, 4));
    row.push_back(identifiability_text(p, judged, style));
    text.add(std::move(row));
    if (!p.reason.empty()) reasons.emplace_back(fmt::format("{} ({})", spec.key, whose), p.reason);
  }
  if (text.empty()) {
    return result.kind == ResultKind::validation ? "All parameters as given.\n"
                                                 : "No parameter was estimated.\n";
  }
  return coloured("Parameters", "1", style) + "\n" + text.text(style.columns) +
         more_text(fitted.size(), most, "parameters") +
         foot_notes(reasons, text.rows(), most, style.columns);
}

std::string summary_text(const Result& result, const std::vector<std::string>& files,
                         const Style& style) {
  const calib::Fit& fit = result.fit;
  std::string text;
  const auto say = [&](const std::string& line) { text += wrapped(line, style.columns, 2) + "\n"; };
  const std::string unfinished = unfinished_text(fit, style);
  if (!unfinished.empty()) say(unfinished);
  say((!fit.has_converged() ? std::string("verdict: none (there is no calibration to judge)")
       : fit.verdict        ? "verdict: " + coloured(*fit.verdict, style) + rule_text(result) +
                           (*fit.verdict == Verdict::warn ? " (passed with reservations)" : "")
       : fit.conditions.empty() ? std::string("verdict: none (no condition was scored)")
                                : std::string("verdict: none (the campaign has no [acceptance])")) +
      (result.campaign.synthetic ? "; the records of this campaign are synthetic" : ""));
  std::vector<std::string> aspects;
  for (const auto& [name, aspect] : aspects_of(fit.assessment))
    aspects.push_back(fmt::format("{} {}", name, state_text(aspect->state, style)));
  say(fmt::format("  {}", fmt::join(aspects, ", ")));
  const std::vector<std::string> worst = worst_conditions(fit);
  if (!worst.empty()) text += "worst:\n";
  for (const std::string& line : worst) text += wrapped("  " + line, style.columns, 4) + "\n";
  if (!files.empty()) say(fmt::format("files: {}", fmt::join(files, " ")));
  return text;
}

std::string reasons_text(const Result& result, const Style& style, std::size_t most) {
  const calib::Fit& fit = result.fit;
  const FitStatus status = status_of(fit);
  const char* code = status == FitStatus::converged ? "32"
                     : status == FitStatus::stopped ? "33"
                                                    : "31";
  std::string text;
  const auto say = [&](const std::string& line, std::size_t indent) {
    text += wrapped(line, style.columns, indent) + "\n";
  };
  // Without estimation there is no convergence.
  const bool only_scored = status == FitStatus::converged && fit.starts.empty();
  const std::string word =
      coloured(only_scored ? "done" : std::string(to_string(status)), code, style);
  say(fit.message.empty() ? "status: " + word : fmt::format("status: {}: {}", word, fit.message),
      2);
  for (const auto& [name, aspect] : aspects_of(fit.assessment))
    text += aspect_text(name, *aspect, fit, most, style);
  if (!fit.agreement.empty()) say("starts: " + fit.agreement, 2);
  if (!fit.bootstrap_message.empty()) say("bootstrap: " + fit.bootstrap_message, 2);
  if (fit.posterior) say("posterior: " + fit.posterior->message, 2);
  if (!fit.interval_advice.empty()) say("intervals: " + fit.interval_advice, 2);
  std::size_t warnings = 0;
  for (const std::string& warning : fit.warnings) {
    if (without_reason(fit, warning)) continue;
    if (++warnings <= most) say("warning: " + warning, 2);
  }
  return text + more_text(warnings, most, "warnings");
}

std::string result_text(const Result& result, const std::vector<std::string>& files,
                        const Style& style) {
  std::string text;
  for (const std::size_t most :
       {kAll, std::size_t{24}, std::size_t{16}, std::size_t{12}, std::size_t{8}, std::size_t{5},
        std::size_t{3}, std::size_t{2}, std::size_t{1}}) {
    text = summary_text(result, files, style) + "\n" + parameters_text(result, style, most) + "\n" +
           scorecard_text(result, style, most) + "\n" + reasons_text(result, style, most);
    const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
    if (style.lines == 0 || lines <= style.lines) break;
  }
  return text;
}

std::string record_text(const datasets::Condition& condition, const datasets::Record& record) {
  const double duration_s =
      record.time_s.empty() ? 0.0 : record.time_s.back() - record.time_s.front();
  const double rate_hz =
      duration_s > 0.0 ? static_cast<double>(record.time_s.size() - 1) / duration_s : 0.0;
  std::string channels;
  for (const auto& [channel, series] : record.channels) {
    const datasets::ChannelInfo& about = info(channel);
    channels += fmt::format(
        "{}{} ({}sd {})", channels.empty() ? "" : ", ", about.key,
        series.repeats == record.repeats ? "" : fmt::format("{} repeats, ", series.repeats),
        std::isfinite(series.pooled_sd) ? readable(series.pooled_sd, about.unit, 3) : "unknown");
  }
  std::string text =
      fmt::format("{}: {}, {} samples at {:.6g} Hz, {:.6g} s, {} repeat{}, {}, {} file{}\n",
                  condition.id, to_string(condition.use), record.time_s.size(), rate_hz, duration_s,
                  record.repeats, record.repeats == 1 ? "" : "s", channels, record.files.size(),
                  record.files.size() == 1 ? "" : "s");
  for (const std::string& note : record.notes) text += fmt::format("  note: {}\n", note);
  for (const std::string& warning : record.warnings) {
    text += fmt::format("  warning: {}\n", warning);
  }
  return text;
}

std::string parameter_table_text(model::PlantKind plant, const Style& style) {
  TextTable table({{"key"},
                   {"symbol", Align::left, 1},
                   {"unit"},
                   {"default", Align::right, 4},
                   {"lowest", Align::right, 5},
                   {"highest", Align::right, 6},
                   {"kind", Align::left, 2},
                   {"meaning"},
                   {"source", Align::left, 3}});
  for (const model::ParameterSpec& spec : model::parameter_table(plant)) {
    table.add({std::string(spec.key), std::string(spec.symbol), std::string(spec.unit),
               spec.default_value ? fmt::format("{:g}", *spec.default_value) : "-",
               fmt::format("{:g}", spec.lower), fmt::format("{:g}", spec.upper),
               std::string(to_string(spec.kind)), std::string(spec.meaning),
               std::string(spec.source)});
  }
  return table.text(style.columns);
}

}  // namespace rigcal::report
