#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "common/significant.hpp"
#include "metrics/metric_table.hpp"
#include "report/document/quantity.hpp"
#include "report/page/budget_tables.hpp"
#include "report/page/calibration/fit_sections.hpp"
#include "report/page/page_parts.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

using doc::Line;
using Kind = doc::Column::Kind;

/// Formats the size or an estimate of an effect in a suitable unit.
Line effect_number(const std::optional<double>& value, const std::optional<double>& half_width,
                   const ReadableUnit& unit) {
  Line line{doc::in_unit(value, unit.si, kBudgetDigits)};
  if (value && half_width) {
    line.emplace_back(" ± ");
    line.emplace_back(doc::in_unit(half_width, unit.si, kBudgetDigits));
  }
  return line;
}

doc::Row effect_row(const calib::ConsideredEffect& effect, bool missing) {
  const ReadableUnit unit = readable_unit(effect.size, effect.unit);
  doc::Row row{{{Line{effect.key, " ", doc::Soft{effect.meaning}}},
                doc::in_unit(effect.size, unit.si, kBudgetDigits),
                {effect_number(effect.estimate, effect.standard_error, unit)},
                {effect_number(effect.alone, effect.alone_half_width, unit)},
                unit.name,
                effect.p_of_all ? p_value_text(*effect.p_of_all) : std::string("–"),
                effect.size_from}};
  if (missing) row.notes.emplace_back("shown by the residuals");
  if (effect.problem) row.notes.push_back(*effect.problem);
  return row;
}

/// Lists the effects in a refitted model with their sizes: "valve_time_constant 0.21 ms, ki 5.0
/// V/(m s)".
std::string refit_sizes(const calib::Considered& considered, const calib::RefittedModel& model) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < std::min(model.effects.size(), model.sizes.size()); ++i) {
    const calib::ConsideredEffect* effect = considered.find(model.effects[i]);
    const ReadableUnit unit = effect == nullptr ? readable_unit(model.sizes[i], "1")
                                                : readable_unit(effect->size, effect->unit);
    words.push_back(fmt::format("{} {}{}{}", model.effects[i],
                                significant(model.sizes[i] / unit.si, kBudgetDigits),
                                unit.name.empty() ? "" : " ", unit.name));
  }
  return words.empty() ? std::string("as it is") : fmt::format("{}", fmt::join(words, ", "));
}

/// Adds the refitted models and the estimates that each of them gives.
void add_refits(const StoredFit& fit, doc::Blocks& blocks) {
  const calib::Considered& considered = *fit.considered;
  if (considered.refitted.empty()) return;
  doc::Table models{"Refitted models"};
  models.caption = {"Fits repeated with the effects that explain most"};
  models.columns = {{"Model with"},
                    {"Decrease of the sum of squares", Kind::number},
                    {"Decrease in cross-validation", Kind::number},
                    {"Weight", Kind::number}};
  for (const calib::RefittedModel& each : considered.refitted) {
    models.rows.push_back(
        {{refit_sizes(considered, each), doc::in_unit(each.fall, 1.0, 3),
          doc::in_unit(each.held_out_fall, 1.0, 3), doc::decimals(each.weight, 2)}});
  }
  blocks.emplace_back(std::move(models));
  doc::Table averaged{"Estimates over these models"};
  averaged.columns = {{"Parameter"},
                      {"As it is", Kind::number},
                      {"Averaged", Kind::number},
                      {"u", Kind::number},
                      {"Unit", Kind::unit}};
  for (const calib::FittedParameter& p : fit.parameters) {
    if (!p.averaged) continue;
    const ReadableUnit unit = unit_of(p);
    averaged.rows.push_back(
        {{parameter_label(p), doc::in_unit(p.value, unit.si),
          doc::in_unit(p.averaged->value, unit.si),
          doc::in_unit(p.averaged->standard_error, unit.si, kBudgetDigits), unit.name}});
  }
  if (!averaged.rows.empty()) blocks.emplace_back(std::move(averaged));
}

doc::Row stability_row(const calib::StabilityCheck& check) {
  const ReadableUnit unit = readable_unit(check.value, check.unit);
  return {{check.level ? fmt::format("{} ({})", check.key, *check.level) : check.key,
           doc::in_unit(check.value, unit.si),
           doc::in_unit(check.difference, unit.si, kBudgetDigits),
           Line{"± ", doc::in_unit(check.expanded, unit.si, kBudgetDigits)}, unit.name,
           doc::Badge{check.differs ? doc::State::warn : doc::State::good,
                      check.differs ? "differs" : "agrees"}}};
}

}  // namespace

