#include "calib/trust/findings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "calib/search/basins.hpp"
#include "calib/trust/between_repeats.hpp"
#include "calib/trust/combinations.hpp"
#include "calib/trust/identifiability.hpp"
#include "calib/trust/information.hpp"
#include "calib/trust/interval_advice.hpp"
#include "calib/trust/lack_of_fit.hpp"
#include "calib/trust/symmetry.hpp"
#include "common/readable.hpp"
#include "common/significant.hpp"

namespace rigcal::calib {
namespace {

/// Adds the correlation of all unknowns that have an error. If there are many unknowns that belong
/// to single conditions, these are left out, because the matrix would otherwise make up most of the
/// result.
void add_correlation(const Problem& problem, const Uncertainty& found, Fit& fit) {
  std::vector<Eigen::Index> rows;
  for (std::size_t j = 0; j < found.standard_error.size(); ++j) {
    const auto row = static_cast<Eigen::Index>(j);
    if (!found.standard_error[j] || !fit.parameters[j].correlated) continue;
    rows.push_back(row);
    fit.correlation.names.push_back(problem.name(j));
  }
  const auto size = static_cast<Eigen::Index>(rows.size());
  fit.correlation.matrix =
      Eigen::MatrixXd::NullaryExpr(size, size, [&](Eigen::Index i, Eigen::Index k) {
        return found.correlation(rows[static_cast<std::size_t>(i)],
                                 rows[static_cast<std::size_t>(k)]);
      });
}

void warn_of_noise(const Problem& problem, const Uncertainty& found, Fit& fit) {
  const double chi = found.reduced_chi_square;
  const double freedom = std::max(1.0, static_cast<double>(fit.residual_count - found.rank));
  const double margin = 5.0 * std::sqrt(2.0 / freedom);
  if (fit.residual_count <= found.rank) {
    fit.warnings.push_back(fmt::format(
        "{} residuals for {} unknowns: no degrees of freedom remain to estimate the noise",
        fit.residual_count, problem.map.unknowns().size()));
  } else if (chi > 1.0 + std::max(0.1, margin)) {
    fit.warnings.push_back(fmt::format(
        "the residuals are {} times as large as the noise (reduced chi-square {}): the "
        "model does not fully explain the records; standard errors are scaled up by that factor",
        significant(std::sqrt(chi), 3), significant(chi, 4)));
  } else if (!problem.has_estimated_sd() && chi < 1.0 - std::max(0.5, margin)) {
    fit.warnings.push_back(
        fmt::format("the residuals are only {} times as large as the noise (reduced chi-square "
                    "{}): the stated standard deviations are too large",
                    significant(std::sqrt(chi), 3), significant(chi, 4)));
  }
}

/// Warns about priors that contradict the records, because the fit then matches neither.
void warn_of_priors(const Problem& problem, const std::vector<FittedParameter>& parameters,
                    Fit& fit) {
  constexpr double kFar = 3.0;  // in standard deviations; one case in 370 by chance
  const auto warn = [&](const std::string& name, double value, const datasets::Prior& prior,
                        std::string_view unit, const char* what) {
    const double pull = std::abs(prior.residual(value));
    if (pull <= kFar) return;
    fit.warnings.push_back(fmt::format("{}: {} {}, {:.2g} standard deviations of its prior from {}",
                                       name, what, readable(value, unit, 4), pull,
                                       readable(prior.mean, unit, 4)));
  };
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    if (const auto& prior = problem.map.unknowns()[j].prior) {
      warn(problem.name(j), parameters[j].value, *prior, problem.spec(j).unit,
           "records and prior disagree: the fit ends at");
    }
  }
  for (const auto& setting : problem.campaign->parameters) {
    if (!setting.prior || setting.fit) continue;
    const auto& spec = model::parameter_spec(problem.campaign->rig.plant, setting.index);
    warn(std::string(spec.key), setting.value, *setting.prior, spec.unit, "known, and taken to be");
  }
}

/// Adds warnings about unreliable parameters.
void warn_of_parameters(const Problem& problem, const std::vector<FittedParameter>& parameters,
                        Fit& fit) {
  std::vector<std::string> bounded;
  std::vector<std::string> loose;
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const FittedParameter& each = parameters[j];
    if (each.at_bound) bounded.push_back(problem.name(j));
    if (each.identifiability == Identifiability::not_identifiable && !each.nuisance)
      loose.push_back(problem.name(j));
    const bool says_something = each.at_bound || !each.standard_error ||
                                each.identifiability != Identifiability::identified;
    if (says_something) fit.warnings.push_back(fmt::format("{}: {}", problem.name(j), each.reason));
  }
  if (!bounded.empty()) fit.message += fmt::format("; at a bound: {}", fmt::join(bounded, ", "));
  if (!loose.empty()) fit.message += fmt::format("; not identifiable: {}", fmt::join(loose, ", "));
}

/// Computes Akaike's and Schwarz's criteria. Because the noise is known or was estimated from the
/// residual, 2 cost equals -2 ln(likelihood) up to a constant. If the residuals are correlated,
/// only their independent fraction counts.
void rate_model(const Uncertainty& errors, Fit& fit) {
  const double residuals = std::max(1.0, static_cast<double>(fit.residual_count));
  const double effective = errors.scatter.empty() ? residuals : errors.independent_residuals;
  const double weighed = 2.0 * fit.cost * std::min(1.0, effective / residuals);
  fit.aic = std::optional(weighed + 2.0 * errors.rank);
  fit.bic = std::optional(weighed + errors.rank * std::log(std::max(1.0, effective)));
}

