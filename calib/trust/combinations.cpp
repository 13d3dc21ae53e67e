#include "calib/trust/combinations.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "calib/trust/unit_product.hpp"
#include "common/significant.hpp"
#include "metrics/distributions.hpp"

namespace rigcal::calib {
namespace {

/// A combination is named if it is not weak and the ratio of its interval to that of the parameter
/// is below this value.
constexpr double kMuchBetter = 1.0 / 3.0;
/// Exponents within this relative distance of a simple one are rounded to it, so that 0.52 becomes
/// a square root.
constexpr double kRoundedPower = 0.1;
/// Outside this range of exponents, the combination consists almost entirely of one of the two
/// parameters.
constexpr double kLeastPower = 0.2;
constexpr double kMostPower = 5.0;

struct PowerLaw {
  std::size_t first = 0;
  std::size_t second = 0;
  double power = 1.0;       ///< the records determine first / second^power
  double half_width = 0.0;  ///< relative half-width of the 95 % interval
};

std::string short_name(const Problem& problem, std::size_t unknown) {
  const Unknown& u = problem.map.unknowns()[unknown];
  const auto key = problem.spec(unknown).key;
  return u.level.empty() ? std::string(key) : fmt::format("{} ({})", key, u.level);
}

double simple_power(double power) {
  for (const double simple : {0.5, 1.0, 2.0}) {
    if (std::abs(std::abs(power) - simple) < kRoundedPower * simple)
      return std::copysign(simple, power);
  }
  return power;
}

std::string power_text(const std::string& name, double power) {
  if (power == 1.0) return name;
  if (power == 0.5) return "sqrt(" + name + ")";
  return fmt::format("{}^{:.3g}", name, power);
}

std::string text_of(const Problem& problem, std::span<const double> z, const PowerLaw& c) {
  const std::string a = short_name(problem, c.first);
  const std::string b = short_name(problem, c.second);
  const double value =
      problem.map.to_physical(static_cast<int>(c.first), z[c.first]) /
      std::pow(problem.map.to_physical(static_cast<int>(c.second), z[c.second]), c.power);
  const std::string unit =
      unit_product(problem.spec(c.first).unit, problem.spec(c.second).unit, -c.power);
  return fmt::format("the records determine only {}{}{} = {}{} (to {} %), not {} and {} separately",
                     a, c.power > 0.0 ? "/" : " * ", power_text(b, std::abs(c.power)),
                     significant(value, 3), unit == "1" ? "" : " " + unit,
                     significant(100.0 * c.half_width, 2), a, b);
}

/// Finds the partner with which the unknown forms the most precisely known product of powers.
///
/// @param to_log  d ln value / d z for each unknown, or 0 if the unknown is excluded
std::optional<PowerLaw> best_partner(const ArrowRoot& root, const std::vector<double>& to_log,
                                     std::size_t unknown) {
  const auto j = static_cast<Eigen::Index>(unknown);
  const double own = to_log[unknown];
  const double length = std::abs(own) * std::sqrt(root.product(j, j));
  std::optional<PowerLaw> best;
  for (std::size_t k = 0; k < to_log.size(); ++k) {
    const auto partner = static_cast<Eigen::Index>(k);
    const double other = to_log[k];
    const double square = other * other * root.product(partner, partner);
    if (k == unknown || !(square > 0.0)) continue;
    const double power = simple_power(own * other * root.product(j, partner) / square);
    const double half_width =
        metrics::kNormal95 * std::sqrt(root.square(j, own, partner, -power * other));
    const bool useful = half_width < kWeak &&
                        half_width < kMuchBetter * metrics::kNormal95 * length &&
                        std::abs(power) > kLeastPower && std::abs(power) < kMostPower;
    if (useful && (!best || half_width < best->half_width))
      best = PowerLaw{unknown, k, power, half_width};
  }
  return best;
}

}  // namespace

std::vector<std::string> name_combinations(const Problem& problem, std::span<const double> z,
                                           const Uncertainty& found,
                                           std::vector<FittedParameter>& parameters) {
  const std::size_t n = z.size();
  std::vector<double> to_log(n, 0.0);
  for (std::size_t j = 0; j < n; ++j) {
    const int unknown = static_cast<int>(j);
    const double value = problem.map.to_physical(unknown, z[j]);
    const bool counts = value > 0.0 && !problem.map.unknowns()[j].nuisance;
    if (counts) to_log[j] = problem.map.slope(unknown, z[j]) / value;
  }
  std::vector<std::string> words;
  std::vector<bool> named(n, false);
  for (std::size_t j = 0; j < n; ++j) {
    const std::optional<Identifiability> grade = parameters[j].identifiability;
    const bool determined =
        grade == Identifiability::identified || grade == Identifiability::bounded;
    if (to_log[j] == 0.0 || determined) continue;
    const auto best = best_partner(found.covariance_root, to_log, j);
    if (!best) continue;
    const std::string text = text_of(problem, z, *best);
    parameters[j].reason += (parameters[j].reason.empty() ? "" : "; ") + text;
    if (named[j] && named[best->second]) continue;
    named[j] = named[best->second] = true;
    words.push_back(text);
  }
  return words;
}

}  // namespace rigcal::calib
