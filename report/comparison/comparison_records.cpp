#include <algorithm>
#include <filesystem>
#include <set>

#include "report/comparison/comparison_parts.hpp"

namespace rigcal::report {
namespace {

bool share_published_numbers(const Compared& a, const Compared& b) {
  return std::any_of(a.published_numbers.begin(), a.published_numbers.end(), [&](const auto& each) {
    return std::find(b.published_numbers.begin(), b.published_numbers.end(), each) !=
           b.published_numbers.end();
  });
}

/// Returns the fitted conditions; empty if the file does not name their records.
std::vector<const calib::ConditionResult*> fitted_conditions(const StoredFit& fit) {
  std::vector<const calib::ConditionResult*> fitted;
  for (const calib::ConditionResult& condition : fit.conditions) {
    if (condition.use != datasets::Use::fit) continue;
    if (condition.record_sha256.empty()) return {};
    fitted.push_back(&condition);
  }
  return fitted;
}

/// Returns true if the windows of two conditions overlap. A condition without windows uses its
/// whole record.
bool overlap(const calib::ConditionResult& a, const calib::ConditionResult& b) {
  if (!a.windows_s || a.windows_s->empty() || !b.windows_s || b.windows_s->empty()) return true;
  for (const Range& one : *a.windows_s) {
    for (const Range& other : *b.windows_s)
      if (one.low < other.high && other.low < one.high) return true;
  }
  return false;
}

bool share_file(const calib::ConditionResult& a, const calib::ConditionResult& b) {
  const std::vector<std::string>& theirs = b.record_sha256;
  return std::any_of(a.record_sha256.begin(), a.record_sha256.end(), [&](const auto& hash) {
    return std::find(theirs.begin(), theirs.end(), hash) != theirs.end();
  });
}

}  // namespace

std::map<std::string, std::string> record_hashes(const StoredFit& fit) {
  std::map<std::string, std::string> hashes;
  for (const InputFile& input : fit.provenance.inputs) {
    const std::filesystem::path path = input.path;
    if (path.extension() == ".toml" || path.extension() == ".json") continue;
    hashes.emplace(input.sha256, path.filename().string());
  }
  return hashes;
}

bool share_records(const Compared& a, const Compared& b) {
  if (share_published_numbers(a, b)) return true;
  const auto theirs = record_hashes(b.result);
  for (const auto& [hash, path] : record_hashes(a.result))
    if (theirs.contains(hash)) return true;
  return false;
}

bool share_fitted_records(const Compared& a, const Compared& b) {
  if (share_published_numbers(a, b)) return true;
  const auto ours = fitted_conditions(a.result);
  const auto theirs = fitted_conditions(b.result);
  if (ours.empty() || theirs.empty()) return share_records(a, b);
  for (const calib::ConditionResult* one : ours) {
    for (const calib::ConditionResult* other : theirs)
      if (share_file(*one, *other) && overlap(*one, *other)) return true;
  }
  return false;
}

std::vector<StoredComparedRecord> compared_records(const std::vector<Compared>& results) {
  std::vector<std::map<std::string, std::string>> hashes;
  std::set<std::pair<std::string, std::string>> all;  // file and hash
  for (const Compared& compared : results) {
    hashes.push_back(record_hashes(compared.result));
    for (const auto& [hash, file] : hashes.back()) all.emplace(file, hash);
  }
  std::vector<StoredComparedRecord> list;
  std::set<std::string> listed;
  for (const auto& [file, hash] : all) {
    // Files with equal contents are the same record, whatever their names.
    if (!listed.insert(hash).second) continue;
    StoredComparedRecord& record = list.emplace_back(StoredComparedRecord{file, hash, {}});
    for (const auto& each : hashes) record.in.push_back(each.contains(hash));
  }
  return list;
}

}  // namespace rigcal::report
