#include "report/comparison/comparison_models.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include "calib/trust/model_choice.hpp"
#include "common/error.hpp"
#include "report/comparison/comparison_parts.hpp"

namespace rigcal::report {
namespace {

using calib::Candidate;

/// Whether what the residuals are divided by is the same wherever it is known.
bool same_weights(const Json& a, const Json& b) {
  constexpr double kSame = 1e-9;
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (const char* key : {"condition", "channel", "samples"})
      if (a.at(i).at(key) != b.at(i).at(key)) return false;
    const auto mine = number_of(a.at(i), "sd");
    const auto theirs = number_of(b.at(i), "sd");
    if (mine.has_value() != theirs.has_value()) return false;
    if (mine && !(std::abs(*theirs - *mine) <= kSame * *mine)) return false;
  }
  return true;
}

/// Where the fit estimated the noise of a channel: cost and logarithms at its likeliest standard
/// deviation, the rms of the residual. (The fit itself stops to follow that within a tenth. Priors,
/// a few residuals among many, do not count then.)
void take_likeliest_noise(const Json& weights, Candidate& candidate) {
  constexpr double kLeastRms = 1e-12;  // SI; an exact fit must not be infinitely likely
  double cost = 0.0;
  bool estimated = false;
  for (const Json& weight : weights) {
    const double samples = weight.at("samples").get<double>();
    const double rms = std::max(kLeastRms, number_of(weight, "rms").value_or(0.0));
    const auto known = number_of(weight, "sd");
    const double sd = known.value_or(rms);
    cost += 0.5 * samples * (rms / sd) * (rms / sd);
    if (known) continue;
    estimated = true;
    candidate.log_sd += samples * std::log(sd);
  }
  if (estimated) candidate.cost = cost;
}

/// A number of things, at least so many. Conversion of a double beyond its range to a whole number
/// is undefined.
double count_of(const Compared& compared, const std::string& key, double least) {
  constexpr double kLargestCount = 1e9;
  const double count = compared.result.at(key).get<double>();
  if (count >= least && count <= kLargestCount && count == std::floor(count)) return count;
  throw InputError({compared.file.string()},
                   fmt::format("key '{}': found {}, expected a whole number from {} to {}", key,
                               count, least, kLargestCount));
}

Candidate candidate_of(const Compared& compared) {
  const Json& result = compared.result;
  Candidate candidate;
  candidate.name = compared.name;
  candidate.cost = result.at("cost").get<double>();
  candidate.parameters = static_cast<int>(count_of(compared, "rank", 0.0));
  candidate.residuals = count_of(compared, "residual_count", 1.0);
  candidate.independent_residuals =
      number_of(result, "independent_residuals").value_or(candidate.residuals);
  take_likeliest_noise(result.at("weights"), candidate);
  return candidate;
}

/// Why two fits cannot be compared as models; empty if they can.
std::string obstacle(const Compared& a, const Compared& b) {
  for (const Compared* each : {&a, &b}) {
    if (!each->result.contains("weights") || !each->result.contains("independent_residuals") ||
        text_of(each->result, "schema") != "rigcal.fit/1")
      return fmt::format("{} is no fit of records by this version", each->name);
    if (text_of(each->result, "status") != "converged")
      return fmt::format("{} did not converge", each->name);
  }
  // The same content under another name is the same record.
  const auto hashes_of = [](const Json& result) {
    std::set<std::string> hashes;
    for (const auto& [hash, file] : record_hashes(result)) hashes.insert(hash);
    return hashes;
  };
  const auto hashes = hashes_of(a.result);
  if (hashes.empty() || hashes != hashes_of(b.result)) return "not fitted to the same records";
  if (!same_weights(a.result.at("weights"), b.result.at("weights")) ||
      a.result.at("residual_count") != b.result.at("residual_count"))
    return "the records count differently: other channels, samples, priors or standard deviations";
  return {};
}

int fineness(const std::string& scope) {
  return scope == "rig" ? 0 : scope == "leak_level" ? 1 : 2;
}

/// The parameters of a fit, by what it does with them.
struct Terms {
  std::map<std::string, std::string> free;  ///< key and scope
  std::map<std::string, std::pair<double, double>> bounds;
  std::map<std::tuple<std::string, std::string, std::string>, double> known;

