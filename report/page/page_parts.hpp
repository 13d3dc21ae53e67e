#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "report/batch/batch.hpp"
#include "report/figure/svg.hpp"
#include "report/json/json_fields.hpp"
#include "report/store/stored.hpp"
#include "report/store/table.hpp"
#include "report/text/estimate_text.hpp"

// What the templates of report/page/ show, section by section, from the stored results alone.
// Texts are plain: the template engine escapes them. A key that ends in _html holds markup made
// here.

namespace rigcal::report {

/// A number that may be missing: null, NaN, nothing.
struct Number {
  std::optional<double> value;
  // NOLINTBEGIN(google-explicit-constructor): each is such a number
  Number(double number) : Number(std::optional(number)) {}
  Number(const std::optional<double>& number) : value(number) {
    if (value && std::isnan(*value)) value.reset();
  }
  // NOLINTEND(google-explicit-constructor)
};

/// An interval that may be missing, in whole or at an end.
struct Interval {
  std::optional<Range> ends;  ///< where both are known
  // NOLINTBEGIN(google-explicit-constructor): each is such an interval
  Interval(const std::optional<Range>& range) : ends(range) {
    if (ends && !(std::isfinite(ends->low) && std::isfinite(ends->high))) ends.reset();
  }
  // NOLINTEND(google-explicit-constructor)
  double half_width() const { return 0.5 * (ends->high - ends->low); }
};

/// A number for people, beside the one in the file: {"exact": "0.0508", "text": "50.8 mm"}; the
/// text is a dash where there is none.
Json shown(const Number& value, std::string_view si_unit, int digits = 5);
/// The same in a unit that others share.
Json shown_in(const Number& value, double si_per_unit, int digits = 5);
/// Both ends of an interval, as estimate_text() writes them; `known` false where an end is missing.
Json shown_interval(const Interval& interval, double si_per_unit);
/// rho2, R or CCC: "0.9996", "> 0.9999".
Json shown_agreement(const Number& value);
/// An estimate as estimate_text() writes it: {"value": ..., "interval": {"known", "low", "high"}}.
///
/// @param bounds  that hold the value, SI
Json shown_estimate(const Number& value, const Interval& interval, double si_per_unit,
                    const Range& bounds = kAnywhere);
/// A score by its metric: agreement as above, errors in percent to four digits.
Json shown_score(const std::string& metric, const Number& value);

/// The readable unit of a row of values, so that they can be compared at a glance; "1" has an empty
/// name.
struct RowUnit {
  std::string name;
  double si = 1.0;
};
/// That of a parameter's value and of others like it.
RowUnit row_unit(double value_si, std::string_view si_unit);
inline RowUnit unit_of(const StoredParameter& p) { return row_unit(p.value.value_or(0.0), p.unit); }

/// The farther end of the 95 % interval from the value, over the value: the end that no limit of
/// the parameter has cut. Infinite where there is no interval, or the value is zero.
double relative_half_width(const StoredParameter& parameter);
/// "± 2.1 %", "± 220 %"; "not determined" of what is more than ten times the value.
std::string half_width_text(double relative);

/// "not identifiable"; empty where nothing was estimated.
std::string grade_words(const std::optional<calib::Identifiability>& grade);
/// Estimated, but not well.
bool is_doubtful(const std::optional<calib::Identifiability>& grade);

/// Longer lists are folded on a screen.
inline constexpr std::size_t kFew = 8;

/// A key as words: "load pressure".
std::string spaced(std::string key);

/// Id of a condition's section.
std::string anchor(const std::string& condition);
/// {"word": "PASS", "mark": "✓", "class": "good"} of a verdict; nothing: not judged.
Json badge(const std::optional<calib::Verdict>& verdict);
/// SI unit of a channel, by the key that it has in the results.
std::string_view channel_unit(std::string_view channel);

/// Values in their order as points over their numbers from 1, on a logarithmic scale.
Plot ranked_points(const std::string& title, const std::string& y_label,
                   const std::vector<double>& values);

/// Adds [low, high] of an estimate to intervals that are drawn in a unit of so much SI; nothing
/// where an end is unknown.
void add_interval(Trace& intervals, double x, const Interval& interval, double si_per_unit = 1.0);

/// A headline without reasons yet: `word` large, `css` its class (good, warn, bad, none).
Json make_headline(const std::string& word, const std::string& mark, const std::string& css,
                   const std::string& sentence);
/// Adds a reason that leads to a section (`link` its id, or empty); only the first three are shown.
void add_reason(Json& headline, const std::string& text, const std::string& link);

/// The headline of a result that looks for leaks and is not done, with the reasons that it gives.
Json headline_without_result(LeakStatus status, const std::string& sentence,
                             const std::vector<std::string>& reasons, const std::string& link);

/// What the campaign states about the test and its report; {"there": false} where nothing.
///
/// @param identity  `report` of a result
Json identity_view(const Json& identity);
/// Three numbers, and measurement and model of every condition as a small picture; {"there": false}
/// where nothing was scored.
Json overview_view(const Calibration& stored);
/// Whether the search for the optimum came to its end, whatever was stopped after it.
bool searched_to_the_end(const StoredFit& fit);
/// Headline, the four aspects of the assessment, and the range that is covered.
Json headline_view(const StoredFit& fit);
/// The aspects of an assessment, each with what speaks against it and what for it; empty for a
/// result of before there were any.
Json assessment_view(const StoredFit& fit);
/// The aspects that did not pass, in words: "independent validation: not assessed".
std::string open_aspects(const StoredFit& fit);
/// Headline of a fit to published tables, which has no records.
Json tables_headline(const StoredTablesFit& fit);
/// Per channel: signals by leak levels.
Json matrix_view(const StoredFit& fit);
Json groups_view(const StoredFit& fit);
/// @param judged  whether a search came to its end, so that there are grades
Json parameters_view(const std::vector<StoredParameter>& parameters,
                     const StoredCorrelation& correlation, bool judged);
Json identifiability_view(const StoredFit& fit);
/// What tells how far the estimates can be trusted, as far as the fit holds it: profiles,
/// bootstrap, lack of fit, predictions, where starts ended.
Json trust_view(const StoredFit& fit);
Json starts_view(const StoredFit& fit);
Json ledger_view(const StoredFit& fit);
/// What made a result, under its name, and from which file it is drawn.
Json provenance_view(const StoredProvenance& provenance, const std::string& name,
                     const std::string& file);
/// Adds what a fit or validation says of its own making.
void add_making(const StoredFit& fit, Json& view);
void add_making(const StoredTablesFit& fit, Json& view);
Json formulas_view();

/// One condition: what it is, its scores, its plots and residual tests.
///
/// @param series  its residuals/<condition>.csv
/// @param curves  its entry in residual_tests.json, or null
/// @param points  of one interactive series, about
Json condition_view(const StoredCondition& condition, const Table& series,
                    const StoredChannelCurves* curves, std::size_t points);

/// What the residuals of its channels tell, with the curves behind it.
Json tests_view(const StoredCondition& condition, const StoredChannelCurves* curves);

/// The pictures of a condition, for the page and for files of their own.
struct Figure {
  std::string name;  ///< "position", "position_residual", ...
  Plot plot;
};
std::vector<Figure> condition_figures(const StoredCondition& condition, const Table& series);
/// Those of the other results, likewise.
std::vector<Figure> leak_table_figures(const LeakTableFiles& stored);
std::vector<Figure> diagnosis_figures(const StoredDiagnosis& diagnosis);
std::vector<Figure> parity_figures(const ParityFiles& stored);
std::vector<Figure> comparison_figures(const StoredComparison& comparison);
std::vector<Figure> batch_figures(const StoredBatch& batch);

/// leak_table.json against what was published.
Json leak_table_headline(const LeakTableFiles& stored);
Json leak_table_view(const LeakTableFiles& stored);

/// diagnosis.json: classes, their probabilities, and how often they are right.
Json diagnosis_headline(const StoredDiagnosis& diagnosis);
Json diagnosis_view(const StoredDiagnosis& diagnosis);

/// parity.json: alarms, thresholds, and the residuals.
Json parity_headline(const ParityFiles& stored);
Json parity_view(const ParityFiles& stored);

/// comparison.json: estimates, scores and records side by side, and the leak's trend.
Json comparison_headline(const StoredComparison& comparison);
Json comparison_view(const StoredComparison& comparison);

/// batch.json: a row for each rig, and the trends of its estimates.
Json batch_headline(const StoredBatch& batch);
Json batch_view(const StoredBatch& batch);

}  // namespace rigcal::report
