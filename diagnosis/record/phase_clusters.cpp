#include "diagnosis/record/phase_clusters.hpp"

#include <algorithm>
#include <cmath>

namespace rigcal::diagnosis {

std::vector<int> clusters_of(const calib::ProblemCondition& condition) {
  const datasets::Condition& c = *condition.condition;
  const bool periodic = is_periodic(c.waveform);
  std::vector<int> clusters;
  for (std::size_t i = 0; i < condition.rows.size(); ++i) {
    double place = static_cast<double>(i) / static_cast<double>(condition.rows.size());
    if (periodic && c.frequency_hz) {
      const double periods = condition.record->time_s[condition.rows[i]] * *c.frequency_hz;
      place = periods - std::floor(periods);
    }
    clusters.push_back(std::min(kClusters - 1, static_cast<int>(kClusters * place)));
  }
  return clusters;
}

std::pair<Eigen::MatrixXd, int> cluster_sandwich(const Eigen::MatrixXd& jacobian,
                                                 const Eigen::VectorXd& residual,
                                                 const Eigen::MatrixXd& bread,
                                                 const std::vector<int>& clusters) {
  const auto samples = static_cast<Eigen::Index>(clusters.size());
  const Eigen::Index p = jacobian.cols();
  Eigen::MatrixXd scores = Eigen::MatrixXd::Zero(kClusters, p);
  for (Eigen::Index row = 0; row < residual.size(); ++row) {
    const int cluster = clusters[static_cast<std::size_t>(row % samples)];
    scores.row(cluster) += jacobian.row(row) * residual(row);
  }
  const auto used =
      static_cast<int>(std::count_if(scores.rowwise().begin(), scores.rowwise().end(),
                                     [](const auto& row) { return row.squaredNorm() > 0.0; }));
  const int freedom = std::max(1, used - static_cast<int>(p));
  const double factor = static_cast<double>(used) / freedom;
  const Eigen::MatrixXd moves = bread.lazyProduct(scores.transpose());
  return {factor * moves.lazyProduct(moves.transpose()), freedom};
}

}  // namespace rigcal::diagnosis
