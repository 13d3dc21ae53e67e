
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
using datasets::Scope;

/// Returns true if the residuals have equal standard deviations wherever these are known.
bool same_weights(const std::vector<StoredWeight>& a, const std::vector<StoredWeight>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    constexpr double kSame = 1e-9;
    return x.condition == y.condition && x.channel == y.channel && x.samples == y.samples &&
           x.sd.has_value() == y.sd.has_value() &&
           (!x.sd || std::abs(*y.sd - *x.sd) <= kSame * *x.sd);
  });
}

/// For channels whose noise the fit estimated, recomputes the cost and the log terms at the
/// maximum-likelihood standard deviation, which is the rms residual. The estimate of the fit may
/// still differ from it by up to 10 %. Priors are ignored because they are few among many
/// residuals.
void take_likeliest_noise(const std::vector<StoredWeight>& weights, Candidate& candidate) {
  constexpr double kLeastRms = 1e-12;  // in SI units; keeps the likelihood of an exact fit finite
  double cost = 0.0;
  bool estimated = false;
  for (const StoredWeight& weight : weights) {
    const auto samples = static_cast<double>(weight.samples);
    const double rms = std::max(kLeastRms, weight.rms.value_or(0.0));
    const double sd = weight.sd.value_or(rms);
    cost += 0.5 * samples * (rms / sd) * (rms / sd);
    if (weight.sd) continue;
    estimated = true;
    candidate.log_sd += samples * std::log(sd);
  }
  if (estimated) candidate.cost = cost;
}

Candidate candidate_of(const Compared& compared) {
  const StoredFit& fit = compared.result;
  if (fit.residual_count == 0)
    throw InputError({compared.file.string()},
                     "key 'residual_count': found 0, expected a whole number from 1");
  Candidate candidate;
  candidate.name = compared.name;
  candidate.cost = *fit.cost;
  candidate.parameters = fit.rank;
  candidate.residuals = static_cast<double>(fit.residual_count);
  candidate.independent_residuals = fit.independent_residuals->value_or(candidate.residuals);
  take_likeliest_noise(*fit.weights, candidate);
  return candidate;
}

/// Explains why two fits cannot be compared as models; empty if they can.
std::string obstacle(const Compared& a, const Compared& b) {
  for (const Compared* each : {&a, &b}) {
    const StoredFit& fit = each->result;
    if (each->of_tables || !fit.weights || !fit.independent_residuals || !is_fit_schema(fit.schema))
      return fmt::format("{} is not a fit of records by this version", each->name);
    if (fit.status != calib::FitStatus::converged || !fit.cost)
      return fmt::format("{} did not converge", each->name);
  }
  // Files with equal contents are the same record, whatever their names.
  const auto hashes_of = [](const StoredFit& fit) {
    std::set<std::string> hashes;
    for (const auto& [hash, file] : record_hashes(fit)) hashes.insert(hash);
    return hashes;
  };
  const auto hashes = hashes_of(a.result);
  if (hashes.empty() || hashes != hashes_of(b.result)) return "not fitted to the same records";
  if (!same_weights(*a.result.weights, *b.result.weights) ||
      a.result.residual_count != b.result.residual_count)
    return "the records are weighted differently: other channels, samples, priors or standard "
           "deviations";
  return {};
}

/// The parameters of a fit, grouped into free and known ones.
struct Terms {
  std::map<std::string, Scope> free;  ///< by key
  std::map<std::string, std::pair<double, double>> bounds;
  std::map<std::tuple<std::string, Scope, std::string>, double> known;

  explicit Terms(const StoredFit& fit) {
    for (const calib::FittedParameter& p : fit.parameters) {
      if (p.fitted) {
        free[p.key] = p.scope;
        bounds[p.key] = {p.lower.value_or(-HUGE_VAL), p.upper.value_or(HUGE_VAL)};
      } else {
        known[{p.key, p.scope, p.level.value_or("")}] = std::isfinite(p.value) ? p.value : HUGE_VAL;
      }
    }
  }
};

/// Explains why the larger model does not contain the smaller one; empty if it does.
std::string not_contained(const StoredFit& smaller_result, const StoredFit& larger_result) {
  const std::optional<model::PlantKind>& plant = smaller_result.model;
  if (plant != larger_result.model) return "the plants are different models";
  const Terms smaller(smaller_result);
  const Terms larger(larger_result);
  for (const auto& [key, scope] : smaller.free) {
    const auto found = larger.free.find(key);
    if (found == larger.free.end() || found->second < scope)  // scopes are ordered from rig to
                                                              // condition
      return fmt::format("{} is free in only one of them, another parameter in the other", key);
  }
  for (const auto& [id, value] : smaller.known) {
    const std::string& key = std::get<0>(id);
    if (const auto bound = larger.bounds.find(key); bound != larger.bounds.end()) {
      if (value < bound->second.first || value > bound->second.second)
        return fmt::format("the value of {} is outside the bounds of the other fit", key);
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

/// A model that contains another one must fit at least as well. This margin allows for simulation
/// errors.
constexpr double kWorse = 2.0;

StoredModelChoice choice_of(const Compared& first, const Compared& other) {
  StoredModelChoice result;
  if (std::string why = obstacle(first, other); !why.empty()) {
    result.reason = std::move(why);
    return result;
  }
  const Candidate a = candidate_of(first);
  const Candidate b = candidate_of(other);
  const calib::InformationDifference information = calib::compare_information(a, b);
  result.delta_aic = information.aic;
  result.delta_bic = information.bic;
  result.verdict = information.message;
  if (a.parameters == b.parameters) {
    result.reason = "both have the same number of parameters: neither contains the other";
    return result;
  }
  const bool first_smaller = a.parameters < b.parameters;
  const Compared& smaller = first_smaller ? first : other;
  const Compared& larger = first_smaller ? other : first;
  if (const std::string why = not_contained(smaller.result, larger.result); !why.empty()) {
    result.reason = fmt::format("{} does not contain {}: {}", larger.name, smaller.name, why);
    return result;
  }
  const double worse = first_smaller ? b.deviance() - a.deviance() : a.deviance() - b.deviance();
  if (worse > kWorse) {
    result.reason = fmt::format(
        "{} has more free parameters and fits worse: its bounds exclude {}, or its fit did not "
        "reach the minimum",
        larger.name, smaller.name);
    return result;
  }
  const calib::ModelChoice choice = first_smaller ? calib::choose(a, b) : calib::choose(b, a);
  result.smaller = smaller.name;
  result.larger = larger.name;
  result.likelihood_ratio = choice.likelihood_ratio;
  result.freedom = choice.freedom;
  result.p_value = choice.p;
  result.verdict = choice.message;
  return result;
}

}  // namespace

std::vector<std::optional<StoredModelChoice>> compared_models(
    const std::vector<Compared>& results) {
  std::vector<std::optional<StoredModelChoice>> list(1);
  for (std::size_t i = 1; i < results.size(); ++i)
    list.emplace_back(choice_of(results[0], results[i]));
  return list;
}

}  // namespace rigcal::report
