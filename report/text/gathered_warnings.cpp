#include "report/text/gathered_warnings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>

namespace rigcal::report {
namespace {

constexpr std::size_t kMostNamed = 3;

}  // namespace

std::vector<std::string> gathered_by_text(
    const std::vector<std::pair<std::string, std::string>>& warnings) {
  std::vector<std::string> order;
  std::map<std::string, std::vector<std::string>> records;
  for (const auto& [record, text] : warnings) {
    if (!records.contains(text)) order.push_back(text);
    records[text].push_back(record);
  }
  std::vector<std::string> lines;
  for (const std::string& text : order) {
    std::vector<std::string>& names = records[text];
    const std::size_t count = names.size();
    if (count <= kMostNamed) {
      lines.push_back(fmt::format("{}: {}", fmt::join(names, ", "), text));
      continue;
    }
    names.resize(kMostNamed);
    lines.push_back(fmt::format("{} records ({} and {} more): {}", count, fmt::join(names, ", "),
                                count - kMostNamed, text));
  }
  return lines;
}

}  // namespace rigcal::report
