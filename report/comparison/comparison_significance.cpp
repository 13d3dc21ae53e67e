#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "report/comparison/comparison_parts.hpp"

namespace rigcal::report {
namespace {

struct Untested {
  std::string reason;
  std::vector<std::string> parameters;
};

void add_untested(std::vector<Untested>& list, const std::string& reason, const std::string& name) {
  const auto same = [&](const Untested& each) { return each.reason == reason; };
  auto found = std::find_if(list.begin(), list.end(), same);
  if (found == list.end()) found = list.insert(list.end(), {reason, {}});
  found->parameters.push_back(name);
}

std::string sentence(int compared, int tested, int significant, const std::vector<Untested>& open) {
  std::string text =
      fmt::format("{} parameter{} compared, {} tested", compared, compared == 1 ? "" : "s", tested);
  if (tested > 0) {
    text += significant == 0 ? std::string(", no significant difference")
                             : fmt::format(", {} significant difference{}", significant,
                                           significant == 1 ? "" : "s");
  }
  for (const Untested& each : open)
    text +=
        fmt::format("; not tested: {}, because {}", fmt::join(each.parameters, ", "), each.reason);
  return text;
}

}  // namespace

Json tested_parameters(const Json& parameters, std::size_t results) {
  Json list = Json::array({nullptr});
  for (std::size_t i = 1; i < results; ++i) {
    int compared = 0;
    int tested = 0;
    int significant = 0;
    std::vector<Untested> open;
    for (const Json& parameter : parameters) {
      const Json& difference = parameter.at("differences").at(i);
      if (!difference.is_object() || difference.at("reason") == kKnownInBoth) continue;
      ++compared;
      if (!difference.at("significant").is_boolean()) {
        add_untested(open, text_of(difference, "reason"), parameter_label(parameter));
        continue;
      }
      ++tested;
      significant += difference.at("significant").get<bool>() ? 1 : 0;
    }
    list.push_back({{"compared", compared},
                    {"tested", tested},
                    {"significant", significant},
                    {"text", sentence(compared, tested, significant, open)}});
  }
  return list;
}

std::vector<Change> changes_of(const Json& comparison) {
  std::vector<std::pair<double, Change>> changes;  // with the size in standard errors
  for (const Json& parameter : comparison.at("parameters")) {
    const Json& estimates = parameter.at("estimates");
    for (std::size_t i = 1; i < parameter.at("differences").size(); ++i) {
      const Json& difference = parameter.at("differences").at(i);
      if (!difference.is_object() || difference.at("reason") == kKnownInBoth) continue;
      const auto size = number_of(difference, "difference");
      if (!size || *size == 0.0) continue;
      const Json& significant = difference.at("significant");
      if (significant == false) continue;
      const double error = std::hypot(number_of(estimates[0], "standard_error").value_or(0.0),
                                      number_of(estimates[i], "standard_error").value_or(0.0));
      changes.emplace_back(
          std::abs(*size) / error,
          Change{parameter_label(parameter), text_of(comparison.at("results").at(i), "name"),
                 change_text(difference, unit_of_estimates(parameter)),
                 number_of(difference, "p_value_of_all"), text_of(difference, "reason")});
    }
  }
  std::stable_sort(changes.begin(), changes.end(), [](const auto& a, const auto& b) {
    const auto& p = a.second.p;
    const auto& q = b.second.p;
    if (p.has_value() != q.has_value()) return p.has_value();
    if (p && *p != *q) return *p < *q;
    return a.first > b.first;
  });
  std::vector<Change> sorted;
  for (auto& [size, change] : changes) sorted.push_back(std::move(change));
  return sorted;
}

}  // namespace rigcal::report
