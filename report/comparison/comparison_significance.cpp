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

std::vector<std::optional<StoredSignificance>> tested_parameters(
    const std::vector<StoredComparedParameter>& parameters, std::size_t results) {
  std::vector<std::optional<StoredSignificance>> list(1);
  for (std::size_t i = 1; i < results; ++i) {
    StoredSignificance count;
    std::vector<Untested> open;
    for (const StoredComparedParameter& parameter : parameters) {
      const auto& difference = parameter.differences[i];
      if (!difference || difference->reason == calib::kKnownInBoth) continue;
      ++count.compared;
      if (!difference->significant) {
        add_untested(open, difference->reason.value_or(""), parameter_label(parameter));
        continue;
      }
      ++count.tested;
      count.significant += *difference->significant ? 1 : 0;
    }
    count.text = sentence(count.compared, count.tested, count.significant, open);
    list.emplace_back(std::move(count));
  }
  return list;
}

std::vector<Change> changes_of(const StoredComparison& comparison) {
  std::vector<std::pair<double, Change>> changes;  // each with its size in standard errors
  for (const StoredComparedParameter& parameter : comparison.parameters) {
    const auto error_of_estimate = [&](std::size_t i) {
      const auto& estimate = parameter.estimates.at(i);
      return estimate ? estimate->standard_error.value_or(0.0) : 0.0;
    };
    for (std::size_t i = 1; i < parameter.differences.size(); ++i) {
      const auto& difference = parameter.differences[i];
      if (!difference || difference->reason == calib::kKnownInBoth) continue;
      const double size = difference->difference.value_or(0.0);
      if (size == 0.0 || difference->significant == false) continue;
      changes.emplace_back(std::abs(size) / std::hypot(error_of_estimate(0), error_of_estimate(i)),
                           Change{parameter_label(parameter), comparison.results.at(i).name,
                                  change_text(*difference, unit_of_estimates(parameter)),
                                  difference->p_value_of_all, difference->reason.value_or("")});
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
