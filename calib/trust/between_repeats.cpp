#include "calib/trust/between_repeats.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "calib/problem/repeat_inputs.hpp"
#include "calib/trust/known_uncertainty.hpp"
#include "metrics/distributions.hpp"

namespace rigcal::calib {
namespace {

/// Significance level for pooling, from Bancroft and Han (docs/uncertainty.md). It keeps the
/// coverage close to 95 % for any true ratio.
constexpr double kPoolingLevel = 0.25;
/// Above this number of degrees of freedom, Fisher's F agrees to six digits with its limit for
/// infinitely many.
constexpr double kFreedomWithoutEnd = 1e6;
/// A cause is named if it explains at least this fraction of the squares. A second cause can then
/// explain at most a quarter as much.
constexpr double kMostlyExplained = 0.8;

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Returns the number of repeats that have deviations in every channel of the condition, or 0 if
/// the channels do not have deviations for the same runs.
std::size_t common_repeats(const ProblemCondition& condition) {
  const auto deviations = [&](const ProblemChannel& channel) {
    return condition.record->channels.at(channel.channel).deviations.size();
  };
  const std::size_t first = deviations(condition.channels.front());
  const bool same = std::all_of(condition.channels.begin(), condition.channels.end(),
                                [&](const auto& channel) { return deviations(channel) == first; });
  return same && first > 1 ? first : 0;
}

/// Returns the slope of a series at a sample, per second. At the ends, the difference is one-sided.
double slope(const std::vector<double>& x, const std::vector<double>& time_s, std::size_t at) {
  const std::size_t before = at > 0 ? at - 1 : at;
  const std::size_t after = std::min(at + 1, x.size() - 1);
  return after > before ? (x[after] - x[before]) / (time_s[after] - time_s[before]) : 0.0;
}

/// Returns the weighted d mean / dt for all channels, which is how much a later start lowers them,
/// per second.
VectorXd slopes(const ProblemCondition& condition) {
  const std::size_t samples = condition.rows.size();
  VectorXd result(static_cast<Index>(samples * condition.channels.size()));
  for (std::size_t k = 0; k < condition.channels.size(); ++k) {
    const ProblemChannel& channel = condition.channels[k];
    const auto& mean = condition.record->channels.at(channel.channel).mean;
    for (std::size_t t = 0; t < samples; ++t) {
      result(static_cast<Index>(k * samples + t)) =
          slope(mean, condition.record->time_s, condition.rows[t]) / channel.sd;
    }
  }
  return result;
}

/// Returns true if the drive was recorded. The drive is then shifted together with the outputs, so
/// that a common delay adds no uncertainty.
bool start_is_known(const ProblemCondition& condition) {
  return condition.condition->waveform == datasets::Waveform::recorded;
}

/// Returns the scores that one unit of each cause produces in one condition. The start comes last.
/// Shape (directions, causes).
MatrixXd cause_scores(CauseEffects& effects, std::size_t condition, const MatrixXd& jacobian) {
  const ProblemCondition& own = effects.problem().conditions[condition];
  const std::vector<double> values = effects.values(condition);
  MatrixXd result = MatrixXd::Zero(jacobian.cols(), static_cast<Index>(values.size()) + 1);
  const MatrixXd& felt = effects.of(condition);
  for (std::size_t p = 0; p < values.size() && felt.size() > 0; ++p) {
    const auto column = static_cast<Index>(p);
    result.col(column) = jacobian.transpose() * felt.col(column) * values[p];
  }
  if (!start_is_known(own)) result.rightCols(1) = -jacobian.transpose() * slopes(own);
  return result;
}

/// Returns the parameters that act in a condition and are declared to differ between repeats.
std::vector<datasets::ParameterSetting> declared_in(const Problem& problem, std::size_t condition) {
  std::vector<datasets::ParameterSetting> result;
  for (const int j : problem.map.acting(condition)) {
    const int index = problem.map.unknowns()[static_cast<std::size_t>(j)].index;
    const auto* setting = problem.campaign->setting(index);
    if (setting != nullptr && setting->between_repeats) result.push_back(*setting);
  }
  return result;
}

/// Returns the change in the weighted outputs per SI unit of a cause, or per second for the start.
VectorXd effect_of(CauseEffects& effects, std::size_t condition, const std::string& cause) {
  const auto& causes = effects.causes();
  const auto found = std::find(causes.begin(), causes.end(), cause);
  if (found == causes.end()) return -slopes(effects.problem().conditions[condition]);
  const MatrixXd& felt = effects.of(condition);
  return felt.size() > 0 ? VectorXd(felt.col(found - causes.begin())) : VectorXd();
}

/// Sum of squared deviations along a direction, and the value expected for this sum if there is
/// only noise.
struct AlongCause {
  double squares = 0.0;
  double noise = 0.0;
};

/// A record is divided into this many intervals, which are treated as independent: nineteen degrees
/// of freedom.
constexpr Index kStretches = 20;

AlongCause along(const VectorXd& direction, const MatrixXd& deviations) {
  const VectorXd unit = direction.normalized();
  const Eigen::RowVectorXd size = unit.transpose() * deviations;
  const MatrixXd left = deviations - unit * size;
  AlongCause result;
  result.squares = size.squaredNorm();
  for (Index k = 0; k < kStretches; ++k) {
    const Index first = k * unit.size() / kStretches;
    const Index count = (k + 1) * unit.size() / kStretches - first;
    result.noise +=
        (unit.segment(first, count).transpose() * left.middleRows(first, count)).squaredNorm();
  }
  result.noise *= static_cast<double>(kStretches) / static_cast<double>(kStretches - 1);
  return result;
}

}  // namespace

CauseEffects::CauseEffects(const Problem& problem, std::span<const double> z)
    : problem_(problem), z_(z), effects_(problem.conditions.size()) {
  for (const char* key : {"supply_pressure", "bulk_modulus"}) {
    const int index = model::parameter_index(problem.campaign->rig.plant, key);
    const auto* setting = problem.campaign->setting(index);
    if (index < 0 || (setting != nullptr && setting->between_repeats)) continue;
    causes_.emplace_back(key);
    indices_.push_back(index);
  }
}

std::vector<double> CauseEffects::values(std::size_t condition) const {
  const auto all = problem_.values_at(condition, z_);
  std::vector<double> result;
  for (const int index : indices_) result.push_back(all.value[static_cast<std::size_t>(index)]);
  return result;
}

const Eigen::MatrixXd& CauseEffects::of(std::size_t condition) {
  auto& effects = effects_[condition];
  if (!effects) effects = known_sensitivities(problem_, condition, z_, indices_);
  return *effects;
}

Eigen::MatrixXd CauseEffects::explained_by_inputs(std::size_t condition) const {
  return calib::explained_by_inputs(problem_, condition, z_);
}

MatrixXd repeat_deviations(const ProblemCondition& condition, const MatrixXd& explained) {
  const std::size_t repeats = common_repeats(condition);
  if (repeats == 0) return {};
  const datasets::Record& record = *condition.record;
  const std::size_t samples = condition.rows.size();
  MatrixXd result(static_cast<Index>(samples * condition.channels.size()),
                  static_cast<Index>(repeats));
  for (std::size_t k = 0; k < condition.channels.size(); ++k) {
    const ProblemChannel& channel = condition.channels[k];
    const auto& deviations = record.channels.at(channel.channel).deviations;
    for (std::size_t r = 0; r < repeats; ++r) {
      for (std::size_t t = 0; t < samples; ++t) {
        const double deviation = deviations[r][condition.rows[t]];
        result(static_cast<Index>(k * samples + t), static_cast<Index>(r)) =
            std::isfinite(deviation) ? deviation / channel.sd : 0.0;
      }
    }
  }
  if (explained.cols() == result.cols()) result -= explained;
  if (start_is_known(condition) || record.repeat_reports.size() != repeats) return result;
  const VectorXd per_second = slopes(condition);
  for (std::size_t r = 0; r < repeats; ++r)
    result.col(static_cast<Index>(r)) -= record.repeat_reports[r].shifted_s * per_second;
  return result;
}

MatrixXd explained_by_declared(const Problem& problem, std::size_t condition,
                               std::span<const double> z, const MatrixXd& deviations) {
  const std::vector<datasets::ParameterSetting> declared = declared_in(problem, condition);
  if (declared.empty() || deviations.cols() == 0) return {};
  std::vector<int> indices;
  for (const auto& setting : declared) indices.push_back(setting.index);
  MatrixXd felt = known_sensitivities(problem, condition, z, indices);
  if (felt.size() == 0) return {};
  for (std::size_t j = 0; j < declared.size(); ++j)
    felt.col(static_cast<Index>(j)) *= declared[j].prior->sd;
  MatrixXd normal = felt.transpose() * felt;
  // The weights are those of the mean. The variance of a single repeat is larger by a factor equal
  // to the number of repeats.
  normal.diagonal().array() += static_cast<double>(deviations.cols());
  return felt * normal.llt().solve(felt.transpose() * deviations);
}

MatrixXd repeat_scores(const MatrixXd& jacobian, const MatrixXd& deviations) {
  if (deviations.cols() == 0) return {};
  const MatrixXd scores = jacobian.transpose() * deviations;
  return scores.colwise() - scores.rowwise().mean();
}

RepeatVariance repeat_variance(const std::vector<MatrixXd>& scores,
                               const std::vector<ScoreContribution>& scatter,
                               const ArrowMatrix& priors, const ArrowRoot& combinations,
                               Index unknown) {
  double variance = combinations.quadratic(unknown, priors);
  double squares = 0.0;
  bool any = false;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const auto repeats = static_cast<double>(scores[i].cols());
    const bool single = scores[i].cols() > 1;
    const VectorXd c = combinations.row(unknown, i);
    const double part =
        single ? (scores[i].transpose() * c).squaredNorm() / (repeats * (repeats - 1.0))
               : c.dot(scatter[i].covariance * c);
    const double freedom =
        single ? repeats - 1.0 : freedom_in(scatter[i], combinations, unknown, i);
    any = any || (single && part > 0.0);
    variance += part;
    if (freedom > 0.0) squares += part * part / freedom;
  }
  if (!any) return {};
  return {variance, std::min(variance * variance / squares, kFreedomWithoutEnd)};
}

