#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/page/page_parts.hpp"

namespace rigcal::report {
namespace {

using Kind = doc::Column::Kind;

/// Formats a standard deviation in percent of the value; a dash if it is absent.
std::string percent_text(const std::optional<double>& sd, const std::optional<double>& value) {
  if (!sd || !value || *value == 0.0) return "–";
  const double percent = 100.0 * *sd / std::abs(*value);
  return percent > 1000.0 ? std::string("> 1000") : fmt::format("{:.3g}", percent);
}

doc::Row percent_row(const StoredPlan& plan, const std::string& label,
                     const std::vector<std::optional<double>>& sd) {
  doc::Row row{{label}};
  for (std::size_t j = 0; j < plan.parameters.size(); ++j)
    row.cells.push_back(percent_text(sd[j], finite(plan.parameters[j].value)));
  return row;
}

/// Returns a table with a column for each parameter.
doc::Table percent_table(const StoredPlan& plan, const char* label, const char* first) {
  doc::Table table{label};
  table.columns = {{first}};
  for (const calib::PlannedParameter& parameter : plan.parameters)
    table.columns.push_back({parameter.label(), doc::Column::Kind::number});
  return table;
}

std::vector<std::optional<double>> of_all(const StoredPlan& plan,
                                          std::optional<double> calib::PlannedParameter::*sd) {
  std::vector<std::optional<double>> list;
  for (const calib::PlannedParameter& parameter : plan.parameters) list.push_back(parameter.*sd);
  return list;
}

Trace bar(double at, double height, const std::string& style) {
  Trace trace = empty_trace(Trace::Kind::band, style);
  constexpr double kHalfWidth = 0.35;
  trace.x = {at - kHalfWidth, at + kHalfWidth};
  trace.y = {0.0, 0.0};
  trace.upper = {height, height};
  return trace;
}

std::vector<Figure> share_figures(const StoredPlan& plan) {
  std::vector<Figure> figures;
  for (std::size_t j = 0; j < plan.parameters.size(); ++j) {
    const calib::PlannedParameter& parameter = plan.parameters[j];
    const std::optional<double>& all = parameter.sd_all;
    if (!all || !(*all > 0.0)) continue;
    Plot plot{fmt::format("{}: fraction of the precision of all records that each provides alone",
                          parameter.label()),
              "record", fmt::format("{} [%]", parameter.label()), 300.0, 150.0};
    plot.whole_x = true;
    plot.levels = {0.0};
    for (std::size_t i = 0; i < plan.records.size(); ++i) {
      const auto& alone = plan.records[i].sd_alone[j];
      const double share = alone && *alone > 0.0 ? std::pow(*all / *alone, 2) : 0.0;
      plot.traces.push_back(bar(static_cast<double>(i + 1), 100.0 * share,
                                plan.records[i].recorded ? "residual" : "model"));
    }
    figures.push_back({"plan_" + plain_name(parameter.label()), std::move(plot)});
  }
  return figures;
}

doc::Verdict records_headline(const StoredPlan& plan) {
  const auto recorded = std::count_if(plan.records.begin(), plan.records.end(),
                                      [](const auto& record) { return record.recorded; });
  const auto determined =
      std::count_if(plan.parameters.begin(), plan.parameters.end(),
                    [](const auto& parameter) { return parameter.sd_all.has_value(); });
  const bool whole = static_cast<std::size_t>(determined) == plan.parameters.size();
  doc::Verdict verdict{
      {whole ? doc::State::good : doc::State::warn, "PLAN"},
      {fmt::format("{} of {} records exist; all together determine {} of {} parameters.", recorded,
                   plan.records.size(), determined, plan.parameters.size())}};
  for (const calib::PlannedParameter& parameter : plan.parameters) {
    if (parameter.sd_all) continue;
    add_reason(verdict,
               fmt::format("{} is not determined{}{}", parameter.label(),
                           parameter.remedy ? ": " : "", parameter.remedy.value_or("")),
               "plan");
  }
  return verdict;
}

doc::Section records_section(const StoredPlan& plan) {
  using doc::Line;
  doc::Table totals{"Parameters"};
  totals.caption = {"Parameters, from all records together"};
  totals.shape = doc::Table::Shape::cards;
  totals.style = "totals";
  totals.columns = {{"Parameter"},
                    {"Value", Kind::number},
                    {"Unit", Kind::unit},
                    {"sd, recorded", Kind::number},
                    {"sd, with planned records", Kind::number},
                    {"Would determine it"}};
  for (const calib::PlannedParameter& parameter : plan.parameters) {
    const ReadableUnit unit = readable_unit(finite(parameter.value).value_or(0.0), parameter.unit);
    totals.rows.push_back(
        {{parameter.label(), doc::in_unit(finite(parameter.value), unit.si, 5),
          unit.name.empty() ? std::string("1") : unit.name,
          doc::in_unit(parameter.sd_recorded, unit.si, 2),
          doc::in_unit(parameter.sd_all, unit.si, 2), parameter.remedy.value_or("")}});
  }
  doc::Table alone = percent_table(plan, "Each record alone", "Record");
  alone.caption = {"Standard deviation in % of the value, from each record alone"};
  doc::Table without = percent_table(
      plan, "Standard deviation in % of the value, from all records but one", "Without");
  std::vector<std::string> problems;
  for (std::size_t i = 0; i < plan.records.size(); ++i) {
    const calib::PlannedRecord& record = plan.records[i];
    const std::string label =
        fmt::format("{} {}{}", i + 1, record.condition, record.recorded ? "" : " (planned)");
    alone.rows.push_back(percent_row(plan, label, record.sd_alone));
    without.rows.push_back(percent_row(plan, label, record.sd_without));
    if (record.problem)
      problems.push_back(fmt::format("{}: {}", record.condition, *record.problem));
  }
  alone.rows.push_back(percent_row(plan, "All that are recorded",
                                   of_all(plan, &calib::PlannedParameter::sd_recorded)));
  alone.rows.push_back(percent_row(plan, "All", of_all(plan, &calib::PlannedParameter::sd_all)));
  doc::Gallery gallery;
  for (Figure& figure : share_figures(plan))
    gallery.figures.push_back(figure_of(std::move(figure.plot)));
  return {"plan",
          "What the records determine",
          {doc::reading("Smallest possible standard deviations: white noise, an exact model, "
                        "every parameter free (Cramér and Rao). Real fits are somewhat less "
                        "precise. A dash: not determined."),
           list_of(plan.messages), list_of(problems, doc::State::bad), std::move(totals),
           doc::Heading{{"Information of each record"}},
           doc::about_picture(
               "Fraction of the total information (1/variance) that each record alone provides: "
               "blue recorded, orange planned. The table has the numbers."),
           std::move(gallery), std::move(alone),
           doc::Fold{fmt::format("From all records but one ({})", plan.records.size()),
                     {std::move(without)}}},
          "Plan"};
}

}  // namespace

std::vector<Figure> plan_figures(const PlanFiles& files) {
  std::vector<Figure> figures = share_figures(files.result);
  for (Figure& figure : design_figures(files)) figures.push_back(std::move(figure));
  return figures;
}

doc::Verdict plan_headline(const PlanFiles& files) {
  if (files.result.design) return design_headline(*files.result.design);
  return records_headline(files.result);
}

std::vector<doc::Section> plan_sections(const PlanFiles& files) {
  std::vector<doc::Section> sections;
  if (files.result.design) sections.push_back(design_section(files));
  if (!files.result.records.empty() || !files.result.design)
    sections.push_back(records_section(files.result));
  return sections;
}

}  // namespace rigcal::report