  explicit Terms(const Json& result) {
    for (const Json& parameter : result.at("parameters")) {
      const std::string key = text_of(parameter, "key");
      if (parameter.at("fitted").get<bool>()) {
        free[key] = text_of(parameter, "scope");
        bounds[key] = {number_of(parameter, "lower").value_or(-HUGE_VAL),
                       number_of(parameter, "upper").value_or(HUGE_VAL)};
      } else {
        known[{key, text_of(parameter, "scope"), text_of(parameter, "level")}] =
            number_of(parameter, "value").value_or(HUGE_VAL);
      }
    }
  }
};

/// Why the larger model does not contain the smaller one; empty if it does.
std::string not_contained(const Json& smaller_result, const Json& larger_result) {
  if (text_of(smaller_result, "model") != text_of(larger_result, "model"))
    return "the plants are different models";
  const Terms smaller(smaller_result);
  const Terms larger(larger_result);
  for (const auto& [key, scope] : smaller.free) {
    const auto found = larger.free.find(key);
    if (found == larger.free.end() || fineness(found->second) < fineness(scope))
      return fmt::format("{} is free in one alone, and something else in the other", key);
  }
  for (const auto& [id, value] : smaller.known) {
    const std::string& key = std::get<0>(id);
    if (const auto bound = larger.bounds.find(key); bound != larger.bounds.end()) {
      if (value < bound->second.first || value > bound->second.second)
        return fmt::format("the value of {} lies outside the bounds of the other fit", key);
      continue;
    }
    const auto found = larger.known.find(id);
    if (found == larger.known.end() || found->second != value)
      return fmt::format("they differ in the known value of {}", key);
  }
  for (const auto& [id, value] : larger.known) {
    const std::string& key = std::get<0>(id);
    if (!smaller.free.contains(key) && !smaller.known.contains(id))
      return fmt::format("they differ in the known value of {}", key);
  }
  return {};
}

Json empty_choice(const std::string& reason) {
  Json json;
  for (const char* key : {"delta_aic", "delta_bic", "smaller", "larger", "likelihood_ratio",
                          "freedom", "p_value", "verdict"})
    json[key] = nullptr;
  json["reason"] = reason;
  return json;
}

/// A model that contains another fits no worse, but for what simulations differ by.
constexpr double kWorse = 2.0;

Json choice_json(const Compared& first, const Compared& other) {
  if (const std::string why = obstacle(first, other); !why.empty()) return empty_choice(why);
  const Candidate a = candidate_of(first);
  const Candidate b = candidate_of(other);
  const calib::InformationDifference information = calib::compare_information(a, b);
  Json json = empty_choice("");
  json["delta_aic"] = number(information.aic);
  json["delta_bic"] = number(information.bic);
  json["verdict"] = information.message;
  if (a.parameters == b.parameters) {
    json["reason"] = "as many parameters in both: neither contains the other";
    return json;
  }
  const bool first_smaller = a.parameters < b.parameters;
  const Compared& smaller = first_smaller ? first : other;
  const Compared& larger = first_smaller ? other : first;
  if (const std::string why = not_contained(smaller.result, larger.result); !why.empty()) {
    json["reason"] = fmt::format("{} does not contain {}: {}", larger.name, smaller.name, why);
    return json;
  }
  const double worse = first_smaller ? b.deviance() - a.deviance() : a.deviance() - b.deviance();
  if (worse > kWorse) {
    json["reason"] = fmt::format(
        "{} has more free parameters and fits worse: its bounds leave {} out, or its fit is no "
        "minimum",
        larger.name, smaller.name);
    return json;
  }
  const calib::ModelChoice choice = first_smaller ? calib::choose(a, b) : calib::choose(b, a);
  json["smaller"] = smaller.name;
  json["larger"] = larger.name;
  json["likelihood_ratio"] = number(choice.likelihood_ratio);
  json["freedom"] = choice.freedom;
  json["p_value"] = number(choice.p);
  json["verdict"] = choice.message;
  json["reason"] = nullptr;
  return json;
}

}  // namespace

Json models_json(const std::vector<Compared>& results) {
  Json list = Json::array({nullptr});
  for (std::size_t i = 1; i < results.size(); ++i)
    list.push_back(choice_json(results[0], results[i]));
  return list;
}

}  // namespace rigcal::report
