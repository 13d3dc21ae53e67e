#include "calib/problem/day_effects.hpp"

#include <algorithm>
#include <cmath>

namespace rigcal::calib {
namespace {

// Usual standard deviations between days, as listed in docs/diagnosis.md.
constexpr double kSupplyShare = 5e-3;
constexpr double kBulkModulusShare = 0.03;
constexpr double kTravelShare = 2e-4;
constexpr double kIntervals = 0.5;
constexpr double kLeastTrigger_s = 0.05e-3;
constexpr double kMostTrigger_s = 0.5e-3;

double value_or_nan(const datasets::Campaign& campaign, const model::ParameterValues& values,
                    std::string_view key) {
  const int index = model::parameter_index(campaign.rig.plant, key);
  return index < 0 ? std::nan("") : values.value[static_cast<std::size_t>(index)];
}

struct UsualSize {
  const char* meaning = "";
  double sd = 0.0;
  const char* from = "";
};

UsualSize usual_size(const datasets::Campaign& campaign, const model::ParameterValues& values,
                     double sample_s, const std::string& key) {
  const auto get = [&](const char* name) { return value_or_nan(campaign, values, name); };
  if (key == "supply_pressure")
    return {"supply", kSupplyShare * get("supply_pressure"), "0.5 % of the supply"};
  if (key == "bulk_modulus")
    return {"bulk modulus of the oil", kBulkModulusShare * get("bulk_modulus"), "3 % of its value"};
  if (key == "position_offset") {
    const double stroke = get("stroke");
    const double travel = std::isfinite(stroke) ? stroke : get("total_volume") / get("piston_area");
    return {"zero of the position sensor", kTravelShare * travel, "0.02 % of the travel"};
  }
  return {"start of the record", std::clamp(kIntervals * sample_s, kLeastTrigger_s, kMostTrigger_s),
          "half a sampling interval"};
}

/// Returns true if the record of a condition already includes the day's value of a quantity.
bool is_recorded(const ProblemCondition& condition, const DayQuantity& quantity) {
  if (quantity.index < 0) return condition.condition->waveform == datasets::Waveform::recorded;
  return quantity.quantity == "supply_pressure" && condition.inputs.supply_pressure_pa.has_value();
}

/// Returns the time derivative, by central differences.
Eigen::VectorXd rate_of(const Eigen::VectorXd& x, std::span<const double> time_s) {
  const Eigen::Index n = x.size();
  Eigen::VectorXd rate = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; n > 1 && i < n; ++i) {
    const Eigen::Index before = std::max<Eigen::Index>(0, i - 1);
    const Eigen::Index after = std::min(n - 1, i + 1);
    rate(i) = (x(after) - x(before)) /
              (time_s[static_cast<std::size_t>(after)] - time_s[static_cast<std::size_t>(before)]);
  }
  return rate;
}

}  // namespace

std::vector<DayQuantity> day_quantities(const datasets::Campaign& campaign,
                                        const model::ParameterValues& values, double sample_s) {
  const datasets::StatedSizes& stated = campaign.between_days;
  std::vector<DayQuantity> result;
  for (const datasets::SizedQuantity& name : datasets::day_quantity_names(campaign.rig.plant)) {
    if (stated.leaves_out(name.key)) continue;
    const UsualSize usual = usual_size(campaign, values, sample_s, name.key);
    DayQuantity quantity;
    quantity.quantity = name.key;
    quantity.meaning = usual.meaning;
    quantity.unit = name.unit;
    quantity.sd = usual.sd;
    quantity.sd_from = usual.from;
    quantity.index = model::parameter_index(campaign.rig.plant, name.key);
    if (const auto sd = stated.size(name.key)) {
      quantity.sd = *sd;
      quantity.sd_from = "[between_days]";
    }
    if (quantity.sd > 0.0 && std::isfinite(quantity.sd)) result.push_back(std::move(quantity));
  }
  return result;
}

bool is_of_another_day(const datasets::Condition& condition,
                       const std::vector<std::string>& dates) {
  return condition.date && !dates.empty() &&
         std::find(dates.begin(), dates.end(), *condition.date) == dates.end();
}

std::vector<int> further_rows(const std::vector<DayQuantity>& quantities,
                              std::span<const int> free) {
  std::vector<int> rows;
  for (const DayQuantity& each : quantities) {
    if (each.index >= 0 && std::find(free.begin(), free.end(), each.index) == free.end())
      rows.push_back(each.index);
  }
  return rows;
}

Eigen::MatrixXd day_changes(const ProblemCondition& condition, const model::Simulation& run,
                            Eigen::Index output, std::span<const int> free,
                            std::span<const double> time_s,
                            const std::vector<DayQuantity>& quantities) {
  const Eigen::VectorXd simulated = run.outputs.col(output);
  Eigen::MatrixXd changes =
      Eigen::MatrixXd::Zero(simulated.size(), static_cast<Eigen::Index>(quantities.size()));
  for (std::size_t q = 0; q < quantities.size(); ++q) {
    const DayQuantity& quantity = quantities[q];
    if (is_recorded(condition, quantity)) continue;
    auto column = changes.col(static_cast<Eigen::Index>(q));
    if (quantity.index < 0) {
      column = quantity.sd * rate_of(simulated, time_s);
      continue;
    }
    const auto place = std::find(free.begin(), free.end(), quantity.index);
    if (place == free.end()) continue;
    column =
        quantity.sd * run.sensitivities[static_cast<std::size_t>(output)].col(place - free.begin());
  }
  return changes;
}

}  // namespace rigcal::calib
