#include "report/leak/fit_tables.hpp"

#include <fmt/format.h>

#include <cmath>

#include "calib/trust/identifiability.hpp"
#include "common/significant.hpp"
#include "report/text/estimate_text.hpp"
#include "report/text/readable.hpp"
#include "report/text/text_table.hpp"

namespace rigcal::report {
namespace {

using calib::FitStatus;
using Align = TextTable::Align;

std::string reason(const calib::FittedAssumption& p) {
  if (p.at_bound) return "at its bound";
  if (!p.standard_error || !p.ci95) return "the published numbers do not determine it";
  if (p.identifiability == calib::Identifiability::identified) return "";
  if (p.identifiability == calib::Identifiability::bounded)
    return "not significantly different from zero";
  const double half_width = 0.5 * (p.ci95->second - p.ci95->first);
  return calib::half_width_words(half_width / std::abs(p.value));
}

StoredParameter stored(const TablesFitResult& result, const calib::FittedAssumption& p) {
  const auto& spec = datasets::assumption_spec(result.campaign.rig.plant, p.index);
  StoredParameter parameter;
  parameter.name = spec.name;
  parameter.key = spec.key;
  parameter.symbol = spec.symbol;
  parameter.unit = spec.unit;
  if (result.fit.status != FitStatus::failed) parameter.value = p.value;
  parameter.start = p.start;
  parameter.lower = p.lower;
  parameter.upper = p.upper;
  parameter.fitted = true;
  parameter.standard_error = p.standard_error;
  if (p.ci95) {
    parameter.ci95 = {p.ci95->first, p.ci95->second};
    parameter.ci95_if_exact = parameter.ci95;
    parameter.ci95_from = std::optional(calib::IntervalSource::standard_error);
    parameter.degrees_of_freedom = p.degrees_of_freedom;
  }
  parameter.at_bound = p.at_bound;
  parameter.identifiability = p.identifiability;
  parameter.reason = reason(p);
  return parameter;
}

}  // namespace

StoredTablesFit stored(const TablesFitResult& result) {
  const calib::TablesFit& fit = result.fit;
  const bool failed = fit.status == FitStatus::failed;
  StoredTablesFit json;
  json.status = fit.status;
  json.message = fit.message;
  json.campaign = result.campaign.name;
  if (!failed) json.cost = fit.cost;
  json.residual_count = static_cast<long>(fit.residuals.size());
  if (!failed) json.rms = fit.rms;
  json.evaluations = fit.evaluations;
  json.iterations = fit.iterations;
  json.wall_seconds = fit.wall_seconds;
  for (const calib::FittedAssumption& p : fit.parameters) {
    json.parameters.push_back(stored(result, p));
    json.correlation.names.push_back(json.parameters.back().name);
  }
  for (const auto& row : fit.correlation.rowwise())
    json.correlation.matrix.emplace_back(row.begin(), row.end());
  for (const calib::TableResidual& residual : fit.residuals)
    json.residuals.push_back({residual.what, residual.weight, residual.log_ratio});
  json.left_out = fit.left_out;
  json.provenance = stored(result.provenance);
  return json;
}

std::string tables_fit_text(const TablesFitResult& result, const Style& style) {
  const calib::TablesFit& fit = result.fit;
  std::string text = style.colour ? "\x1b[1mEstimated from the published tables\x1b[0m\n"
                                  : "Estimated from the published tables\n";
  TextTable table({{"parameter"},
                   {"value", Align::right},
                   {"unit"},
                   {"std. error", Align::right},
                   {"95 % interval", Align::right},
                   {"start", Align::right},
                   {"identifiability"}});
  for (const calib::FittedAssumption& p : fit.parameters) {
    const auto& spec = datasets::assumption_spec(result.campaign.rig.plant, p.index);
    const ReadableUnit unit = readable_unit(p.value, spec.unit);
    std::optional<Range> ci95;
    if (p.ci95) ci95 = {p.ci95->first / unit.si, p.ci95->second / unit.si};
    const EstimateText estimate =
        estimate_text(p.value / unit.si, ci95, {p.lower / unit.si, p.upper / unit.si});
    table.add({std::string(spec.key), fit.status == FitStatus::failed ? "-" : estimate.value,
               std::string(unit.name),
               p.standard_error ? significant(*p.standard_error / unit.si, kErrorDigits) : "-",
               ci95 ? estimate.low + " .. " + estimate.high : "-",
               significant(p.start / unit.si, 4), std::string(to_string(p.identifiability))});
  }
  text += table.text();
  if (fit.correlation.rows() > 1) {
    text += "correlation:\n";
    for (Eigen::Index i = 1; i < fit.correlation.rows(); ++i) {
      const auto name = [&](Eigen::Index k) {
        const int index = fit.parameters[static_cast<std::size_t>(k)].index;
        return datasets::assumption_spec(result.campaign.rig.plant, index).key;
      };
      for (Eigen::Index j = 0; j < i; ++j) {
        text += fmt::format("  {}, {}: {}\n", name(j), name(i), fixed(fit.correlation(i, j), 2));
      }
    }
  }
  if (!fit.left_out.empty()) text += "left out:\n";
  for (const std::string& left_out : fit.left_out) text += fmt::format("  {}\n", left_out);
  text += fmt::format("status: {}: {}", to_string(fit.status), fit.message);
  if (fit.status != FitStatus::failed) {
    text += fmt::format("; {} published numbers, weighted logarithms off by {:.1f} % rms",
                        fit.residuals.size(), 100.0 * fit.rms);
  }
  return text + "\n";
}

}  // namespace rigcal::report
