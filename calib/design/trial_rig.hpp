#pragma once

#include <Eigen/Core>
#include <atomic>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "calib/design/design_limits.hpp"
#include "calib/problem/problem.hpp"

namespace rigcal::calib {

/// Returns the noise in one sample of one repeat, SI, for each channel. It comes from [design],
/// from the `sd` of the channel, from [synthetic], or from the records.
///
/// @throws InputError  if the noise is unknown
std::map<datasets::Channel, double> noise_of_one_repeat(
    const datasets::Campaign& campaign, const std::vector<datasets::Record>& records);

/// The rig of a planned test, ready to be simulated with any drive.
class TrialRig {
 public:
  /// @param campaign  must contain [design]; borrowed
  /// @param noise_sd  noise in one sample of one repeat
  /// @param values    values from an earlier fit, or null
  /// @throws InputError     if no parameter is free, or the rig exceeds a limit at rest
  /// @throws NoResultError  if the rig cannot be simulated at rest
  TrialRig(const datasets::Campaign& campaign, const std::map<datasets::Channel, double>& noise_sd,
           const std::vector<datasets::FittedValue>* values, const std::atomic<bool>* cancel);
  TrialRig(const TrialRig&) = delete;
  TrialRig& operator=(const TrialRig&) = delete;

  const datasets::DesignSettings& settings() const { return *campaign_.design; }
  const Problem& problem() const { return *problem_; }
  const std::vector<double>& z() const { return z_; }
  const std::vector<double>& time_s() const { return record_.time_s; }
  /// Returns the drive at which the rig is at rest at the first sample, SI.
  double neutral() const { return neutral_; }
  /// Returns the largest allowed distance of a drive from neutral().
  double reach() const { return reach_; }

  /// Returns how much of each limit a drive uses, or std::nullopt if it cannot be simulated.
  ///
  /// @param drive  shape (samples)
  /// @param finer  number of response samples for each drive sample
  /// @param at     if not null, receives limited_outputs() at the samples of the drive
  std::optional<std::vector<LimitUse>> uses_under(const std::vector<double>& drive,
                                                  double tolerance, int finer = 1,
                                                  Eigen::MatrixXd* at = nullptr) const;
  /// Returns the weighted sensitivities of all channels to the unknowns (unit box, one column each)
  /// under a drive. Empty if the drive cannot be simulated.
  Eigen::MatrixXd sensitivities(const std::vector<double>& drive, double tolerance) const;
  /// Puts a drive into the problem's condition, for code that simulates the problem itself.
  void play(const std::vector<double>& drive);
  /// Makes all further simulations ignore the cancel flag, so that the drive found so far can still
  /// be checked and kept.
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
