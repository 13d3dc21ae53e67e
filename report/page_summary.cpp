#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "metrics/metric_table.hpp"
#include "report/page_parts.hpp"
#include "report/readable.hpp"

namespace rigcal::report {
namespace {

/// Without limits of the campaign, agreement below this is called poor.
constexpr double kPoorRho2 = 0.9;
constexpr std::size_t kLeastReasons = 3;

struct Reason {
  double weight = 0.0;
  std::string text;
  std::string link;  ///< id of a section, or empty
};

/// Weights of kinds; within a kind by how far it is off.
constexpr double kUnusable = 1e9;
constexpr double kNotSimulated = 1e7;
constexpr double kFailed = 1e5;
constexpr double kPoor = 1e4;
constexpr double kWarned = 1e3;
constexpr double kNotIdentified = 100.0;
constexpr double kAtBound = 50.0;
constexpr double kWeak = 20.0;
constexpr double kMisfit = 10.0;
constexpr double kDriven = 5.0;

struct WorstAgreement {
  double rho2 = 2.0;
  std::string condition, channel;
};

WorstAgreement worst_agreement(const Json& result) {
  WorstAgreement worst;
  for (const Json& condition : result.at("conditions")) {
    for (const auto& [channel, metrics] : condition.at("metrics").items()) {
      const auto rho2 = number_of(metrics, "rho2");
      if (rho2 && *rho2 < worst.rho2) worst = {*rho2, text_of(condition, "id"), channel};
    }
  }
  return worst;
}

bool is_poor(const Json& result) {
  return !result.at("verdict").is_string() && worst_agreement(result).rho2 < kPoorRho2;
}

std::string joined(const Json& texts) {
  std::string text;
  for (const Json& each : texts) text += (text.empty() ? "" : "; ") + each.get<std::string>();
  return text;
}

void add_conditions(const Json& result, std::vector<Reason>& reasons) {
  for (const Json& condition : result.at("conditions")) {
    const std::string id = text_of(condition, "id");
    const std::string failure = text_of(condition, "failure");
    if (!failure.empty()) {
      reasons.push_back(
          {kNotSimulated, fmt::format("{} could not be simulated: {}", id, failure), anchor(id)});
      continue;
    }
    if (condition.at("reasons").empty()) continue;
    double excess = 0.0;
    for (const auto& [channel, metrics] : condition.at("metrics").items())
      excess =
          std::max(excess, judge_channel(limits_of(result, condition), condition, channel).excess);
    const bool fail = text_of(condition, "verdict") == "FAIL";
    reasons.push_back({(fail ? kFailed : kWarned) * (1.0 + excess),
                       fmt::format("{}: {}", id, joined(condition.at("reasons"))), anchor(id)});
  }
}

void add_parameters(const Json& result, std::vector<Reason>& reasons) {
  for (const Json& p : result.at("parameters")) {
    if (!p.at("fitted").get<bool>() || p.at("nuisance").get<bool>()) continue;
    const std::string grade = text_of(p, "identifiability");
    const bool bound = p.at("at_bound").get<bool>();
    const double weight = grade == "not_identifiable" ? kNotIdentified
                          : bound                     ? kAtBound
                          : grade == "weak"           ? kWeak
                                                      : 0.0;
    if (weight > 0.0)
      reasons.push_back(
          {weight, fmt::format("{}: {}", parameter_label(p), text_of(p, "reason")), "parameters"});
  }
}

/// Whether there is a significant lack of fit; null where it cannot be judged.
Json misfit_of(const Json& result) {
  const auto lack = result.find("lack_of_fit");
  if (lack == result.end() || !lack->is_object()) return nullptr;
  const auto misfit = lack->find("misfit");
  return misfit == lack->end() ? Json(nullptr) : *misfit;
}

/// Whether lack of fit was tested at all.
bool has_lack_tests(const Json& result) {
  const auto lack = result.find("lack_of_fit");
  return lack != result.end() && lack->is_object() && !lack->value("tests", Json::array()).empty();
}

void add_misfit(const Json& result, std::vector<Reason>& reasons) {
  constexpr double kLarge = 1.5;
  const auto chi = number_of(result, "reduced_chi_square");
  if (!chi) return;
  if (*chi > kLarge) {
    reasons.push_back(
        {kMisfit,
         fmt::format("the residuals are {:.3g} times as large as the noise: the model "
                     "does not explain all of the records",
                     std::sqrt(*chi)),
         "conditions"});
  } else if (misfit_of(result) == true) {
    reasons.push_back({kMisfit, "significant lack of fit: the residuals hold more than noise",
                       "identifiability"});
  }
}

/// The residual that the input explains most: what a better model could still take in.
void add_driven_residual(const Json& result, std::vector<Reason>& reasons) {
  constexpr double kLeastShare = 0.1;  // of the variance; below it is hardly seen
  double largest = 0.0;
  std::string condition_id;
  std::string channel_name;
  int count = 0;
  for (const Json& condition : result.at("conditions")) {
    const auto tests = condition.find("residual_tests");
    if (tests == condition.end() || !tests->is_object()) continue;
    for (const auto& [channel, found] : tests->items()) {
      if (!found.is_object() || !found.at("cross_correlation").is_object()) continue;
      const Json& test = found.at("cross_correlation");
      const double peak = number_of(test, "peak").value_or(0.0);
      if (test.at("passed") != false || peak * peak < kLeastShare) continue;
      ++count;
      if (peak * peak <= largest) continue;
      largest = peak * peak;
      condition_id = text_of(condition, "id");
      channel_name = channel;
    }
  }
  if (count == 0) return;
  const std::string others = count == 1 ? std::string()
                             : count == 2
                                 ? std::string(" (and 1 other channel likewise)")
                                 : fmt::format(" (and {} other channels likewise)", count - 1);
  reasons.push_back(
      {kDriven,
       fmt::format("{}: {:.0f} % of the residual variance of {} is linearly explained by the "
                   "input{}: unmodelled dynamics, or a wrong parameter",
                   condition_id, 100.0 * largest, channel_name, others),
       anchor(condition_id)});
}

/// How large the residuals are by the noise, as far as that is known.
Reason noise_reason(const Json& result, double chi_square) {
  if (!misfit_of(result).is_boolean()) {
    constexpr double kUnknownNoise = 2.5;  // before what speaks for the estimates
    return {kUnknownNoise,
            has_lack_tests(result)
                ? "lack of fit cannot be judged: too few independent samples"
                : "lack of fit cannot be judged: neither repeats nor sd tell the noise",
            "identifiability"};
  }
  constexpr double kSame = 0.005;
  const double ratio = std::sqrt(chi_square);
  return {1.0,
          std::abs(ratio - 1.0) < kSame
              ? std::string("the residuals are as large as the noise")
              : fmt::format("the residuals are {:.3g} times as large as the noise", ratio),
          "conditions"};
}

/// What a good result has to show for itself.
std::vector<Reason> praise(const Json& result) {
  std::vector<Reason> reasons;
  double nearest = 0.0;
  std::string where;
  for (const Json& condition : result.at("conditions")) {
    for (const auto& [channel, metrics] : condition.at("metrics").items()) {
      const double excess = judge_channel(limits_of(result, condition), condition, channel).excess;
      if (excess >= nearest) {
        nearest = excess;
        where = text_of(condition, "id");
      }
    }
  }
  if (!where.empty()) {
    const std::size_t all = result.at("conditions").size();
    const std::string text =
        all == 1 ? fmt::format("{} keeps the limits and uses {:.2g} % of what the nearest allows",
                               where, 100.0 * nearest)
                 : fmt::format(
                       "all {} conditions keep the limits; the nearest to one, {}, uses "
                       "{:.2g} % of what it allows",
                       all, where, 100.0 * nearest);
    reasons.push_back({3.0, text, anchor(where)});
  }
  int fitted = 0;
  int identified = 0;
  for (const Json& p : result.at("parameters")) {
    if (!p.at("fitted").get<bool>() || p.at("nuisance").get<bool>()) continue;
    ++fitted;
    if (text_of(p, "identifiability") == "identified") ++identified;
  }
  if (fitted > 0) {
    reasons.push_back(
        {2.0, fmt::format("{} of {} estimated parameters are identified", identified, fitted),
         "parameters"});
  }
  const auto chi = result.contains("reduced_chi_square") ? number_of(result, "reduced_chi_square")
                                                         : std::nullopt;
  if (chi) reasons.push_back(noise_reason(result, *chi));
  return reasons;
}

std::vector<Reason> reasons_of(const Json& result) {
  std::vector<Reason> reasons;
  const std::string status = text_of(result, "status");
  if (status != "converged") reasons.push_back({kUnusable, text_of(result, "message"), "starts"});
  add_conditions(result, reasons);
  if (!result.at("verdict").is_string() && status != "failed") {
    const WorstAgreement worst = worst_agreement(result);
    std::string text = "the campaign has no acceptance limits, so nothing was judged";
    if (worst.rho2 <= 1.0) {
      text += fmt::format("; the worst agreement is rho2 = {:.4g} of {} in {}", worst.rho2,
                          worst.channel, worst.condition);
    }
    reasons.push_back({kPoor, text, worst.condition.empty() ? "matrix" : anchor(worst.condition)});
  }
  add_parameters(result, reasons);
  add_misfit(result, reasons);
  add_driven_residual(result, reasons);
  if (reasons.size() < kLeastReasons && status == "converged") {
    for (Reason& reason : praise(result)) {
      reason.weight *= 1e-3;
      const bool good = text_of(result, "verdict") == "PASS";
      // Beside a WARN or FAIL nothing is praised.
      if (good) reasons.push_back(std::move(reason));
    }
  }
  std::stable_sort(reasons.begin(), reasons.end(),
                   [](const Reason& a, const Reason& b) { return a.weight > b.weight; });
  return reasons;
}

Json headline_of(const Json& result) {
  const std::string status = text_of(result, "status");
  if (status == "failed")
    return make_headline("FAILED", "✕", "bad",
                         "There is no usable result: no number below may be used.");
  if (status == "stopped") {
    return make_headline(
        "STOPPED", "✕", "bad",
        "Ended before it converged: these are the best values so far, not a calibration.");
  }
  const std::string verdict = text_of(result, "verdict");
  int failed = 0;
  int warned = 0;
  const std::size_t all = result.at("conditions").size();
  for (const Json& condition : result.at("conditions")) {
    const std::string each = text_of(condition, "verdict");
    failed += each == "FAIL" ? 1 : 0;
    warned += each == "WARN" ? 1 : 0;
  }
  if (verdict == "FAIL") {
    return make_headline(
        "FAIL", "✕", "bad",
        fmt::format("{} of {} conditions {} outside the campaign's limits: the model is not "
                    "validated.",
                    failed, all, failed == 1 ? "is" : "are"));
  }
  if (verdict == "WARN") {
    return make_headline("WARN", "!", "warn",
                         fmt::format("{} of {} conditions {} the limits only just: use with care.",
                                     warned, all, warned == 1 ? "keeps" : "keep"));
  }
  if (verdict == "PASS") {
    return make_headline(
        "PASS", "✓", "good",
        all == 1 ? "The condition is within the campaign's limits."
                 : fmt::format("All {} conditions are within the campaign's limits.", all));
  }
  if (is_poor(result)) {
    return make_headline(
        "POOR", "✕", "bad",
        fmt::format("No limits were given, but at least one signal is reproduced with rho2 below "
                    "{}: the model does not describe the records.",
                    kPoorRho2));
  }
  if (all == 0) return make_headline("NOT JUDGED", "○", "none", "No condition was scored.");
  return make_headline(
      "NOT JUDGED", "○", "none",
      "The campaign gives no limits: whether this is good enough is for you to say.");
}

Json range_row(const Json& validity, const char* key, const char* name, std::string_view unit) {
  const auto found = validity.find(key);
  if (found == validity.end() || !found->is_array()) return nullptr;
  const Json low = shown((*found)[0], unit, 4);
  const Json high = shown((*found)[1], unit, 4);
  return {{"name", name}, {"low", low}, {"high", high}, {"single", low == high}};
}

Json coverage_rows(const Json& validity) {
  Json rows = Json::array();
  const auto add = [&](const char* key, const char* name, std::string_view unit) {
    Json row = range_row(validity, key, name, unit);
    if (!row.is_null()) rows.push_back(std::move(row));
  };
  add("frequency_hz", "Frequency", "Hz");
  if (rows.empty()) {
    const Json unstated{{"exact", ""}, {"text", "not stated: the signals are recorded ones"}};
    rows.push_back(
        {{"name", "Frequency"}, {"low", unstated}, {"high", unstated}, {"single", true}});
  }
  add("amplitude_m", "Amplitude (half of peak to peak)", "m");
  add("amplitude_v", "Amplitude (half of peak to peak)", "V");
  add("supply_pressure_pa", "Supply pressure", "Pa");
  add("leakage_coefficient", "Leakage coefficient", "1");
  return rows;
}

/// "sine 0.1 Hz", and the frequency to sort by.
std::pair<double, std::string> signal_of(const Json& condition) {
  const auto frequency = number_of(condition, "frequency_hz");
  const std::string waveform = text_of(condition, "waveform");
  if (!frequency) return {0.0, waveform};
  return {*frequency, fmt::format("{:.6g} Hz {}", *frequency, waveform)};
}

/// The limits of one channel, to be shown.
Json limits_view(const Json& limits, const std::string& channel) {
  Json view = Json::array();
  for (const Json& limit : limits) {
    if (text_of(limit, "channel") != channel) continue;
    view.push_back({{"metric", text_of(limit, "metric")},
                    {"limit", shown_in(limit.at("limit"), 1.0, 6)},
                    {"has_warn", limit.at("warn").is_number()},
                    {"warn", shown_in(limit.at("warn"), 1.0, 6)}});
  }
  return view;
}

Json matrix_entry(const Json& result, const Json& condition, const std::string& channel) {
  const Json& metrics = condition.at("metrics");
  const auto scores = metrics.find(channel);
  const bool failed = !text_of(condition, "failure").empty();
  if (scores == metrics.end() && !failed) return nullptr;
  const Judgement judgement = judge_channel(limits_of(result, condition), condition, channel);
  Json verdict = nullptr;
  if (judgement.verdict) verdict = *judgement.verdict;
  if (failed) verdict = "FAIL";
  Json entry;
  entry["condition"] = text_of(condition, "id");
  entry["anchor"] = anchor(text_of(condition, "id"));
  entry["use"] = text_of(condition, "use");
  entry["badge"] = badge(verdict);
  entry["failed"] = failed;
  if (!failed) {
    entry["rho2"] = shown_agreement(scores->at("rho2"));
    entry["error"] = shown_in(scores->at("absolute_error_percent"), 1.0, 3);
  }
  return entry;
}

}  // namespace

Json headline_view(const Json& result) {
  Json view = headline_of(result);
  for (const Reason& reason : reasons_of(result)) add_reason(view, reason.text, reason.link);
  view["coverage"] = coverage_rows(result.at("validity"));
  view["levels"] = joined(result.at("validity").at("leak_levels"));
  view["has_levels"] = !result.at("validity").at("leak_levels").empty();
  view["has_coverage"] = text_of(result, "status") != "failed";
  view["status"] = text_of(result, "status");
  view["message"] = text_of(result, "message");
  return view;
}

Json tables_headline(const Json& result) {
  const std::string status = text_of(result, "status");
  if (status != "converged") {
    Json view = headline_of(result);
    add_reason(view, text_of(result, "message"), {});
    return view;
  }
  Json view = make_headline(
      "FITTED", "○", "none",
      fmt::format("Estimated from {} published numbers; their weighted logarithms are off by "
                  "{:.1f} % rms.",
                  result.at("residual_count").get<int>(),
                  100.0 * number_of(result, "rms").value_or(0.0)));
  std::vector<Reason> reasons;
  add_parameters(result, reasons);
  for (const Reason& reason : reasons) add_reason(view, reason.text, reason.link);
  return view;
}

Json matrix_view(const Json& result) {
  std::vector<std::string> channels;
  std::vector<std::pair<double, std::string>> signals;
  std::vector<std::string> levels;
  const auto remember = [](auto& list, const auto& item) {
    if (std::find(list.begin(), list.end(), item) == list.end()) list.push_back(item);
  };
  for (const Json& condition : result.at("conditions")) {
    for (const auto& [channel, metrics] : condition.at("metrics").items())
      remember(channels, channel);
    remember(signals, signal_of(condition));
    remember(levels, text_of(condition, "leak_level"));
  }
  std::stable_sort(signals.begin(), signals.end());
  if (channels.empty() && !signals.empty()) channels.emplace_back("position");
  Json view = Json::array();
  for (const std::string& channel : channels) {
    Json table;
    table["channel"] = channel;
    table["limits"] = limits_view(result.at("acceptance"), channel);
    table["has_limits"] = !table["limits"].empty();
    table["own"] = Json::array();
    for (const Json& condition : result.at("conditions")) {
      if (!condition.contains("acceptance")) continue;
      Json own = limits_view(condition.at("acceptance"), channel);
      table["own"].push_back(
          {{"condition", text_of(condition, "id")}, {"judged", !own.empty()}, {"limits", own}});
    }
    table["levels"] = Json::array();
    for (const std::string& level : levels) {
      table["levels"].push_back(level.empty() ? std::string("no leak level")
                                              : fmt::format("leak {}", level));
    }
    table["rows"] = Json::array();
    for (const auto& signal : signals) {
      Json row{{"signal", signal.second}, {"cells", Json::array()}};
      for (const std::string& level : levels) {
        Json entries = Json::array();
        for (const Json& condition : result.at("conditions")) {
          if (signal_of(condition) != signal || text_of(condition, "leak_level") != level) continue;
          Json entry = matrix_entry(result, condition, channel);
          if (!entry.is_null()) entries.push_back(std::move(entry));
        }
        for (Json& entry : entries) entry["several"] = entries.size() > 1;
        row["cells"].push_back({{"entries", std::move(entries)}});
      }
      table["rows"].push_back(std::move(row));
    }
    view.push_back(std::move(table));
  }
  return view;
}

Json groups_view(const Json& result) {
  Json rows = Json::array();
  for (const Json& group : result.at("groups")) {
    for (const auto& [channel, scores] : group.at("metrics").items()) {
      std::string by = text_of(group, "by");
      std::replace(by.begin(), by.end(), '_', ' ');
      rows.push_back(
          {{"by", by},
           {"label", text_of(group, "label")},
           {"channel", channel},
           {"conditions", fmt::format("{}", scores.at("conditions").get<int>())},
           {"rho2", shown_agreement(scores.at("mean").at("rho2"))},
           {"ccc", shown_agreement(scores.at("mean").at("ccc"))},
           {"error", shown_in(scores.at("mean").at("absolute_error_percent"), 1.0, 3)},
           {"worst", shown_agreement(scores.at("worst").at("rho2"))},
           {"worst_error", shown_in(scores.at("worst").at("absolute_error_percent"), 1.0, 3)}});
    }
  }
  return rows;
}

}  // namespace rigcal::report
