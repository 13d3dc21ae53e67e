#include "report/page/calibration/page_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "report/page/calibration/assessed.hpp"
#include "report/page/calibration/certificate.hpp"
#include "report/page/calibration/fit_sections.hpp"
#include "report/store/result_files.hpp"
#include "report/text/stopped_sentence.hpp"

namespace rigcal::report {
namespace {

/// Returns the verdict on a fit to published tables, which has no records.
doc::Verdict tables_verdict(const StoredTablesFit& fit) {
  using calib::FitStatus;
  if (fit.status != FitStatus::converged) {
    doc::Verdict verdict;
    if (fit.status == FitStatus::failed)
      verdict = {{doc::State::bad, "FAILED"}, {kNoUsableResult}};
    else
      verdict = {{doc::State::bad, "STOPPED"}, {stopped_sentence(calib::StoppedIn::starts)}};
    add_reason(verdict, fit.message, {});
    return verdict;
  }
  doc::Verdict verdict{
      {doc::State::none, "FITTED"},
      {fmt::format("Estimated from {} published numbers; their weighted logarithms are off by "
                   "{:.1f} % rms.",
                   fit.residual_count, 100.0 * fit.rms.value_or(0.0))}};
  for (const calib::FittedParameter& p : fit.parameters) {
    if (!p.reason.empty())
      add_reason(verdict, fmt::format("{}: {}", parameter_label(p), p.reason), "parameters");
  }
  return verdict;
}

Part tables_fit_part(const StoredTablesFit& fit) {
  Part part = part_of(fit, "parameters", "Calibration from published tables", "fit.json");
  part.verdict = tables_verdict(fit);
  part.sections = {parameters_section(fit.parameters,
                                      correlation_by_key(fit.correlation, fit.parameters),
                                      fit.status != calib::FitStatus::stopped)};
  if (!fit.left_out.empty()) {
    doc::Blocks& blocks = part.sections.front().blocks;
    blocks.emplace_back(doc::Heading{{"Published numbers that are left out"}});
    blocks.emplace_back(list_of(fit.left_out));
  }
  part.provenance = provenance_blocks(fit.provenance, "Calibration", "fit.json", making_of(fit));
  part.nav = {{"parameters", "Parameters"}};
  return part;
}

Part fit_part(const Calibration& stored, const ResultFolder& folder) {
  const StoredFit& fit = stored.result;
  Part part = part_of(fit, "parameters", is_fit_schema(fit.schema) ? "Calibration" : "Validation",
                      stored.file);
  const bool unfinished = fit.status == calib::FitStatus::stopped && !searched_to_the_end(fit);
  part.verdict = fit_verdict(fit);
  part.front = certificate(stored);
  part.sections.push_back(assessment_section(fit));
  part.sections.push_back(scores_section(stored, unfinished));
  part.sections.push_back(parameters_section(
      fit.parameters, correlation_by_key(fit.correlation, fit.parameters), !unfinished));
  part.sections.push_back(conditions_section(stored, folder.threads, folder.curves));
  part.sections.push_back(identifiability_section(fit));
  part.sections.push_back(starts_section(fit));
  part.sections.push_back(warnings_section(fit));
  part.provenance = provenance_blocks(fit.provenance, part.name, stored.file, making_of(fit));
  part.nav = {{"matrix", "Scores"},         {"parameters", "Parameters"},
              {"conditions", "Conditions"}, {"identifiability", "Identifiability"},
              {"starts", "Starts"},         {"warnings", "Warnings"}};
  return part;
}

}  // namespace

Part calibration_part(const ResultFolder& folder) {
  const auto stored = load_calibration(folder.read, folder.where, folder.threads);
  if (const auto* tables = std::get_if<StoredTablesFit>(&stored)) return tables_fit_part(*tables);
  const auto& calibration = std::get<Calibration>(stored);
  Part part = fit_part(calibration, folder);
  part.live = live_of(calibration.result.provenance, folder, calibration.file);
  return part;
}

std::vector<Figure> calibration_figures(const ResultFolder& folder) {
  const auto stored = load_calibration(folder.read, folder.where, folder.threads);
  std::vector<Figure> figures;
  const auto* fit = std::get_if<Calibration>(&stored);
  if (fit == nullptr) return figures;
  figures = rig_response_figures(*fit);
  for (std::size_t i = 0; i < fit->result.conditions.size(); ++i) {
    const calib::ConditionResult& condition = fit->result.conditions[i];
    for (Figure& figure : condition_figures(condition, *fit->series(i)))
      figures.push_back({condition.id + "_" + figure.name, std::move(figure.plot)});
  }
  return figures;
}

}  // namespace rigcal::report
