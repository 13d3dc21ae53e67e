#include "datasets/checks/swapped_chambers.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace rigcal::datasets {
namespace {

constexpr double kOfAcceleration = 0.8;  // partial correlation
constexpr double kOfVelocity = 0.1;      // partial correlation; friction may be small
constexpr double kLeastOwnShare = 0.01;  // fraction of an acceleration
constexpr double kEqualStep = 0.1;       // fraction of the time step
constexpr double kSmoothSign = 0.05;     // fraction of the highest speed
constexpr Eigen::Index kFewestMeans = 100;
constexpr std::size_t kMostMeans = 20'000;  // so that a record of an hour costs no second

/// Motion and pressures at equal time steps, all smoothed alike.
struct ChamberMotion {
  Eigen::VectorXd position, speed, acceleration, pressure_a, pressure_b;
};

Eigen::VectorXd block_means(const std::vector<double>& values, std::size_t length) {
  Eigen::VectorXd means(static_cast<Eigen::Index>(values.size() / length));
  for (Eigen::Index i = 0; i < means.size(); ++i)
    means[i] =
        Eigen::Map<const Eigen::VectorXd>(values.data() + static_cast<std::size_t>(i) * length,
                                          static_cast<Eigen::Index>(length))
            .mean();
  return means;
}

/// @param length  samples in a block
ChamberMotion motion_in_blocks(const std::vector<double>& position,
                               const std::vector<double>& pressure_a,
                               const std::vector<double>& pressure_b, std::size_t length) {
  const Eigen::VectorXd x = block_means(position, length);
  const Eigen::Index n = x.size() - 2;
  const auto smooth = [n](const Eigen::VectorXd& y) -> Eigen::VectorXd {
    return 0.25 * (y.head(n) + 2.0 * y.segment(1, n) + y.tail(n));
  };
  return {smooth(x), 0.5 * (x.tail(n) - x.head(n)), x.head(n) - 2.0 * x.segment(1, n) + x.tail(n),
          smooth(block_means(pressure_a, length)), smooth(block_means(pressure_b, length))};
}

/// Partial correlations of a motion with both pressures.
struct Partial {
  double a = 0.0;
  double b = 0.0;
};

/// @param known  shape (n, m), what is taken out of all of them first
std::optional<Partial> partial(const Eigen::VectorXd& motion, const ChamberMotion& in,
                               const Eigen::MatrixXd& known) {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver(known);
  const auto beyond = [&](const Eigen::VectorXd& y) -> Eigen::VectorXd {
    return y - known * solver.solve(y);
  };
  const Eigen::VectorXd own = beyond(motion);
  const Eigen::VectorXd a = beyond(in.pressure_a);
  const Eigen::VectorXd b = beyond(in.pressure_b);
  if (!(own.squaredNorm() > kLeastOwnShare * motion.squaredNorm())) return std::nullopt;
  if (!(a.norm() > 0.0 && b.norm() > 0.0)) return std::nullopt;
  return Partial{own.dot(a) / (own.norm() * a.norm()), own.dot(b) / (own.norm() * b.norm())};
}

bool is_swapped(const ChamberMotion& in) {
  const Eigen::Index n = in.position.size();
  const double fastest = in.speed.cwiseAbs().maxCoeff();
  const Eigen::VectorXd x = in.position.array() - in.position.mean();
  const double range = x.cwiseAbs().maxCoeff();
  if (!(fastest > 0.0 && range > 0.0)) return false;
  const Eigen::VectorXd sign = (in.speed.array() / (kSmoothSign * fastest)).tanh();
  Eigen::MatrixXd known(n, 5);
  known << Eigen::VectorXd::Ones(n), x / range, (x / range).cwiseAbs2(), in.speed / fastest, sign;
  const auto inertia = partial(in.acceleration, in, known);
  if (!inertia || !(inertia->a < -kOfAcceleration && inertia->b > kOfAcceleration)) return false;
  Eigen::MatrixXd load(n, 4);
  load << known.leftCols(3),
      in.acceleration / std::max(in.acceleration.cwiseAbs().maxCoeff(), 1e-300);
  const auto friction = partial(in.speed, in, load);
  return friction && friction->a < -kOfVelocity && friction->b > kOfVelocity;
}

bool has_equal_steps(const std::vector<double>& time_s) {
  const double step_s = (time_s.back() - time_s.front()) / static_cast<double>(time_s.size() - 1);
  for (std::size_t i = 1; i < time_s.size(); ++i)
    if (!(std::abs(time_s[i] - time_s[i - 1] - step_s) <= kEqualStep * step_s)) return false;
  return true;
}

}  // namespace

std::string swapped_chambers_warning(const Campaign& campaign, const Record& record) {
  const ChannelInfo& motion = info(motion_channel(campaign));
  const auto values = [&](Channel channel) -> const std::vector<double>* {
    const auto found = record.channels.find(channel);
    const auto setting = campaign.channels.find(channel);
    const bool in_counts = setting != campaign.channels.end() && setting->second.in_counts;
    const bool is_ignored =
        setting != campaign.channels.end() && setting->second.role == ChannelRole::ignore;
    if (found == record.channels.end() || in_counts || is_ignored) return nullptr;
    const std::vector<double>& mean = found->second.mean;
    const bool finite =
        std::all_of(mean.begin(), mean.end(), [](double v) { return std::isfinite(v); });
    return finite ? &mean : nullptr;  // a bridged hole has no numbers
  };
  const auto* position = values(motion.channel);
  const auto* pressure_a = values(Channel::pressure_a);
  const auto* pressure_b = values(Channel::pressure_b);
  if (position == nullptr || pressure_a == nullptr || pressure_b == nullptr) return {};
  if (record.time_s.size() < 3 || !has_equal_steps(record.time_s)) return {};
  const std::size_t shortest = record.time_s.size() / kMostMeans + 1;
  for (const std::size_t length : {2 * shortest, 4 * shortest}) {
    const ChamberMotion in = motion_in_blocks(*position, *pressure_a, *pressure_b, length);
    if (in.position.size() < kFewestMeans || !is_swapped(in)) return {};
  }
  return fmt::format(
      "pressure_a falls and pressure_b rises where the {0} accelerates, as if each were that of "
      "the other chamber: are their columns swapped, or is the sign of the {0} wrong?",
      motion.key);
}

}  // namespace rigcal::datasets
