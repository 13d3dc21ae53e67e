#include "calib/posterior/effect_step.hpp"

#include <cmath>

namespace rigcal::calib {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

double log_density_beside(const SizesBeside& sizes, const VectorXd& e) {
  return sizes.slope.dot(e) - 0.5 * e.dot(sizes.precision * e);
}

}  // namespace

double positive_normal(datasets::RandomStream& stream, double mean, double sd) {
  const double least = -mean / sd;
  if (least <= 0.0) {
    for (;;) {
      const double x = datasets::normal(stream, 1.0);
      if (x >= least) return mean + sd * x;
    }
  }
  // In the tail, an exponential distribution is close (Robert, Statistics and Computing 5, 1995).
  const double rate = 0.5 * (least + std::sqrt(least * least + 4.0));
  for (;;) {
    const double beyond = -std::log1p(-datasets::uniform(stream, 0.0, 1.0)) / rate;
    const double off = least + beyond - rate;
    if (datasets::uniform(stream, 0.0, 1.0) <= std::exp(-0.5 * off * off)) return sd * beyond;
  }
}

void sweep_sizes(const SizesBeside& sizes, int sweeps, datasets::RandomStream& stream,
                 VectorXd& e) {
  const Index count = e.size();
  const auto draw = [&](Index k) {
    const double precision = sizes.precision(k, k);
    const double mean = e(k) + (sizes.slope(k) - sizes.precision.row(k).dot(e)) / precision;
    const double sd = 1.0 / std::sqrt(precision);
    e(k) = sizes.one_sided[static_cast<std::size_t>(k)] ? positive_normal(stream, mean, sd)
                                                        : mean + sd * datasets::normal(stream, 1.0);
  };
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (Index k = 0; k < count; ++k) draw(k);
    for (Index k = count; k-- > 0;) draw(k);
  }
}

SizeStep step_sizes(const PosteriorDensity& density, int sweeps, datasets::RandomStream& stream,
                    VectorXd& y, VectorXd& e) {
  const SizesBeside& sizes = density.sizes_beside();
  VectorXd next = e;
  sweep_sizes(sizes, sweeps, stream, next);
  const double chance = datasets::uniform(stream, 0.0, 1.0);
  const auto there = density.moved(y, e, next);
  if (!there) return {};
  // The densities are those of the unknowns in the unit box, in which the move keeps volumes.
  const auto weight = [&](const VectorXd& point, const VectorXd& at) {
    return density.value(point, at) - density.log_volume(point) - log_density_beside(sizes, at);
  };
  const double rise = weight(*there, next) - weight(y, e);
  constexpr int kPoints = 2;  // here and there
  if (!(std::log(chance) < rise)) return {false, kPoints};
  y = *there;
  e = std::move(next);
  return {true, kPoints};
}

}  // namespace rigcal::calib
