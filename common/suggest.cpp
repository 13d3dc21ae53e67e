#include "common/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace rigcal {
namespace {

constexpr std::size_t kMostNamesShown = 30;

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = lower(c);
  return result;
}

/// Edit distance with insertion, deletion, substitution and transposition of neighbours, each
/// costing 1 ("optimal string alignment").
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last(b.size() + 1);
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before_last.swap(last);
    last.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, substituted});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
  }
  return row[b.size()];
}

}  // namespace

std::string nearest_name(std::string_view name, const std::vector<std::string>& known) {
  const std::string wanted = lower(name);
  std::string nearest;
  std::size_t nearest_distance = 0;
  for (const std::string& candidate : known) {
    // If more than a third of the letters are wrong, it is a different word rather than a typo.
    const std::size_t limit = std::max<std::size_t>(1, std::max(name.size(), candidate.size()) / 3);
    const std::size_t lengths = std::max(name.size(), candidate.size());
    if (lengths - std::min(name.size(), candidate.size()) > limit) continue;
    const std::size_t distance = edit_distance(wanted, lower(candidate));
    if (distance > limit || distance >= lengths) continue;
    if (nearest.empty() || distance < nearest_distance) {
      nearest = candidate;
      nearest_distance = distance;
    }
  }
  return nearest;
}

std::string unknown_name_message(std::string_view what, std::string_view name,
                                 const std::vector<std::string>& known) {
  std::string message = fmt::format("unknown {} '{}'", what, name);
  const std::string nearest = nearest_name(name, known);
  if (!nearest.empty()) message += fmt::format("; did you mean '{}'?", nearest);
  if (known.empty()) return message;
  const std::size_t shown = std::min(known.size(), kMostNamesShown);
  message += " (known: ";
  for (std::size_t i = 0; i < shown; ++i) message.append(i == 0 ? "" : ", ").append(known[i]);
  if (shown < known.size()) message += fmt::format(" and {} more", known.size() - shown);
  return message + ")";
}

}  // namespace rigcal
