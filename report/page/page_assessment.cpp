#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "report/page/page_parts.hpp"

namespace rigcal::report {
namespace {

struct AspectName {
  const char* key;
  const char* name;
  const char* link;  ///< id of the section with the evidence
};
constexpr std::array kAspects{AspectName{"agreement", "Agreement with the limits", "matrix"},
                              AspectName{"validation", "Independent validation", "matrix"},
                              AspectName{"adequacy", "Adequacy of the model", "conditions"},
                              AspectName{"parameters", "Parameters", "parameters"}};

Json state_badge(const std::string& state) {
  if (state == "pass") return {{"word", "pass"}, {"mark", "✓"}, {"class", "good"}};
  if (state == "reservation") return {{"word", "reservation"}, {"mark", "!"}, {"class", "warn"}};
  if (state == "fail") return {{"word", "fail"}, {"mark", "✕"}, {"class", "bad"}};
  return {{"word", "not assessed"}, {"mark", "○"}, {"class", "none"}};
}

/// Where the evidence for a reason is.
std::string link_of(const Json& result, const Json& reason, const char* section) {
  const std::string subject = text_of(reason, "subject");
  const Json& conditions = result.at("conditions");
  const bool condition = std::any_of(conditions.begin(), conditions.end(), [&](const Json& each) {
    return text_of(each, "id") == subject;
  });
  return condition ? anchor(subject) : section;
}

}  // namespace

Json assessment_view(const Json& result) {
  constexpr std::size_t kShown = 3;  // against; the rest is counted, and stands in the sections
  const auto assessment = result.find("assessment");
  if (assessment == result.end()) return Json::array();
  Json rows = Json::array();
  for (const AspectName& aspect : kAspects) {
    const Json& found = assessment->at(aspect.key);
    Json against = Json::array();
    Json in_favour = Json::array();
    std::size_t more = 0;
    for (const Json& reason : found.at("reasons")) {
      const Json entry{{"text", text_of(reason, "words")},
                       {"link", link_of(result, reason, aspect.link)}};
      if (text_of(reason, "state") == "pass") {
        in_favour.push_back(entry);
      } else if (against.size() < kShown) {
        against.push_back(entry);
      } else {
        ++more;
      }
    }
    rows.push_back({{"name", aspect.name},
                    {"badge", state_badge(text_of(found, "state"))},
                    {"against", std::move(against)},
                    {"for", std::move(in_favour)},
                    {"has_more", more > 0},
                    {"more", fmt::format("{}", more)}});
  }
  return rows;
}

std::string open_aspects(const Json& result) {
  const auto assessment = result.find("assessment");
  if (assessment == result.end()) return {};
  std::string text;
  for (const AspectName& aspect : kAspects) {
    const std::string state = text_of(assessment->at(aspect.key), "state");
    if (state == "pass") continue;
    std::string name = aspect.name;
    name.front() = static_cast<char>(name.front() | 0x20);  // ASCII, to lower case
    text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", name,
                        text_of(state_badge(state), "word"));
  }
  return text;
}

}  // namespace rigcal::report
