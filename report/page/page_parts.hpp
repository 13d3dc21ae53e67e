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

// Parts that the pages of several kinds of result share, from the stored results alone.

namespace rigcal::report {

using doc::Interval;
using doc::Number;

/// The readable unit of a row of values, so that they can be compared at a glance; "1" has an empty
/// name.
struct RowUnit {
  std::string name;
  double si = 1.0;
};
/// Unit for a parameter's value and similar ones.
RowUnit row_unit(double value_si, std::string_view si_unit);
inline RowUnit unit_of(const StoredParameter& p) { return row_unit(p.value.value_or(0.0), p.unit); }

/// Larger distance from the value to an end of the 95 % interval, divided by the value. The larger
/// one is not cut by a bound. Infinite without an interval or for a value of zero.
double relative_half_width(const StoredParameter& parameter);
/// Up to ten times the value.
bool is_determined(double relative_half_width);
/// "± 2.1 %", "± 220 %"; "not determined" beyond that.
std::string half_width_text(double relative);

/// Estimated, but not well.
bool is_doubtful(const std::optional<calib::Identifiability>& grade);

/// Longer lists are folded on a screen.
inline constexpr std::size_t kFew = 8;

/// A key as words: "load pressure".
std::string spaced(std::string key);

/// Id of a condition's section.
std::string anchor(const std::string& condition);
/// SI unit of a channel, by the key that it has in the results.
std::string_view channel_unit(std::string_view channel);

/// Values in their order as points over their numbers from 1, on a logarithmic scale.
Plot ranked_points(const std::string& title, const std::string& y_label,
                   const std::vector<double>& values);

/// Adds [low, high] of an estimate to intervals that are drawn in a unit of this size in SI;
/// nothing if an end is unknown.
void add_interval(Trace& intervals, double x, const Interval& interval, double si_per_unit = 1.0);

/// Adds a reason that leads to a section (`link` its id, or empty); only the first three are shown.
void add_reason(doc::Verdict& verdict, const std::string& text, const std::string& link);

/// Verdict on an unfinished search for leaks, with its reasons.
doc::Verdict verdict_without_result(LeakStatus status, const std::string& sentence,
                                    const std::vector<std::string>& reasons,
                                    const std::string& link);

/// Statements of the campaign about the test and its report (`report` of a result).
struct Identity {
  std::string number, issued, laboratory, customer, rig;  ///< empty where not stated
  doc::Facts facts;  ///< item and method, then a row for each sensor
  doc::Signatures signatures;
};
Identity identity_of(const Json& report);

/// Whether the search for the optimum came to its end, whatever was stopped after it.
bool searched_to_the_end(const StoredFit& fit);
/// Several texts as a list.
///
/// @param state  colour, for reasons and warnings
doc::List list_of(const std::vector<std::string>& texts, std::optional<doc::State> state = {});
/// A figure of an existing plot, with an explanation.
doc::Figure figure_of(Plot plot, std::string caption = {}, std::string reading = {});
/// "Mass" of "mass".
std::string capitalised(std::string text);

/// Provenance of a result under its name, with the file that the page is made from.
///
/// @param making  details of a fit
doc::Blocks provenance_blocks(const StoredProvenance& provenance, const std::string& name,
                              const std::string& file, const doc::Facts& making = {});
doc::Facts making_of(const StoredFit& fit);
doc::Facts making_of(const StoredTablesFit& fit);
/// "rigcal 0.1.0 (17fc680)"
std::string program_of(const StoredProvenance& provenance);
/// Section with the formula of each number.
doc::Section formulas_section();

/// The pictures of a condition, for the page and for files of their own.
struct Figure {
  std::string name;  ///< "position", "position_residual", ...
  Plot plot;
};
std::vector<Figure> condition_figures(const StoredCondition& condition, const Table& series);
/// Figures of the other results.
std::vector<Figure> leak_table_figures(const LeakTableFiles& stored);
std::vector<Figure> diagnosis_figures(const StoredDiagnosis& diagnosis);
std::vector<Figure> parity_figures(const ParityFiles& stored);
std::vector<Figure> comparison_figures(const StoredComparison& comparison);
std::vector<Figure> batch_figures(const StoredBatch& batch);

/// Agreement of leak_table.json with the published numbers.
doc::Verdict leak_table_headline(const LeakTableFiles& stored);
std::vector<doc::Section> leak_table_sections(const LeakTableFiles& stored);

/// diagnosis.json: classes, their probabilities, and how often they are right.
doc::Verdict diagnosis_headline(const StoredDiagnosis& diagnosis);
std::vector<doc::Section> diagnosis_sections(const StoredDiagnosis& diagnosis);

/// parity.json: alarms, thresholds, and the residuals.
doc::Verdict parity_headline(const ParityFiles& stored);
std::vector<doc::Section> parity_sections(const ParityFiles& stored);

/// comparison.json: estimates, scores and records side by side, and the leak's trend.
doc::Verdict comparison_headline(const StoredComparison& comparison);
std::vector<doc::Section> comparison_sections(const StoredComparison& comparison);

/// batch.json: a row for each rig, and the trends of its estimates.
doc::Verdict batch_headline(const StoredBatch& batch);
std::vector<doc::Section> batch_sections(const StoredBatch& batch);

}  // namespace rigcal::report
