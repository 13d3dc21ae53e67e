#pragma once

#include <span>
#include <string>
#include <vector>

#include "report/figure/decimate.hpp"
#include "report/figure/svg.hpp"
#include "report/store/stored.hpp"
#include "report/store/table.hpp"

// The plots of a condition over time, drawn from its residuals/<condition>.csv.

namespace rigcal::report {

/// A column of a condition's table, in the unit of its plot.
struct TimeLine {
  std::string name, style;
  const std::vector<double>* values = nullptr;
};

/// One set of axes over time.
struct TimePlot {
  std::string name, title, unit;
  double si = 1.0;
  double height = 200.0;
  std::vector<TimeLine> lines;
  const std::vector<double>* sd = nullptr;  ///< standard deviation for a band around the first line
  /// Standard deviation of the prediction. The band of ±1.96 standard deviations is drawn around
  /// the model, or around zero if the plot shows the residual.
  const std::vector<double>* prediction_sd = nullptr;
  const std::vector<double>* prediction_middle = nullptr;  ///< centre of the band; null: zero
};

/// Returns the plots for a table: for each channel the signals and the residual, then flows and the
/// valve command. The plots point into the columns of the table.
std::vector<TimePlot> time_plots(const Table& table);

/// Returns the largest finite absolute value.
double largest(std::span<const double> values);

/// Draws the whole record as a static picture.
Plot picture(const TimePlot& plot, const Table& table, const std::string& condition);

/// Describes the plot for readers who cannot see it.
std::string description(const TimePlot& plot, const Table& table);

/// The series of a condition, as data for the script on the page.
class SeriesData {
 public:
  /// @param points  approximate number of points in each series
  SeriesData(const Table& table, std::size_t points);

  /// Adds a column and returns its index.
  std::size_t add(const std::vector<double>& values, double si);
  /// Adds values at the samples that are kept for another column.
  std::size_t add(const std::vector<double>& values, const std::vector<double>& extremes,
                  double si);

  /// Returns JSON that no HTML parser can mistake for markup.
  std::string text() const;

  Json& json() { return json_; }

 private:
  Buckets thin_;
  std::vector<double> times_;
  Json json_;
};

}  // namespace rigcal::report
