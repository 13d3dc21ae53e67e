#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "calib/problem/problem.hpp"
#include "common/describe.hpp"

namespace rigcal::calib {

/// A quantity that varies from day to day, so that repeats recorded on one day do not show the
/// variation.
struct DayQuantity {
  std::string quantity;  ///< key, for example "supply_pressure"
  std::string meaning;   ///< name in messages, for example "supply"
  std::string unit;      ///< SI unit of the quantity
  double sd = 0.0;       ///< standard deviation between days
  std::string sd_from;   ///< source of `sd`: "0.5 % of the supply", or "[between_days]"
  RIGCAL_DESCRIBE(quantity, meaning, unit, sd, sd_from)

  int index = -1;  ///< row of the parameter table; -1 for the start of the record. Not stored
};

/// Returns the quantities that vary between the days of a campaign. Each standard deviation is the
/// one given by the campaign, or otherwise a usual value derived from the rig.
///
/// @param values    parameter values of the rig
/// @param sample_s  sampling interval
std::vector<DayQuantity> day_quantities(const datasets::Campaign& campaign,
                                        const model::ParameterValues& values, double sample_s);

/// Returns true if the dates show that a record was made on another day than others.
///
/// @param dates  distinct dates of the other records; empty if not all are known
bool is_of_another_day(const datasets::Condition& condition, const std::vector<std::string>& dates);

/// Returns the rows of the parameter table that the quantities need and `free` does not include.
std::vector<int> further_rows(const std::vector<DayQuantity>& quantities,
                              std::span<const int> free);

/// Returns the change in one output due to each quantity, per standard deviation between days. The
/// change is zero if the quantity was recorded, or if a recorded drive has the same error.
///
/// @param run    simulated at the times of the record, with the sensitivities to `free`, which
///               includes further_rows()
/// @param output column of the output
/// @return       shape (samples, quantities)
Eigen::MatrixXd day_changes(const ProblemCondition& condition, const model::Simulation& run,
                            Eigen::Index output, std::span<const int> free,
                            std::span<const double> time_s,
                            const std::vector<DayQuantity>& quantities);

}  // namespace rigcal::calib
