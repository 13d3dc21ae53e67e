#include "calib/trust/uncertainty.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "calib/problem/arrow_svd.hpp"
#include "calib/problem/repeat_inputs.hpp"
#include "calib/search/optimum.hpp"
#include "calib/trust/coherent_error.hpp"
#include "common/parallel.hpp"
#include "metrics/distributions.hpp"

namespace rigcal::calib {
namespace {

/// A parameter belongs to a null direction if its fraction of the effect on the outputs exceeds
/// kFelt, or if its motion in the box relative to the largest motion exceeds kMoves.
constexpr double kFelt = 0.1;
constexpr double kMoves = 0.05;
/// Maximum number of partners that are named. Without a limit there could be many: an offset common
/// to all records, for example, is linked with the offset of each record.
constexpr std::size_t kMostPartners = 12;
/// Significance level for naming a cause of a difference between repeats. It is low, because every
/// fit is tested.
constexpr double kDifferenceLevel = 0.01;

/// Returns the score rows of every condition, in the coordinates of `root`.
std::vector<ScoreRows> score_rows(const Problem& problem, std::vector<ConditionRows> rows,
                                  const ArrowRoot& root) {
  std::vector<ScoreRows> result(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    result[i].jacobian = rows[i].jacobian * root.rows(problem.map.acting(i), i);
    result[i].residual = std::move(rows[i].residual);
    rows[i].jacobian.resize(0, 0);
    result[i].channels = static_cast<Eigen::Index>(problem.conditions[i].channels.size());
  }
  return result;
}

std::string null_reason(const Problem& problem, const std::vector<int>& members,
                        std::size_t unknown) {
  std::vector<std::string> partners;
  std::size_t unnamed = 0;
  for (const int member : members) {
    const auto u = static_cast<std::size_t>(member);
    if (u == unknown) continue;
    if (partners.size() < kMostPartners) {
      partners.push_back(problem.name(u));
    } else {
      ++unnamed;
    }
  }
  if (unnamed > 0) partners.push_back(fmt::format("{} others", unnamed));
  if (partners.empty())
    return fmt::format("no output of these conditions responds to {}", problem.name(unknown));
  return fmt::format("these conditions determine {} only in a combination with {}, not by itself",
                     problem.name(unknown), fmt::join(partners, ", "));
}

}  // namespace

std::vector<Eigen::MatrixXd> scores_of_repeats(const Problem& problem, std::span<const double> z,
                                               const std::vector<ScoreRows>& rows, int threads) {
  std::vector<Eigen::MatrixXd> result(rows.size());
  parallel_for(rows.size(), threads, [&](std::size_t i) {
    Eigen::MatrixXd deviations =
        repeat_deviations(problem.conditions[i], explained_by_inputs(problem, i, z));
    const Eigen::MatrixXd declared = explained_by_declared(problem, i, z, deviations);
    if (declared.size() > 0) deviations -= declared;
    result[i] = repeat_scores(rows[i].all_rows(), deviations);
  });
  return result;
}

void add_prior_information(const Problem& problem, std::span<const double> z, const ArrowRoot& root,
                           ArrowMatrix& sum) {
  for (std::size_t j = 0; j < z.size(); ++j) {
    const double weight = problem.map.prior_slope(static_cast<int>(j), z[j]);
    if (weight == 0.0) continue;
    const auto unknown = static_cast<Eigen::Index>(j);
    // Shared unknowns have components only in the shared directions, which every condition
    // contains.
    const int whose = root.condition_of(unknown);
    if (whose < 0) {
      const auto row = root.shared().row(root.row_of(unknown));
      sum.shared += weight * weight * row.transpose() * row;
    } else {
      const auto i = static_cast<std::size_t>(whose);
      const Eigen::VectorXd row = root.row(unknown, i);
      sum.add(i, weight * weight * row * row.transpose());
    }
  }
}

bool Uncertainty::repeats_differ() const {
  const auto least = std::min_element(repeats_p.begin(), repeats_p.end());
  return least != repeats_p.end() &&
         *least * static_cast<double>(repeats_p.size()) < metrics::kWarningLevel;
}

double Uncertainty::correlation(Eigen::Index a, Eigen::Index b) const {
  if (a == b) return 1.0;
  const double scale = std::sqrt(root.product(a, a) * root.product(b, b));
  return scale > 0.0 ? std::clamp(root.product(a, b) / scale, -1.0, 1.0) : 0.0;
}

Uncertainty uncertainty(const Problem& problem, const Evaluation& optimum,
                        std::vector<ConditionRows> rows, int threads, Detail detail) {
  const Linearisation system = linearise(problem, optimum);
  const auto n = static_cast<Eigen::Index>(optimum.z.size());
  const ArrowSvd svd(system, rank_threshold(problem.tolerance));
  const Eigen::Index rank = svd.rank();
  const Eigen::VectorXd s = svd.singular_values();
  const Eigen::VectorXd& inverse_lengths = svd.inverse_lengths();

  Uncertainty result;
  result.detail = detail;
  result.rank = static_cast<int>(rank);
  result.singular_values.assign(s.data(), s.data() + s.size());
  const double freedom = static_cast<double>(problem.residual_count() - rank);
  result.reduced_chi_square = freedom > 0.0 ? 2.0 * optimum.cost / freedom : 0.0;
  result.freedom = std::max(freedom, 1.0);

  // Square root of (J^T J)^-1 in the unit box, in the directions that the data determine.
  const ArrowRoot root = svd.root();
  const double sigma = std::sqrt(std::max(1.0, result.reduced_chi_square));
  const double least = std::max(s(0) * rank_threshold(problem.tolerance), 1e-150);
  result.covariance_root = svd.covariance_root(sigma, least);
  result.root = root;
  result.known = known_uncertainty(problem, optimum.z, rows, root, threads);
  if (detail == Detail::full) {
    const Eigen::VectorXd days = day_errors(problem, optimum.z, rows, root, threads);
    for (Eigen::Index j = 0; j < n; ++j)
      result.between_days.push_back(
          days(j) * problem.map.slope(static_cast<int>(j), optimum.z[static_cast<std::size_t>(j)]));
  }
  ArrowMatrix priors = root.zero();
  add_prior_information(problem, optimum.z, root, priors);
  std::vector<ScoreRows> scores;
  std::vector<Eigen::MatrixXd> repeats;
  Eigen::VectorXd coherent = Eigen::VectorXd::Zero(n);
  if (detail == Detail::full && rank > 0 && freedom > 0.0) {
    scores = score_rows(problem, std::move(rows), root);
    result.scatter = score_contributions(scores, priors, root, threads);
    repeats = scores_of_repeats(problem, optimum.z, scores, threads);
    const auto noiseless = noiseless_channels(problem, optimum);
    for (const auto& channels : noiseless)
      result.noiseless += static_cast<int>(std::count(channels.begin(), channels.end(), true));
    if (result.noiseless > 0) coherent = coherent_errors(scores, noiseless, root);
    for (const ScoreContribution& each : result.scatter)
      result.independent_residuals += each.independent_residuals;
  }

  // The reason given for a parameter names the other parameters in its null directions.
  std::vector<std::vector<int>> directions;
  for (const ArrowSvd::Direction& each : svd.undetermined()) {
    std::vector<int>& members = directions.emplace_back();
    const Eigen::VectorXd moves =
        inverse_lengths(each.unknowns).cwiseProduct(each.parts).cwiseAbs();
    for (Eigen::Index j = 0; j < moves.size(); ++j) {
      if (std::abs(each.parts(j)) > kFelt || moves(j) > kMoves * moves.maxCoeff())
        members.push_back(each.unknowns[static_cast<std::size_t>(j)]);
    }
  }
  result.standard_error.resize(optimum.z.size());
  result.robust_standard_error.resize(optimum.z.size());
  result.robust_freedom.resize(optimum.z.size(), 0.0);
  result.robust_quantile.resize(optimum.z.size(), 0.0);
  result.from_repeats.resize(optimum.z.size(), false);
  result.repeats_ratio.resize(optimum.z.size(), 0.0);
  result.repeats_p.resize(optimum.z.size(), 1.0);
  result.reason.resize(optimum.z.size());
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto u = static_cast<std::size_t>(j);
    if (inverse_lengths(j) == 0.0) {
      result.reason[u] = null_reason(problem, {}, u);
      continue;
    }
    const auto direction =
        std::find_if(directions.begin(), directions.end(), [u](const auto& members) {
          return std::find(members.begin(), members.end(), static_cast<int>(u)) != members.end();
        });
    if (direction != directions.end()) {
      result.reason[u] = null_reason(problem, *direction, u);
      continue;
    }
    const double slope = problem.map.slope(static_cast<int>(j), optimum.z[u]);
    const bool exact = result.known.names.empty();
    const double carried = exact ? 0.0 : result.known.response.row(j).norm();
    const double plain = std::max(sigma * std::sqrt(root.product(j, j)), coherent(j));
    result.standard_error[u] = slope * std::hypot(plain, carried);
    if (!result.scatter.empty()) {
      const RobustVariance robust = robust_variance(result.scatter, priors, root, j);
      const RepeatVariance between = repeat_variance(repeats, result.scatter, priors, root, j);
      if (between.freedom > 0.0 && robust.variance > 0.0) {
        result.repeats_ratio[u] = std::sqrt(between.variance / robust.variance);
        result.repeats_p[u] = exceedance(between, robust);
        result.from_repeats[u] = rests_on_repeats(between, robust);
      }
      const bool repeated = result.from_repeats[u];
      const double error = std::sqrt(std::max(0.0, repeated ? between.variance : robust.variance));
      result.robust_standard_error[u] = slope * std::hypot(std::max(error, coherent(j)), carried);
      result.robust_freedom[u] = repeated ? between.freedom : robust.freedom;
      result.robust_quantile[u] = repeated ? student_t(between.freedom) : robust.quantile();
    }
  }
  if (detail == Detail::plain) return result;
  CauseEffects effects(problem, optimum.z);
  auto difference = likely_difference(effects, scores, repeats);
  if (difference) difference->p = difference_by_noise(effects, difference->cause);
  if (difference && (difference->p < kDifferenceLevel || result.repeats_differ()))
    result.difference = difference;
  for (ScoreRows& each : scores) each.make_narrow();
  result.scores = std::move(scores);
  return result;
}

}  // namespace rigcal::calib
