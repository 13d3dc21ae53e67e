#pragma once

#include <span>
#include <string>
#include <vector>

#include "report/figure/decimate.hpp"
#include "report/figure/svg.hpp"
#include "report/store/stored.hpp"
#include "report/store/table.hpp"

// The plots of a condition over time, from its residuals/<condition>.csv.

namespace rigcal::report {

/// A column of a condition's table in the unit of its plot.
struct TimeLine {
  std::string name, style;
  const std::vector<double>* values = nullptr;
};

/// Half of a 95 % band in standard deviations.
inline constexpr double kNormal95 = 1.96;

/// One set of axes over time.
struct TimePlot {
  std::string name, title, unit;
  double si = 1.0;
  double height = 200.0;
  std::vector<TimeLine> lines;
  const std::vector<double>* sd = nullptr;  ///< band around the first line
  /// Standard deviation of a prediction: a band of 1.96 of it around the model, or around zero
  /// where the plot is of the residual.
  const std::vector<double>* prediction_sd = nullptr;
  const std::vector<double>* prediction_middle = nullptr;  ///< null: zero
};

/// The plots for a table: per channel the signals and the residual, flows, the valve command. They
/// refer to the columns of the table.
std::vector<TimePlot> time_plots(const Table& table);

/// The largest absolute value that is finite.
double largest(std::span<const double> values);

/// The whole record as a static picture.
Plot picture(const TimePlot& plot, const Table& table, const std::string& condition);

/// Description of the plot for those who cannot see it.
std::string description(const TimePlot& plot, const Table& table);

/// The series of a condition for the script of the page.
class SeriesData {
 public:
  /// @param points  of one series, about
  SeriesData(const Table& table, std::size_t points);

  /// Adds a column and returns its number.
  std::size_t add(const std::vector<double>& values, double si);
  /// Adds values at the points that are kept of another column.
  std::size_t add(const std::vector<double>& values, const std::vector<double>& extremes,
                  double si);

  /// JSON that no HTML parser can take for markup.
  std::string text() const;

  Json& json() { return json_; }

 private:
  Buckets thin_;
  std::vector<double> times_;
  Json json_;
};

}  // namespace rigcal::report
