#include <fmt/format.h>

#include <algorithm>

#include "report/document/quantity.hpp"
#include "report/page/calibration/fit_sections.hpp"
#include "report/page/page_parts.hpp"

namespace rigcal::report {
namespace {

using doc::Line;
using Kind = doc::Column::Kind;

Line range_line(const std::optional<Range>& range, const ReadableUnit& unit) {
  return Line{doc::in_unit(range ? std::optional(range->low) : std::nullopt, unit.si, 5), " … ",
              doc::in_unit(range ? std::optional(range->high) : std::nullopt, unit.si, 5)};
}

std::string count_text(const std::optional<double>& count) {
  return count ? fmt::format("{:.0f}", *count) : std::string("–");
}

doc::Table draws_table(const StoredFit& fit, const calib::Posterior& found) {
  doc::Table table{"Posterior"};
  table.caption = {capitalised(found.message) + "."};
  table.columns = {{"Parameter"},
                   {"Median", Kind::number},
                   {"Unit"},
                   {"Std. deviation", Kind::number},
                   {"95 % of the draws", Kind::number},
                   {"95 % if exact", Kind::number},
                   {"95 % interval", Kind::number},
                   {"R-hat", Kind::number},
                   {"Effective draws", Kind::number}};
  for (const calib::FittedParameter& p : fit.parameters) {
    if (!p.posterior) continue;
    const ReadableUnit unit = unit_of(p);
    const calib::PosteriorSpread& spread = *p.posterior;
    table.rows.push_back(
        {{parameter_label(p), doc::in_unit(spread.median, unit.si, 6), unit.name,
          doc::in_unit(spread.sd, unit.si, 3), range_line(spread.ci95, unit),
          range_line(p.ci95_if_exact, unit), range_line(p.ci95, unit),
          std::isfinite(spread.r_hat) ? fmt::format("{:.4f}", spread.r_hat) : std::string("–"),
          fmt::format("{}, {}", count_text(finite(spread.bulk_draws)),
                      count_text(finite(spread.tail_draws)))}});
  }
  return table;
}

/// Returns the sizes of the small effects that were drawn.
doc::Table effects_table(const calib::Considered& considered) {
  doc::Table table{"Posterior of the small effects"};
  table.columns = {{"Effect"}, {"Plausible size", Kind::number},    {"Median", Kind::number},
                   {"Unit"},   {"95 % of the draws", Kind::number}, {"R-hat", Kind::number}};
  for (const calib::ConsideredEffect& each : considered.effects) {
    if (!each.posterior) continue;
    const ReadableUnit unit = readable_unit(each.size, each.unit);
    table.rows.push_back(
        {{each.meaning, doc::in_unit(each.size, unit.si, 3),
          doc::in_unit(each.posterior->median, unit.si, 3), unit.name,
          range_line(each.posterior->ci95, unit),
          std::isfinite(each.posterior->r_hat) ? fmt::format("{:.4f}", each.posterior->r_hat)
                                               : std::string("–")}});
  }
  return table;
}

doc::Table limits_table(const calib::Posterior& found) {
  doc::Table table{"Probability that each limit is met"};
  table.columns = {{"Condition"},
                   {"Channel"},
                   {"Score"},
                   {"Limit", Kind::number},
                   {"Median", Kind::number},
                   {"Probability", Kind::number}};
  for (const calib::KeptLimit& each : found.limits) {
    table.rows.push_back({{each.condition, std::string(info(each.channel).key), each.metric,
                           doc::in_unit(each.limit, 1.0, 6), doc::in_unit(each.median, 1.0, 6),
                           fmt::format("{:.3g}", each.probability)}});
  }
  return table;
}

doc::Table shares_table(const calib::Posterior& found) {
  doc::Table table{"Probability of each leak class"};
  table.columns = {{"Leak of"},
                   {"Motion of"},
                   {"Share, % of the servo flow", Kind::number},
                   {"95 % of the draws", Kind::number}};
  for (const auto& [name, probability] : found.shares.front().class_probabilities)
    table.columns.push_back({name, Kind::number, 0, "probability"});
  for (const calib::DrawnShare& each : found.shares) {
    doc::Row row{{each.level.empty() ? std::string("the rig") : each.level, each.condition,
                  doc::in_unit(each.leak_share_percent, 1.0, 3),
                  range_line(each.leak_share_ci95_percent, ReadableUnit{})}};
    for (const auto& [name, probability] : each.class_probabilities)
      row.cells.push_back({fmt::format("{:.3g}", probability)});
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// Returns the column name of a parameter in posterior.csv, which includes its scope.
std::string named_as(const calib::FittedParameter& p) {
  return parameter_label(p.name, p.scope, p.level);
}

/// Returns the stored parameter with this name, or null if there is none.
const calib::FittedParameter* named(const StoredFit& fit, const std::string& name) {
  const auto found = std::find_if(fit.parameters.begin(), fit.parameters.end(),
                                  [&](const auto& p) { return p.fitted && named_as(p) == name; });
  return found == fit.parameters.end() ? nullptr : &*found;
}

std::string axis_label(const std::string& name, const ReadableUnit& unit) {
  return unit.name.empty() ? name : fmt::format("{} [{}]", name, unit.name);
}

Plot pair_plot(const StoredFit& fit, const calib::Pairs& pairs, std::size_t a, std::size_t b) {
  const calib::FittedParameter* const first = named(fit, pairs.names[a]);
  const calib::FittedParameter* const second = named(fit, pairs.names[b]);
  const ReadableUnit x = first != nullptr ? unit_of(*first) : ReadableUnit{};
  const ReadableUnit y = second != nullptr ? unit_of(*second) : ReadableUnit{};
  Plot plot{fmt::format("Draws of {} and {}", pairs.names[a], pairs.names[b]),
            axis_label(first != nullptr ? parameter_label(*first) : pairs.names[a], x),
            axis_label(second != nullptr ? parameter_label(*second) : pairs.names[b], y), 300.0,
            230.0};
  Trace draws = empty_trace(Trace::Kind::points, "residual");
  for (const double value : pairs.values[a]) draws.x.push_back(value / x.si);
  for (const double value : pairs.values[b]) draws.y.push_back(value / y.si);
  Trace estimate = empty_trace(Trace::Kind::points, "model");
  if (first != nullptr && second != nullptr && std::isfinite(first->value) &&
      std::isfinite(second->value)) {
    estimate.x = {first->value / x.si};
    estimate.y = {second->value / y.si};
  }
  plot.traces = {std::move(draws), std::move(estimate)};
  return plot;
}

void add_pairs(const StoredFit& fit, const calib::Pairs& pairs, doc::Blocks& blocks) {
  doc::Gallery gallery;
  const std::size_t count = std::min(pairs.names.size(), pairs.values.size());
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = a + 1; b < count; ++b)
      gallery.figures.push_back(
          doc::Figure{[fit, pairs, a, b] { return pair_plot(fit, pairs, a, b); }});
  }
  if (gallery.figures.empty()) return;
  blocks.emplace_back(doc::reading(
      fmt::format("{} draws ({} shown) of at most six parameters, and the estimate. posterior.csv "
                  "contains all.",
                  fit.posterior->chains * fit.posterior->draws,
                  pairs.every == 1 ? std::string("all") : fmt::format("one in {}", pairs.every))));
  blocks.emplace_back(std::move(gallery));
}

}  // namespace

void add_posterior(const StoredFit& fit, doc::Blocks& blocks) {
  if (!fit.posterior) return;
  const calib::Posterior& found = *fit.posterior;
  blocks.emplace_back(doc::Heading{{"Posterior"}});
  if (found.draws == 0) {
    blocks.emplace_back(doc::reading(capitalised(found.message) + "."));
    return;
  }
  blocks.emplace_back(doc::reading(
      std::string(found.effects
                      ? "The sizes of the small effects that the model leaves out are drawn with "
                        "the unknowns. They act in proportion to their size, as in the 95 % "
                        "interval; compare the draws with that. "
                      : "The draws assume that the model is exact. They do not include the small "
                        "effects that it leaves out; compare them with the interval for an exact "
                        "model, not with the wider one. ") +
      "Correlated residuals, differences between repeats and stated uncertainties of known values "
      "are treated as in that interval. Prior: uniform between the bounds, in the logarithm if "
      "these span more than a decade, unless the campaign states a prior. Effective draws: "
      "effective sample size for the middle of a distribution, and for its tails."));
  blocks.emplace_back(draws_table(fit, found));
  if (found.effects && fit.considered)
    blocks.emplace_back(doc::Fold{"Sizes of the small effects", {effects_table(*fit.considered)}});
  if (!found.limits.empty()) {
    blocks.emplace_back(limits_table(found));
    blocks.emplace_back(doc::reading(fmt::format(
        "Each limit was checked by simulating {} draws from all chains.", found.simulated)));
  }
  if (!found.shares.empty()) {
    blocks.emplace_back(shares_table(found));
    blocks.emplace_back(
        doc::reading(fmt::format("Each share was simulated for {} draws from all chains, for the "
                                 "same motion. A probability is the fraction of draws in a class.",
                                 found.simulated)));
  }
  add_pairs(fit, found.pairs, blocks);
}

}  // namespace rigcal::report