void add_budget(const std::vector<calib::FittedParameter>& parameters, doc::Blocks& blocks) {
  std::vector<BudgetOf> budgets;
  for (const calib::FittedParameter& p : parameters)
    if (p.budget) budgets.push_back({parameter_label(p), unit_of(p), &*p.budget});
  if (budgets.empty()) return;
  blocks.emplace_back(budget_table("Parameter", budgets));
  blocks.emplace_back(doc::reading(
      "The 95 % interval extends by U beyond the value as it is, beyond value + shift, beyond the "
      "value that the likeliest sizes of the effects would give, and beyond the estimate over the "
      "models with a missing effect. If the interval then extends more than a fifth above a value "
      "that cannot be zero, its upper end is a factor of the value where that is further out."));
  blocks.emplace_back(contributions("Parameter", budgets));
}

void add_score_budgets(const calib::ConditionResult& condition, doc::Blocks& blocks) {
  std::vector<BudgetOf> budgets;
  for (const calib::ChannelScore& score : condition.channels) {
    if (!score.score_budgets) continue;
    for (const metrics::MetricSpec& metric : metrics::kMetrics) {
      const calib::Budget95* budget = find(*score.score_budgets, std::string(metric.name));
      if (budget == nullptr) continue;
      ReadableUnit unit{metric.unit == "1" ? std::string() : std::string(metric.unit), 1.0};
      if (metric.unit == "channel")
        unit = readable_unit(score.metrics.*metric.value, info(score.channel).unit);
      budgets.push_back({fmt::format("{} of {}", metric.title, spaced(std::string(score.key()))),
                         std::move(unit), budget});
    }
  }
  if (budgets.empty()) return;
  doc::Fold fold{"Uncertainty budgets of the scores", {}};
  fold.style = "screen";  // seven scores of each channel would fill sheets of paper
  fold.blocks.emplace_back(budget_table("Score", budgets));
  fold.blocks.emplace_back(contributions("Score", budgets));
  blocks.emplace_back(std::move(fold));
}

void add_considered(const StoredFit& fit, doc::Blocks& blocks) {
  if (!fit.considered) return;
  blocks.emplace_back(doc::Heading{{"Small effects that the model leaves out"}});
  const calib::Considered& considered = *fit.considered;
  const auto is_missing = [&](const calib::ConsideredEffect& effect) {
    return std::find(considered.missing.begin(), considered.missing.end(), effect.key) !=
           considered.missing.end();
  };
  if (!considered.effects.empty()) {
    blocks.emplace_back(doc::reading(
        considered.missing.empty()
            ? std::string("The residuals show none of them.")
            : fmt::format("The residuals show {}.", fmt::join(considered.missing, ", then "))));
    doc::Table table{"Effects"};
    table.style = "dense";
    table.columns = {{"Effect"},
                     {"Plausible size", Kind::number},
                     {"From prior and records, ± u", Kind::number},
                     {"From the records, it alone, ± U", Kind::number},
                     {"Unit", Kind::unit},
                     {"p if absent, tested with all", Kind::number},
                     {"Source of the size"}};
    for (const calib::ConsideredEffect& each : considered.effects)
      table.rows.push_back(effect_row(each, is_missing(each)));
    const std::string summary = fmt::format("Effects ({})", table.rows.size());
    blocks.emplace_back(doc::Fold{summary, {std::move(table)}});
  }
  add_refits(fit, blocks);
  if (!considered.left_out.empty())
    blocks.emplace_back(doc::reading(
        fmt::format("Left out by the campaign: {}.", fmt::join(considered.left_out, ", "))));
}

void add_stability(const StoredFit& fit, doc::Blocks& blocks) {
  if (!fit.stability || fit.stability->empty()) return;
  const char* const title = "Estimates from the validation records alone";
  blocks.emplace_back(doc::Heading{{title}});
  doc::Table table{title};
  table.columns = {{"Parameter"},
                   {"Value", Kind::number},
                   {"Difference from the fit", Kind::number},
                   {"Allowed by both uncertainties"},
                   {"Unit", Kind::unit},
                   {"Outcome, all together"}};
  for (const calib::StabilityCheck& each : *fit.stability)
    table.rows.push_back(stability_row(each));
  blocks.emplace_back(std::move(table));
}

}  // namespace rigcal::report
