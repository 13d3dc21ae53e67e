#pragma once

#include <Eigen/Core>
#include <atomic>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calib/design/design_limits.hpp"
#include "calib/problem/problem.hpp"

namespace rigcal::calib {

/// Noise of a sample of one repeat, SI: that of [design], the channel's `sd`, that of [synthetic],
/// or that of the records.
///
/// @throws InputError  the noise is unknown
std::map<datasets::Channel, double> noise_of_one_repeat(
    const datasets::Campaign& campaign, const std::vector<datasets::Record>& records);

/// The rig of a planned test, ready to be simulated with any drive.
class TrialRig {
 public:
  /// @param campaign  with [design]; borrowed
  /// @param noise_sd  of a sample of one repeat
  /// @param values    of an earlier fit, or null
  /// @throws InputError     nothing is free, or a limit that the rig breaks at rest
  /// @throws NoResultError  the rig cannot be simulated at rest
  TrialRig(const datasets::Campaign& campaign, const std::map<datasets::Channel, double>& noise_sd,
           const std::vector<datasets::FittedValue>* values, const std::atomic<bool>* cancel);
  TrialRig(const TrialRig&) = delete;
  TrialRig& operator=(const TrialRig&) = delete;

  const datasets::DesignSettings& settings() const { return *campaign_.design; }
  const Problem& problem() const { return *problem_; }
  const std::vector<double>& z() const { return z_; }
  const std::vector<double>& time_s() const { return record_.time_s; }
  /// Drive at which the rig rests at the first sample, SI.
  double neutral() const { return neutral_; }
  /// Largest distance of a drive from there.
  double reach() const { return reach_; }

  /// Limits under a drive, nothing where it cannot be simulated.
  ///
  /// @param drive   shape (samples)
  /// @param finer   samples of the response for each of the drive
  /// @param at      if not null, receives limited_outputs() at the samples of the drive
  std::optional<std::vector<LimitUse>> uses_under(const std::vector<double>& drive,
                                                  double tolerance, int finer = 1,
                                                  Eigen::MatrixXd* at = nullptr) const;
  /// Weighted sensitivities of all channels under a drive, one column per unknown in the unit box;
  /// empty where it cannot be simulated.
  Eigen::MatrixXd sensitivities(const std::vector<double>& drive, double tolerance) const;
  /// Makes a drive that of the problem's condition, for what simulates the problem itself.
  void play(const std::vector<double>& drive);
  /// From now on no flag ends a simulation: what was found is checked and kept.
  void finish() { cancel_ = nullptr; }

 private:
  model::SimulationInputs driven_by(const std::vector<double>& drive) const;
  void rest(const std::map<datasets::Channel, double>& noise_sd);
  void require_limits_at_rest(const Eigen::MatrixXd& run) const;
  double find_reach() const;

  datasets::Campaign campaign_;
  datasets::Condition condition_;
  datasets::Record record_;
  std::unique_ptr<Problem> problem_;
  std::vector<double> z_;
  double neutral_ = 0.0;
  double first_position_m_ = 0.0;
  double reach_ = 0.0;
  const std::atomic<bool>* cancel_;
};

}  // namespace rigcal::calib
