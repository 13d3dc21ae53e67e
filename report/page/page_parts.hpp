#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "report/batch/batch.hpp"
#include "report/figure/svg.hpp"
#include "report/store/json_fields.hpp"
#include "report/store/stored.hpp"
#include "report/store/table.hpp"

// What the templates of report/page/ show, section by section, from the stored result files alone.
// Every function takes the JSON of a result file and throws nlohmann::json::exception where it is
// not one. Texts are plain: the template engine escapes them. A key that ends in _html holds markup
// made here.

namespace rigcal::report {

/// A number for people, beside the one in the file: {"exact": "0.0508", "text": "50.8 mm"}; the
/// text is a dash where there is none.
Json shown(const Json& value, std::string_view si_unit, int digits = 5);
/// The same in a unit that others share.
Json shown_in(const Json& value, double si_per_unit, int digits = 5);
/// Both ends of an interval, to the second digit of its half width; `known` false where an end is
/// missing.
Json shown_interval(const Json& pair, double si_per_unit);
/// rho2, R or CCC: "0.9996", "> 0.9999".
Json shown_agreement(const Json& value);
/// An estimate with no more digits than its 95 % interval supports; `digits` where it has none.
Json shown_matched(const Json& value, const Json& interval, double si_per_unit, int digits);
/// A score by its metric: agreement as above, errors in percent to four digits.
Json shown_score(const std::string& metric, const Json& value);

/// The readable unit of a row of values, so that they can be compared at a glance; "1" has an empty
/// name.
struct RowUnit {
  std::string name;
  double si = 1.0;
};
/// That of a parameter's value and of others like it.
RowUnit row_unit(double value_si, const Json& parameter);

/// Longer lists are folded on a screen.
inline constexpr std::size_t kFew = 8;

/// Id of a condition's section.
std::string anchor(const std::string& condition);
/// {"word": "PASS", "mark": "✓", "class": "good"} of a verdict; null: not judged.
Json badge(const Json& verdict);
/// Name of a parameter with whose it is: "leakage_coefficient (leak level 33 %)".
std::string parameter_label(const Json& parameter);
/// SI unit of a channel, by the key that it has in the results.
std::string_view channel_unit(std::string_view channel);

/// Verdict of one channel of one condition as the result states it; null where it has no limit.
Json channel_verdict(const Json& condition, const std::string& channel);

/// Values in their order as points over their numbers from 1, on a logarithmic scale.
Plot ranked_points(const std::string& title, const std::string& y_label,
                   const std::vector<double>& values);

/// Adds [low, high] of an estimate to intervals that are drawn in a unit of so much SI; nothing
/// where an end is unknown.
void add_interval(Trace& intervals, double x, const Json& pair, double si_per_unit = 1.0);

/// A headline without reasons yet: `word` large, `css` its class (good, warn, bad, none).
Json make_headline(const std::string& word, const std::string& mark, const std::string& css,
                   const std::string& sentence);
/// Adds a reason that leads to a section (`link` its id, or empty); only the first three are shown.
void add_reason(Json& headline, const std::string& text, const std::string& link);

/// What the campaign states about the test and its report; {"there": false} where nothing.
Json identity_view(const Json& result);
/// Three numbers, and measurement and model of every condition as a small picture; {"there": false}
/// where nothing was scored.
Json overview_view(const Calibration& stored);
/// Headline, the four aspects of the assessment, and the range that is covered.
Json headline_view(const Json& result);
/// The aspects of an assessment, each with what speaks against it and what for it; empty for a
/// result of before there were any.
Json assessment_view(const Json& result);
/// The aspects that did not pass, in words: "independent validation: not assessed".
std::string open_aspects(const Json& result);
/// Headline of a fit to published tables, which has no records.
Json tables_headline(const Json& result);
/// Per channel: signals by leak levels.
Json matrix_view(const Json& result);
Json groups_view(const Json& result);
Json parameters_view(const Json& result);
Json identifiability_view(const Json& result);
/// What tells how far the estimates can be trusted, as far as the fit holds it: profiles,
/// bootstrap, lack of fit, predictions, where starts ended.
Json trust_view(const Json& result);
Json starts_view(const Json& result);
Json ledger_view(const Json& result);
/// What made a result, under its name, and from which file it is drawn.
Json provenance_view(const StoredProvenance& provenance, const std::string& name,
                     const std::string& file);
/// Adds what a fit or validation says of its own making.
void add_making(const Json& result, Json& view);
Json formulas_view();

/// One condition: what it is, its scores, its plots and residual tests.
///
/// @param series  its residuals/<condition>.csv
/// @param curves  its entry in residual_tests.json, or null
/// @param points  of one interactive series, about
Json condition_view(const Json& condition, const Table& series, const Json& curves,
                    std::size_t points);

/// What the residuals of its channels tell, with the curves behind it.
Json tests_view(const Json& condition, const Json& curves);

/// The pictures of a condition, for the page and for files of their own.
struct Figure {
  std::string name;  ///< "position", "position_residual", ...
  Plot plot;
};
std::vector<Figure> condition_figures(const Json& condition, const Table& series);
/// Those of the other results, likewise.
std::vector<Figure> leak_table_figures(const LeakTableFiles& stored);
std::vector<Figure> diagnosis_figures(const Json& diagnosis);
std::vector<Figure> parity_figures(const ParityFiles& stored);
std::vector<Figure> comparison_figures(const Json& comparison);
std::vector<Figure> batch_figures(const StoredBatch& batch);

/// leak_table.json against what was published.
Json leak_table_headline(const StoredLeakTable& table);
Json leak_table_view(const LeakTableFiles& stored);

/// diagnosis.json: classes, their probabilities, and how often they are right.
Json diagnosis_headline(const Json& diagnosis);
Json diagnosis_view(const Json& diagnosis);

/// parity.json: alarms, thresholds, and the residuals.
Json parity_headline(const Json& parity);
Json parity_view(const ParityFiles& stored);

/// comparison.json: estimates, scores and records side by side, and the leak's trend.
Json comparison_headline(const Json& comparison);
Json comparison_view(const Json& comparison);

/// batch.json: a row for each rig, and the trends of its estimates.
Json batch_headline(const StoredBatch& batch);
Json batch_view(const StoredBatch& batch);

}  // namespace rigcal::report
