#include <fmt/format.h>

#include <array>

#include "report/page/page_parts.hpp"

namespace rigcal::report {
namespace {

using calib::AspectState;

struct AspectName {
  StoredAspect StoredAssessment::*aspect;
  const char* name;
  const char* link;  ///< id of the section with the evidence
};
constexpr std::array kAspects{
    AspectName{&StoredAssessment::agreement, "Agreement with the limits", "matrix"},
    AspectName{&StoredAssessment::validation, "Independent validation", "matrix"},
    AspectName{&StoredAssessment::adequacy, "Adequacy of the model", "conditions"},
    AspectName{&StoredAssessment::parameters, "Parameters", "parameters"}};

struct StateBadge {
  const char *word, *mark, *css;
};
StateBadge state_badge(AspectState state) {
  switch (state) {
    case AspectState::pass:
      return {"pass", "✓", "good"};
    case AspectState::reservation:
      return {"reservation", "!", "warn"};
    case AspectState::fail:
      return {"fail", "✕", "bad"};
    case AspectState::not_assessed:
    case AspectState::note:
      break;
  }
  return {"not assessed", "○", "none"};
}

/// Where the evidence for a reason is.
std::string link_of(const StoredFit& fit, const StoredReason& reason, const char* section) {
  return reason.subject && fit.find(*reason.subject) != nullptr ? anchor(*reason.subject) : section;
}

}  // namespace

Json assessment_view(const StoredFit& fit) {
  constexpr std::size_t kShown = 3;  // against; the rest is counted, and stands in the sections
  Json rows = Json::array();
  if (!fit.assessment) return rows;
  for (const AspectName& aspect : kAspects) {
    const StoredAspect& found = (*fit.assessment).*aspect.aspect;
    Json against = Json::array();
    Json in_favour = Json::array();
    Json notes = Json::array();
    std::size_t more = 0;
    for (const StoredReason& reason : found.reasons) {
      const Json entry{{"text", reason.words}, {"link", link_of(fit, reason, aspect.link)}};
      if (reason.state == AspectState::note) {
        notes.push_back(entry);
      } else if (!calib::is_against(reason.state)) {
        in_favour.push_back(entry);
      } else if (against.size() < kShown) {
        against.push_back(entry);
      } else {
        ++more;
      }
    }
    const StateBadge badge = state_badge(found.state);
    rows.push_back({{"name", aspect.name},
                    {"badge", {{"word", badge.word}, {"mark", badge.mark}, {"class", badge.css}}},
                    {"against", std::move(against)},
                    {"for", std::move(in_favour)},
                    {"notes", std::move(notes)},
                    {"has_more", more > 0},
                    {"more", fmt::format("{}", more)}});
  }
  return rows;
}

std::string open_aspects(const StoredFit& fit) {
  std::string text;
  if (!fit.assessment) return text;
  for (const AspectName& aspect : kAspects) {
    const AspectState state = ((*fit.assessment).*aspect.aspect).state;
    if (state == AspectState::pass) continue;
    std::string name = aspect.name;
    name.front() = static_cast<char>(name.front() | 0x20);  // ASCII, to lower case
    text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", name, state_badge(state).word);
  }
  return text;
}

}  // namespace rigcal::report
