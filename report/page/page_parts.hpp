#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "report/batch/batch.hpp"
#include "report/document/document.hpp"
#include "report/document/quantity.hpp"
#include "report/figure/svg.hpp"
#include "report/json/json_fields.hpp"
#include "report/store/stored.hpp"
#include "report/store/table.hpp"
#include "report/text/estimate_text.hpp"
#include "report/text/readable.hpp"

// Functions used by the pages for several kinds of results. They only use the stored results.

namespace rigcal::report {

using doc::Interval;
using doc::Number;

/// Chooses a readable unit for the row of a parameter.
inline ReadableUnit unit_of(const calib::FittedParameter& p) {
  return readable_unit(std::isfinite(p.value) ? p.value : 0.0, p.unit);
}

/// Returns the larger distance from the value to an end of the 95 % interval, divided by the value.
/// The larger distance is used because a bound may cut off the other side. Infinite without an
/// interval or for a value of zero.
double relative_half_width(const calib::FittedParameter& parameter);
/// Returns true if the half-width is at most ten times the value.
bool is_determined(double relative_half_width);
/// Returns "± 2.1 %" or "± 220 %"; "not determined" beyond the limit of is_determined().
std::string half_width_text(double relative);

/// Returns true if a parameter was estimated, but not well.
bool is_doubtful(const std::optional<calib::Identifiability>& grade);

/// Longer lists are folded on a screen.
inline constexpr std::size_t kFew = 8;

/// Converts a key to words: "load pressure".
std::string spaced(std::string key);

/// Returns the id of the section about a condition.
std::string anchor(const std::string& condition);
/// Returns the SI unit of a channel, given its key in the results.
std::string_view channel_unit(std::string_view channel);

/// Plots values over their position in the list, counted from 1, on a logarithmic scale.
Plot ranked_points(const std::string& title, const std::string& y_label,
                   const std::vector<double>& values);

/// Adds the interval [low, high] of an estimate to a trace whose unit is `si_per_unit` in SI. Adds
/// nothing if an end is unknown.
void add_interval(Trace& intervals, double x, const Interval& interval, double si_per_unit = 1.0);

/// Adds the line of a trend between two places and its 95 % band. Adds nothing if the trend has no
/// line, and no band if no estimate has an error.
///
/// @param estimates    those that the line was fitted to
/// @param si_per_unit  unit of the y axis in SI
void add_trend_line(Plot& plot, const calib::EstimateTrend& trend,
                    const std::vector<calib::PlacedEstimate>& estimates, const Range& places,
                    double si_per_unit = 1.0);

/// Adds a reason with a link to the section with id `link` (no link if empty). Only the first three
/// reasons are shown.
void add_reason(doc::Verdict& verdict, const std::string& text, const std::string& link);

/// Returns the verdict on an unfinished search for leaks, with its reasons.
doc::Verdict verdict_without_result(LeakStatus status, const std::string& sentence,
                                    const std::vector<std::string>& reasons,
                                    const std::string& link);

/// What the campaign states about the test and its report (`report` in a result).
struct Identity {
  /// Empty if not stated. The number includes the revision.
  std::string number, replaces, issued, laboratory, customer, rig;
  doc::Facts facts;  ///< test item and method, then a row for each sensor
  doc::Signatures signatures;
};
Identity identity_of(const Json& report);

/// Returns true if the search for the optimum was completed, even if a later step was stopped.
bool searched_to_the_end(const StoredFit& fit);
/// Makes a list from several texts.
///
/// @param state  colour for reasons and warnings
doc::List list_of(const std::vector<std::string>& texts, std::optional<doc::State> state = {});
/// Makes a figure from an existing plot, with an explanation.
doc::Figure figure_of(Plot plot, std::string caption = {}, std::string reading = {});
/// Capitalises the first letter: "mass" becomes "Mass".
std::string capitalised(std::string text);

/// Lists the provenance of a result under its name, with the file that the page is made from.
///
/// @param making  details about how a fit was made
doc::Blocks provenance_blocks(const StoredProvenance& provenance, const std::string& name,
                              const std::string& file, const doc::Facts& making = {});
doc::Facts making_of(const StoredFit& fit);
doc::Facts making_of(const StoredTablesFit& fit);
/// Returns, for example, "rigcal 0.1.0 (17fc680)".
std::string program_of(const StoredProvenance& provenance);
/// Returns the section with the formula for each quantity.
doc::Section formulas_section();

/// A picture of a condition, for the page and for a separate file.
struct Figure {
  std::string name;  ///< "position", "position_residual", ...
  Plot plot;
};
std::vector<Figure> condition_figures(const calib::ConditionResult& condition, const Table& series);
/// Draw the figures of the other kinds of results.
std::vector<Figure> leak_table_figures(const LeakTableFiles& stored);
std::vector<Figure> diagnosis_figures(const StoredDiagnosis& diagnosis);
std::vector<Figure> parity_figures(const ParityFiles& stored);
std::vector<Figure> comparison_figures(const StoredComparison& comparison);
std::vector<Figure> batch_figures(const StoredBatch& batch);

/// Functions for leak_table.json, which is compared with the published values.
doc::Verdict leak_table_headline(const LeakTableFiles& stored);
std::vector<doc::Section> leak_table_sections(const LeakTableFiles& stored);

/// Functions for diagnosis.json: leak classes, their probabilities, and how often they are right.
doc::Verdict diagnosis_headline(const StoredDiagnosis& diagnosis);
std::vector<doc::Section> diagnosis_sections(const StoredDiagnosis& diagnosis);

/// Functions for parity.json: alarms, thresholds, and residuals.
doc::Verdict parity_headline(const ParityFiles& stored);
std::vector<doc::Section> parity_sections(const ParityFiles& stored);

/// Functions for comparison.json: estimates, scores and records side by side, and the trend of the
/// leak.
doc::Verdict comparison_headline(const StoredComparison& comparison);
std::vector<doc::Section> comparison_sections(const StoredComparison& comparison);

/// Functions for batch.json: a row for each rig, and the trends of its estimates.
doc::Verdict batch_headline(const StoredBatch& batch);
std::vector<doc::Section> batch_sections(const StoredBatch& batch);

/// Functions for average.json, which shows how well the repeats of each condition agree.
doc::Verdict average_headline(const AverageFiles& stored);
std::vector<doc::Section> average_sections(const AverageFiles& stored);
/// Draws, for each output channel of a condition, the mean with the standard deviation of the
/// repeats, and that standard deviation over time.
std::vector<Figure> average_figures(const std::string& condition, const Table& series);
/// Draws the figures of every condition.
std::vector<Figure> average_figures(const AverageFiles& stored);
/// Plots the delay of each repeat relative to the mean; no traces for a single repeat.
Plot offset_plot(const StoredRecord& record);

/// Functions for plan.json: how much information each existing or planned record gives about each
/// parameter. With `plan --design` it also contains the designed test.
doc::Verdict plan_headline(const PlanFiles& files);
std::vector<doc::Section> plan_sections(const PlanFiles& files);
/// Plots, for each parameter, the fraction of the total information (1 / variance) that each record
/// provides on its own, followed by the figures of the design.
std::vector<Figure> plan_figures(const PlanFiles& files);

/// Functions for `design` in plan.json: the test that `plan --design` designed.
doc::Verdict design_headline(const StoredDesign& design);
/// @param files  must contain a design
doc::Section design_section(const PlanFiles& files);
/// Draws the drive, the response and the spectrum; empty without a design.
std::vector<Figure> design_figures(const PlanFiles& files);

}  // namespace rigcal::report
