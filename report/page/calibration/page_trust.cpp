#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/significant.hpp"
#include "report/document/quantity.hpp"
#include "report/figure/monotone_curve.hpp"
#include "report/page/calibration/fit_sections.hpp"
#include "report/page/page_parts.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

using doc::Line;
using Kind = doc::Column::Kind;

constexpr double kHighestRise = 4.0;

std::string end_words(const calib::ProfileEnd& end, const ReadableUnit& unit, const char* which) {
  const auto text = [&](double value) {
    return fmt::format("{:.5g}{}{}", value / unit.si, unit.name.empty() ? "" : " ", unit.name);
  };
  if (end.value) return fmt::format("{} end {}", which, text(*end.value));
  if (end.is_lost())
    return fmt::format("{} end not found: stopped, or no fit converged there", which);
  return fmt::format("open at its {} end{}", which,
                     std::isfinite(end.reached)
                         ? fmt::format(": still within the interval at {}", text(end.reached))
                         : std::string());
}

/// Plots the increase in cost when a parameter is fixed at each value. The 95 % interval ends where
/// the increase is 1.
Plot profile_plot(const calib::FittedParameter& parameter, const calib::Profile& profile) {
  const ReadableUnit unit = unit_of(parameter);
  Plot plot{fmt::format("Profile of {}: computed points, and a curve through them",
                        parameter_label(parameter)),
            unit.name.empty() ? parameter_label(parameter)
                              : fmt::format("{} [{}]", parameter_label(parameter), unit.name),
            "relative rise of the cost; 1: end of the interval", 300.0, 170.0};
  plot.levels = {1.0};
  Trace trace;
  trace.style = "reference";
  for (std::size_t i = 0; i < std::min(profile.values.size(), profile.rises.size()); ++i) {
    if (std::isnan(profile.values[i]) || std::isnan(profile.rises[i])) continue;
    // Values far outside the interval would compress the rest of the plot.
    if (profile.rises[i] > kHighestRise) continue;
    trace.x.push_back(profile.values[i] / unit.si);
    trace.y.push_back(profile.rises[i]);
  }
  Trace points = trace;
  points.kind = Trace::Kind::points;
  points.style = "model";
  DrawnCurve curve = monotone_curve(points.x, points.y);
  trace.x = std::move(curve.x);
  trace.y = std::move(curve.y);
  plot.traces = {std::move(trace), std::move(points)};
  return plot;
}

std::string profile_reading(const calib::FittedParameter& parameter,
                            const calib::Profile& profile) {
  const ReadableUnit unit = unit_of(parameter);
  return fmt::format("{}: {}, {}.", parameter_label(parameter),
                     end_words(profile.low, unit, "lower"), end_words(profile.high, unit, "upper"));
}

doc::Row bootstrap_row(const calib::FittedParameter& parameter,
                       const calib::BootstrapSpread& bootstrap) {
  const ReadableUnit unit = unit_of(parameter);
  const auto& ci95 = bootstrap.ci95;
  return {{parameter_label(parameter), doc::in_unit(parameter.value, unit.si, 6), unit.name,
           Line{doc::in_unit(ci95 ? std::optional(ci95->low) : std::nullopt, unit.si, 5), " … ",
                doc::in_unit(ci95 ? std::optional(ci95->high) : std::nullopt, unit.si, 5)},
           doc::in_unit(bootstrap.standard_error, unit.si, 3),
           doc::in_unit(bootstrap.bias, unit.si, 3)}};
}

doc::Table lack_of_fit_table(const StoredFit& fit) {
  const calib::LackOfFitTests& lack = *fit.lack_of_fit;
  doc::Table table{"Lack of fit by condition"};
  table.style = "noise-tests";
  table.columns = {{"Condition"},
                   {"Channel"},
                   {"Against"},
                   {"Ratio of variances", Kind::number},
                   {"Degrees of freedom", Kind::number},
                   {"p", Kind::number},
                   {"Outcome, all together"}};
  table.file = is_fit_schema(fit.schema) ? "fit.json" : "validation.json";
  table.most = 100;
  std::vector<calib::LackOfFit> tests = lack.tests;
  if (tests.size() > table.most)
    std::stable_sort(tests.begin(), tests.end(), [](const auto& a, const auto& b) {
      return !std::isnan(a.p) && (std::isnan(b.p) || a.p < b.p);
    });
  for (const calib::LackOfFit& test : tests) {
    const bool judged = test.outcome != metrics::TestOutcome::not_judged;
    table.rows.push_back(
        {{test.condition, std::string(info(test.channel).key), test.against,
          doc::in_unit(test.ratio, 1.0, 4), doc::in_unit(test.freedom, 1.0, 6).text,
          std::isnan(test.p) ? "–" : p_value_text(test.p),
          judged ? std::string(to_string(test.outcome))
                 : "cannot be judged: " + test.reason.value_or("")}});
  }
  return table;
}

