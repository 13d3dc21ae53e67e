#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <system_error>

#include "datasets/campaign/campaign.hpp"
#include "datasets/campaign/reading_root.hpp"

namespace rigcal::datasets {
namespace {

namespace fs = std::filesystem;

/// Maximum number of folder entries that the patterns of one condition may visit.
constexpr long kMostEntries = 200'000;

bool is_pattern(std::string_view text) {
  return text.find_first_of("*?") != std::string_view::npos;
}

/// Whether a file name matches a pattern: '*' matches any text, '?' one character. Takes at most
/// quadratic time.
bool fits(std::string_view name, std::string_view pattern) {
  std::size_t n = 0;
  std::size_t p = 0;
  std::size_t star = std::string_view::npos;
  std::size_t after_star = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      after_star = n;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == name[n])) {
      ++p;
      ++n;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      n = ++after_star;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

/// Lists the folder entries that match a pattern. Hidden entries match only if the pattern begins
/// with a dot.
///
/// @param left  number of entries that may still be visited
std::vector<fs::path> entries_that_fit(const fs::path& folder, const std::string& pattern,
                                       long& left) {
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::directory_iterator entry(folder.empty() ? "." : folder, error), end;
       !error && entry != end && left > 0; entry.increment(error)) {
    --left;
    const std::string name = entry->path().filename().string();
    if (name.front() == '.' && pattern.front() != '.') continue;
    if (fits(name, pattern)) found.push_back(folder / name);
  }
  return found;
}

struct Expansion {
  std::vector<fs::path> files;  ///< sorted by name
  fs::path searched;            ///< folder in which the first pattern was applied
};

/// Expands a path whose components may be patterns.
///
/// @param root  folders outside it are not visited; empty: no restriction
/// @param left  number of entries that may still be visited
Expansion expand(const fs::path& base, const std::string& pattern, const fs::path& root,
                 long& left) {
  Expansion result;
  std::vector<fs::path> reached{base};
  bool searched = false;
  for (const fs::path& part : fs::path(pattern)) {
    const std::string text = part.string();
    std::vector<fs::path> next;
    for (const fs::path& folder : reached) {
      if (!is_pattern(text)) {
        next.push_back(folder / part);
        continue;
      }
      if (!searched) result.searched = folder;
      searched = true;
      require_within(root, folder);
      const auto found = entries_that_fit(folder, text, left);
      next.insert(next.end(), found.begin(), found.end());
    }
    reached = std::move(next);
  }
  for (const fs::path& path : reached) {
    require_within(root, path);
    std::error_code error;
    if (fs::is_regular_file(path, error)) result.files.push_back(path);
  }
  if (!searched) result.searched = (base / pattern).parent_path();
  std::sort(result.files.begin(), result.files.end());
  return result;
}

std::string filled_in(std::string text, const std::string& number) {
  constexpr std::string_view kNumber = "{n}";
  for (std::size_t at = text.find(kNumber); at != std::string::npos;
       at = text.find(kNumber, at + number.size())) {
    text.replace(at, kNumber.size(), number);
  }
  return text;
}

std::map<Channel, std::string> columns_of(const Campaign& campaign, const RepeatPattern& pattern,
                                          const std::string& number) {
  std::map<Channel, std::string> columns;
  for (const auto& [channel, setting] : campaign.channels) {
    if (!setting.column.empty() && setting.role != ChannelRole::ignore) {
      columns[channel] = setting.column;
    }
  }
  for (const auto& [channel, column] : pattern.columns) {
    if (campaign.channels.at(channel).role != ChannelRole::ignore) {
      columns[channel] = filled_in(column, number);
    }
  }
  return columns;
}

std::string folder_text(const fs::path& path) {
  return path.empty() ? std::string("the working folder") : fmt::format("'{}'", path.string());
}

std::vector<RepeatSource> sources_of(const Campaign& campaign, const Condition& condition,
                                     const RepeatPattern& pattern, const std::string& number,
                                     long& entries_left) {
  const std::string file = filled_in(pattern.file, number);
  const Expansion expansion = expand(campaign.data_dir, file, campaign.root, entries_left);
  if (entries_left <= 0) {
    throw InputError(condition.where,
                     fmt::format("condition \"{}\": '{}' has to search more than {} files and "
                                 "folders; expected a pattern that names the folder of the records",
                                 condition.id, file, kMostEntries));
  }
  if (expansion.files.empty()) {
    throw InputError(condition.where,
                     fmt::format("condition \"{}\": no file matches '{}' in {}; expected at least "
                                 "one record (relative paths start at {})",
                                 condition.id, file, folder_text(expansion.searched),
                                 folder_text(campaign.data_dir)));
  }
  std::vector<RepeatSource> sources;
  for (const fs::path& path : expansion.files) {
    const fs::path named =
        fs::path(file).is_absolute() ? path : path.lexically_relative(campaign.data_dir);
    std::string label = (named.empty() ? path : named).generic_string();
    if (!number.empty()) label += " " + number;
    sources.push_back({path, label, columns_of(campaign, pattern, number)});
  }
  return sources;
}

/// Checks that no file matches two patterns, since it would count as two repeats.
void check_distinct(const Condition& condition, const std::vector<RepeatSource>& sources) {
  std::set<std::pair<fs::path, std::map<Channel, std::string>>> seen;
  for (const RepeatSource& source : sources) {
    if (seen.emplace(source.path.lexically_normal(), source.columns).second) continue;
    throw InputError(condition.where,
                     fmt::format("condition \"{}\": '{}' is matched twice by repeats; expected "
                                 "every repeat once",
                                 condition.id, source.label));
  }
}

}  // namespace

std::vector<RepeatSource> repeat_sources(const Campaign& campaign, const Condition& condition) {
  std::vector<RepeatPattern> patterns = condition.repeats;
  if (condition.averaged) patterns.push_back({*condition.averaged, {}, {}});
  std::vector<RepeatSource> sources;
  long entries_left = kMostEntries;
  for (const RepeatPattern& pattern : patterns) {
    const std::vector<std::string> numbers =
        pattern.numbers.empty() ? std::vector<std::string>{""} : pattern.numbers;
    for (const std::string& number : numbers) {
      const auto found = sources_of(campaign, condition, pattern, number, entries_left);
      sources.insert(sources.end(), found.begin(), found.end());
    }
  }
  if (condition.averaged && sources.size() != 1) {
    throw InputError(
        condition.where,
        fmt::format("condition \"{}\": {} files match '{}'; expected one averaged file",
                    condition.id, sources.size(), *condition.averaged));
  }
  check_distinct(condition, sources);
  return sources;
}

}  // namespace rigcal::datasets