/// Judges, from the residuals, the noise and the intervals that are based on it.
void judge_residuals(const Problem& problem, const OptimumCheck& check, const Uncertainty& errors,
                     Fit& fit) {
  if (errors.independent_residuals > 0.0)
    fit.independent_residuals = std::optional(errors.independent_residuals);
  fit.lack_of_fit->tests = lack_of_fit(problem, errors);
  fit.lack_of_fit->misfit = misfit(fit.lack_of_fit->tests);
  fit.interval_advice = interval_advice(problem, check, errors, fit.lack_of_fit->tests);
  fit.between_repeats = between_repeats(problem, errors);
  if (fit.between_repeats && fit.between_repeats->differ)
    fit.warnings.push_back(between_repeats_warning(*fit.between_repeats));
  if (errors.noiseless > 0) fit.warnings.push_back(noiseless_warning(problem, errors));
  if (!errors.known.names.empty()) {
    fit.interval_advice += fmt::format("; the errors include those of known values: {}",
                                       fmt::join(errors.known.names, ", "));
  }
  if (errors.rank > 0) rate_model(errors, fit);
}

/// Adds measures that would determine the parameters which the records leave undetermined. Only the
/// first few parameters are treated, because each measure must be tried out. Parameters that a
/// symmetry leaves undetermined are described separately.
void add_remedies(const Problem& problem, const Evaluation& optimum,
                  const std::vector<std::size_t>& symmetric, const Uncertainty& errors,
                  std::vector<FittedParameter>& parameters) {
  constexpr int kMostTried = 4;  // each requires several simulations
  int tried = 0;
  const Linearisation system = linearise(problem, optimum);
  if (!system.own.empty()) return;  // trying a measure requires a dense matrix for all unknowns
  for (std::size_t j = 0; j < parameters.size() && tried < kMostTried; ++j) {
    FittedParameter& each = parameters[j];
    if (each.nuisance || each.identifiability != Identifiability::not_identifiable) continue;
    if (std::find(symmetric.begin(), symmetric.end(), j) != symmetric.end()) continue;
    if (rests_on_known(problem, errors, optimum.z, j)) {
      each.reason += fmt::format(
          "; most of that is the uncertainty of {}: made a free parameter with a prior (for a "
          "sensor: its gain or offset), the records may reduce it",
          fmt::join(errors.known.names, ", "));
      continue;
    }
    ++tried;
    const auto words = remedies(problem, optimum.z, system.jacobian, j);
    if (!words.empty())
      each.reason += fmt::format("; {} would make it identifiable", fmt::join(words, ", or "));
  }
}

/// Adds the combinations that are determined although their parameters are not, and the measures
/// that would determine these parameters.
///
/// @return  the unknowns that a scaling symmetry leaves undetermined
std::vector<std::size_t> judge_identifiability(const Problem& problem, const Evaluation& optimum,
                                               const Uncertainty& errors, int threads, Fit& fit) {
  const double sigma = std::sqrt(std::max(1.0, errors.reduced_chi_square));
  const auto symmetry = scaling_symmetry(problem, optimum.z, sigma, threads);
  const std::string symmetric = symmetry ? describe(problem, *symmetry) : "";
  if (symmetry) grade_symmetric(problem, *symmetry, fit.parameters);
  fit.combinations = name_combinations(problem, optimum.z, errors, fit.parameters);
  if (!symmetric.empty()) {
    // The reasons given for the parameters already contain the other combinations.
    fit.combinations.insert(fit.combinations.begin(), symmetric);
    fit.warnings.push_back(symmetric);
  }
  const auto open = symmetry && symmetry->holds() ? symmetry->unknowns : std::vector<std::size_t>();
  if (errors.detail == Detail::full) add_remedies(problem, optimum, open, errors, fit.parameters);
  return open;
}

}  // namespace

std::vector<std::size_t> describe_findings(const Problem& problem, const Evaluation& optimum,
                                           const OptimumCheck& check, const Uncertainty& errors,
                                           int threads, Fit& fit) {
  fit.cost = optimum.cost;
  fit.rank = errors.rank;
  fit.singular_values = errors.singular_values;
  if (errors.rank > 0) fit.reduced_chi_square = errors.reduced_chi_square;
  fit.parameters = describe_unknowns(problem, optimum, check, errors);
  const double variance = std::max(1.0, errors.reduced_chi_square);
  fit.basins = basins(fit.starts, fit.parameters, variance);
  fit.agreement = agreement_of(fit.starts, fit.basins, variance);
  auto open = judge_identifiability(problem, optimum, errors, threads, fit);
  judge_residuals(problem, check, errors, fit);
  add_correlation(problem, errors, fit);
  warn_of_noise(problem, errors, fit);
  if (fit.status == FitStatus::stopped) {
    withhold_grades(fit.parameters);
  } else {
    warn_of_parameters(problem, fit.parameters, fit);
  }
  warn_of_priors(problem, fit.parameters, fit);
  return open;
}

}  // namespace rigcal::calib
