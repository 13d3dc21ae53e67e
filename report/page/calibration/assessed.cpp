#include "report/page/calibration/assessed.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "calib/trust/collinearity.hpp"
#include "report/document/words.hpp"
#include "report/page/page_parts.hpp"

namespace rigcal::report {

std::string evidence_of(const StoredFit& fit, const calib::Reason& reason, const char* section) {
  return reason.subject && fit.find(*reason.subject) != nullptr ? anchor(*reason.subject) : section;
}

bool names_reason(const StoredFit& fit, calib::Aspect calib::Assessment::*aspect,
                  std::string_view code) {
  if (!fit.assessment) return false;
  const auto& reasons = ((*fit.assessment).*aspect).reasons;
  return std::any_of(reasons.begin(), reasons.end(),
                     [&](const calib::Reason& reason) { return reason.code == code; });
}

std::string open_aspects(const StoredFit& fit) {
  std::string text;
  if (!fit.assessment) return text;
  for (const AspectName& aspect : kAspects) {
    const calib::AspectState state = ((*fit.assessment).*aspect.aspect).state;
    if (state == calib::AspectState::pass) continue;
    std::string name = aspect.name;
    name.front() = static_cast<char>(name.front() | 0x20);  // ASCII, to lower case
    text += (text.empty() ? "" : ", ") + name;
    if (state != calib::AspectState::reservation) text += ": " + doc::badge(state).words;
  }
  return text;
}

std::string rule_words(datasets::DecisionRule rule) {
  switch (rule) {
    case datasets::DecisionRule::simple:
      return "Scores are compared with the campaign's limits as they are; their own uncertainty is "
             "not considered.";
    case datasets::DecisionRule::guard_band:
      return "PASS if a score meets its limit by more than its expanded uncertainty (95 %, from "
             "the repeats and the stated uncertainty of the sensors); WARN if by less; FAIL if it "
             "does not meet the limit.";
  }
  throw std::logic_error("rule_words: no words for a decision rule");
}

double correlation_at(const calib::Correlation& correlation, std::size_t i, std::size_t j) {
  const auto row = static_cast<Eigen::Index>(i);
  const auto column = static_cast<Eigen::Index>(j);
  const Eigen::MatrixXd& matrix = correlation.matrix;
  return row < matrix.rows() && column < matrix.cols() ? matrix(row, column) : std::nan("");
}

calib::Correlation correlation_by_key(calib::Correlation correlation,
                                      const std::vector<calib::FittedParameter>& parameters) {
  for (std::string& name : correlation.names) {
    const auto same = std::find_if(parameters.begin(), parameters.end(),
                                   [&name](const calib::FittedParameter& p) {
                                     return name == p.name || name.starts_with(p.name + " (");
                                   });
    if (same != parameters.end()) name.replace(0, same->name.size(), same->key);
  }
  return correlation;
}

std::string correlation_words(const calib::Correlation& correlation) {
  const auto at = [&](std::size_t i, std::size_t j) { return correlation_at(correlation, i, j); };
  std::vector<std::string> names;
  std::vector<std::size_t> known;
  for (std::size_t i = 0; i < correlation.names.size(); ++i) {
    if (std::isnan(at(i, i))) continue;
    known.push_back(i);
    names.push_back(correlation.names[i]);
  }
  const auto n = static_cast<Eigen::Index>(known.size());
  Eigen::MatrixXd matrix(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j)
      matrix(i, j) = at(known[static_cast<std::size_t>(i)], known[static_cast<std::size_t>(j)]);
  }
  return calib::collinearity_words(names, matrix);
}

doc::Section assessment_section(const StoredFit& fit) {
  // Only reasons against the result are shown; the sections list the others, which are counted
  // here.
  constexpr std::size_t kShown = 3;
  doc::Section section{"assessment", "Assessment"};
  if (fit.assessment) {
    section.blocks.emplace_back(doc::reading(
        "Four separate judgements. The adequacy of the model is an opinion and interpretation "
        "(ISO/IEC 17025, 7.8.7)."));
    doc::Table table{"Assessment: four separate judgements"};
    table.style = "aspects";
    table.columns = {{"Judged"},
                     {"State"},
                     {"Against", doc::Column::Kind::words},
                     {"For", doc::Column::Kind::words}};
    for (const AspectName& aspect : kAspects) {
      const calib::Aspect& found = (*fit.assessment).*aspect.aspect;
      doc::Cell against, in_favour;
      std::size_t more = 0;
      for (const calib::Reason& reason : found.reasons) {
        const doc::Line line{doc::Link{"#" + evidence_of(fit, reason, aspect.link), reason.words}};
        if (reason.state == calib::AspectState::note) {
          in_favour.paragraphs.push_back({doc::Soft{"Note: " + reason.words}});
        } else if (!calib::is_against(reason.state)) {
          in_favour.paragraphs.push_back({reason.words});
        } else if (against.paragraphs.size() < kShown) {
          against.paragraphs.push_back(line);
        } else {
          ++more;
        }
      }
      if (more > 0) against.paragraphs.push_back({fmt::format("and {} more", more)});
      table.rows.push_back(
          {{aspect.name, doc::badge(found.state), std::move(against), std::move(in_favour)}});
    }
    section.blocks.emplace_back(std::move(table));
  }
  section.blocks.emplace_back(doc::Paragraph{
      {doc::Strong{fmt::format("Solver: {}. ", to_string(fit.status))}, fit.message}});
  return section;
}

}  // namespace rigcal::report
