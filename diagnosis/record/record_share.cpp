#include "diagnosis/record/record_share.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "common/error.hpp"
#include "datasets/campaign/campaign.hpp"
#include "metrics/mean_absolute.hpp"

namespace rigcal::diagnosis {
namespace {

std::span<const double> counted(const Eigen::MatrixXd& matrix, Eigen::Index column,
                                const SteadyPart& part) {
  return {matrix.col(column).data() + part.first, part.count};
}

SteadyPart last_periods(const std::vector<double>& time_s, double period_s, std::size_t begin,
                        std::size_t end) {
  constexpr double kSlack = 1e-6;  // fraction of a period; allows for rounded times
  const double span_s = time_s[end - 1] - time_s[begin];
  double periods = std::floor(span_s / period_s + kSlack);
  if (periods < 1.0) return {begin, end - begin};
  if (periods >= 3.0) periods -= 1.0;
  const double from_s = time_s[end - 1] - (periods + kSlack) * period_s;
  const auto first = std::lower_bound(time_s.begin(), time_s.end(), from_s) - time_s.begin();
  return {static_cast<std::size_t>(first), end - static_cast<std::size_t>(first)};
}

}  // namespace

SteadyPart steady_part(const calib::ProblemCondition& condition) {
  const datasets::Condition& c = *condition.condition;
  if (condition.rows.size() < 2) {
    throw NoResultError(fmt::format(
        "condition \"{}\": only one sample is used, and a share is a ratio of mean flows; "
        "expected at least 2",
        c.id));
  }
  const std::size_t begin = condition.rows.front();
  const std::size_t end = condition.rows.back() + 1;
  if (!is_generated_wave(c)) return {begin, end - begin};
  return last_periods(condition.record->time_s, 1.0 / *c.frequency_hz, begin, end);
}

SteadyLeak leak_in_record(const calib::ProblemCondition& condition, const model::Simulation& run,
                          Eigen::Index servo) {
  const SteadyPart part = steady_part(condition);
  const auto times = std::span(condition.record->time_s).subspan(part.first, part.count);
  const auto mean = [&](Eigen::Index column) {
    return metrics::mean_absolute(times, counted(run.outputs, column, part));
  };
  const auto slope = [&](Eigen::Index column) {
    Eigen::VectorXd result;
    if (run.sensitivities.empty()) return result;
    const auto& matrix = run.sensitivities[static_cast<std::size_t>(column)];
    if (matrix.cols() == 0) return result;  // the weights take longer than the mean
    const std::vector<double> weights =
        metrics::mean_absolute_weights(times, counted(run.outputs, column, part));
    result.resize(matrix.cols());
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
      const auto slopes = counted(matrix, j, part);
      result(j) = std::inner_product(weights.begin(), weights.end(), slopes.begin(), 0.0);
    }
    return result;
  };
  const double flow = mean(servo);
  if (!(flow > 0.0)) {
    throw NoResultError(
        fmt::format("condition \"{}\": the simulated run moves no oil, so no share of it can leak",
                    condition.condition->id));
  }
  return SteadyLeak(flow, mean(servo + 1), slope(servo), slope(servo + 1));
}

}  // namespace rigcal::diagnosis