double exceedance(const RepeatVariance& repeats, const RobustVariance& robust) {
  if (!(repeats.freedom > 0.0) || !(robust.variance > 0.0)) return 1.0;
  return metrics::fisher_f_exceedance(repeats.variance / robust.variance, repeats.freedom,
                                      std::min(robust.freedom, kFreedomWithoutEnd));
}

bool rests_on_repeats(const RepeatVariance& repeats, const RobustVariance& robust) {
  return exceedance(repeats, robust) < kPoolingLevel;
}

std::optional<LikelyDifference> likely_difference(CauseEffects& effects,
                                                  const std::vector<ScoreRows>& rows,
                                                  const std::vector<MatrixXd>& scores) {
  std::vector<std::string> causes = effects.causes();
  causes.emplace_back("start");
  const auto count = static_cast<Index>(causes.size());
  VectorXd explained = VectorXd::Zero(count);  // sum of squared scores that each cause explains
  VectorXd size = VectorXd::Zero(count);
  double all = 0.0;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    if (scores[i].cols() == 0) continue;
    const MatrixXd unit = cause_scores(effects, i, rows[i].all_rows());
    all += scores[i].squaredNorm();
    for (Index c = 0; c < count; ++c) {
      const double square = unit.col(c).squaredNorm();
      const double common = (unit.col(c).transpose() * scores[i]).squaredNorm();
      if (!(square > 0.0)) continue;
      explained(c) += common / square;
      size(c) += square * static_cast<double>(scores[i].cols() - 1);
    }
  }
  Index best = 0;
  if (!(all > 0.0) || !(explained.maxCoeff(&best) > kMostlyExplained * all)) return std::nullopt;
  return LikelyDifference{causes[static_cast<std::size_t>(best)],
                          std::sqrt(explained(best) / size(best)), explained(best) / all};
}

double difference_by_noise(CauseEffects& effects, const std::string& cause) {
  const Problem& problem = effects.problem();
  double ratios = 0.0;
  double freedom = 0.0;
  for (std::size_t i = 0; i < problem.conditions.size(); ++i) {
    const MatrixXd deviations =
        repeat_deviations(problem.conditions[i], effects.explained_by_inputs(i));
    if (deviations.rows() < kStretches || deviations.cols() < 2) continue;
    const VectorXd direction = effect_of(effects, i, cause);
    if (direction.size() != deviations.rows() || !(direction.squaredNorm() > 0.0)) continue;
    const AlongCause found = along(direction, deviations);
    if (!(found.noise > 0.0)) continue;  // the repeats are equal, or differ only in this direction
    const auto own = static_cast<double>(deviations.cols() - 1);
    ratios += own * found.squares / found.noise;
    freedom += own;
  }
  if (!(freedom > 0.0)) return 1.0;
  return metrics::fisher_f_exceedance(ratios / freedom, freedom,
                                      freedom * static_cast<double>(kStretches - 1));
}

}  // namespace rigcal::calib