doc::Badge lack_badge(const calib::LackOfFitTests& lack) {
  if (lack.misfit == true) return {doc::State::warn, "Significant lack of fit."};
  if (lack.misfit == false) return {doc::State::good, "No lack of fit detected."};
  return {doc::State::none, lack.tests.empty()
                                ? "Lack of fit cannot be judged: the noise is unknown."
                                : "Lack of fit cannot be judged: the records have too few "
                                  "independent samples."};
}

void add_lack_of_fit(const StoredFit& fit, doc::Blocks& blocks) {
  if (!fit.lack_of_fit || fit.status == calib::FitStatus::failed) return;
  const calib::LackOfFitTests& lack = *fit.lack_of_fit;
  blocks.emplace_back(doc::Heading{{"Lack of fit"}});
  Line line{lack_badge(lack)};
  if (fit.aic && fit.bic)
    line.emplace_back(fmt::format(" AIC {:.6g}, BIC {:.6g}.", *fit.aic, *fit.bic));
  blocks.emplace_back(doc::Paragraph{std::move(line), doc::Paragraph::Tone::plain});
  if (lack.tests.empty()) return;
  blocks.emplace_back(doc::Fold{fmt::format("Tests of each condition ({})", lack.tests.size()),
                                {lack_of_fit_table(fit)}});
}

/// Returns the prediction error for each channel, for example "27.05 um (27.01 um where it was
/// fitted)".
std::string prediction_words(const calib::HeldOut& held) {
  std::string text;
  for (const auto& [channel, value] : held.rmse) {
    if (std::isnan(value)) continue;
    const double* fitted = find(held.fitted_rmse, channel);
    const std::string unit(info(channel).unit);
    text += fmt::format("{}{} {}", text.empty() ? "" : "; ", info(channel).key,
                        readable(value, unit, 4));
    if (fitted != nullptr && !std::isnan(*fitted))
      text += fmt::format(" ({} where it was fitted)", readable(*fitted, unit, 4));
  }
  return text;
}

void add_cross_validation(const StoredFit& fit, doc::Blocks& blocks) {
  if (!fit.cross_validation || fit.cross_validation->empty()) return;
  const char* const title = "Cross-validation: conditions left out and predicted";
  blocks.emplace_back(doc::Heading{{title}});
  doc::Table table{title};
  table.columns = {{"Left out"},
                   {"RMSE of its prediction"},
                   {"Largest shift of"},
                   {"Shift, standard errors", Kind::number}};
  for (const calib::HeldOut& held : *fit.cross_validation) {
    const auto& shift = held.largest_shift;
    table.rows.push_back(
        {{held.condition, held.problem ? *held.problem : prediction_words(held),
          held.shifted.value_or(""), shift ? fmt::format("{:.2g}", *shift) : std::string("–")}});
  }
  blocks.emplace_back(std::move(table));
}

void add_profiles(const StoredFit& fit, doc::Blocks& blocks) {
  doc::Gallery gallery;
  for (const calib::FittedParameter& p : fit.parameters) {
    if (!p.profile) continue;
    doc::Figure figure{[p] { return profile_plot(p, *p.profile); }};
    figure.caption = fmt::format("How much can {} change?", parameter_label(p));
    figure.reading = profile_reading(p, *p.profile);
    gallery.figures.push_back(std::move(figure));
  }
  if (gallery.figures.empty()) return;
  blocks.emplace_back(doc::Heading{{"Profiles"}});
  blocks.emplace_back(
      doc::reading("Rise of the cost with one parameter fixed and all others refitted; the 95 % "
                   "interval ends at 1."));
  blocks.emplace_back(std::move(gallery));
}

void add_bootstrap(const StoredFit& fit, doc::Blocks& blocks) {
  doc::Table table{"Bootstrap"};
  table.caption = {fit.bootstrap ? fit.bootstrap->message : std::string()};
  table.columns = {{"Parameter"},
                   {"Value", Kind::number},
                   {"Unit"},
                   {"95 % interval", Kind::number},
                   {"Std. error", Kind::number},
                   {"Bias", Kind::number}};
  for (const calib::FittedParameter& p : fit.parameters)
    if (p.bootstrap) table.rows.push_back(bootstrap_row(p, *p.bootstrap));
  if (table.rows.empty()) return;
  blocks.emplace_back(doc::Heading{{"Bootstrap"}});
  blocks.emplace_back(std::move(table));
}

}  // namespace

doc::Section identifiability_section(const StoredFit& fit) {
  doc::Section section{"identifiability", "Identifiability"};
  doc::Blocks& blocks = section.blocks;
  add_singular_values(fit, blocks);
  if (!fit.interval_advice.empty())
    blocks.emplace_back(doc::reading(capitalised(fit.interval_advice) + "."));
  blocks.emplace_back(list_of(fit.combinations));
  add_profiles(fit, blocks);
  add_bootstrap(fit, blocks);
  add_posterior(fit, blocks);
  add_lack_of_fit(fit, blocks);
  add_considered(fit, blocks);
  add_stability(fit, blocks);
  add_cross_validation(fit, blocks);
  return section;
}

}  // namespace rigcal::report
