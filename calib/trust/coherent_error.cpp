#include "calib/trust/coherent_error.hpp"

#include <algorithm>
#include <cmath>

namespace rigcal::calib {
namespace {

/// Relative step size of a 12-bit converter (docs/uncertainty.md).
constexpr double kFinestConverter = 1.0 / 4096.0;

}  // namespace

std::vector<std::vector<bool>> noiseless_channels(const Problem& problem,
                                                  const Evaluation& optimum) {
  std::vector<std::vector<bool>> result;
  for (const ProblemCondition& condition : problem.conditions) {
    const std::vector<double>& rms = optimum.conditions[result.size()].rms;
    std::vector<bool>& channels = result.emplace_back();
    for (const ProblemChannel& channel : condition.channels) {
      const double resolved =
          std::max(problem.least_sd(channel), kFinestConverter * channel.peak_to_peak);
      channels.push_back(!channel.sd_known && rms[channels.size()] < resolved);
    }
  }
  return result;
}

Eigen::VectorXd coherent_errors(const std::vector<ScoreRows>& rows,
                                const std::vector<std::vector<bool>>& noiseless,
                                const ArrowRoot& combinations) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(combinations.unknowns());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Eigen::Index samples = rows[i].residual.size() / rows[i].channels;
    Eigen::VectorXd moved = Eigen::VectorXd::Zero(combinations.unknowns());
    for (Eigen::Index k = 0; k < rows[i].channels; ++k) {
      if (!noiseless[i][static_cast<std::size_t>(k)]) continue;
      const double residual = rows[i].residual.segment(k * samples, samples).norm();
      const auto jacobian = rows[i].jacobian.middleRows(k * samples, samples);
      const Eigen::MatrixXd square = jacobian.transpose() * jacobian;
      for (Eigen::Index j = 0; j < moved.size(); ++j) {
        const Eigen::VectorXd c = combinations.row(j, i);
        moved(j) += residual * std::sqrt(std::max(0.0, c.dot(square * c)));
      }
    }
    squares += moved.cwiseAbs2();
  }
  return squares.cwiseSqrt();
}

}  // namespace rigcal::calib
