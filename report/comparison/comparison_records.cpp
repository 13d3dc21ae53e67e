#include <filesystem>
#include <set>

#include "report/comparison/comparison_parts.hpp"

namespace rigcal::report {
namespace {

/// Fits to published tables name their numbers; they have no records.
bool share_published_numbers(const Json& a, const Json& b) {
  if (!is_of_tables(a) || !is_of_tables(b)) return false;
  for (const Json& x : a.at("residuals"))
    for (const Json& y : b.at("residuals"))
      if (x.at("of") == y.at("of")) return true;
  return false;
}

}  // namespace

std::map<std::string, std::string> record_hashes(const Json& result) {
  std::map<std::string, std::string> hashes;
  for (const Json& input : result.at("provenance").at("inputs")) {
    const std::filesystem::path path = text_of(input, "path");
    if (path.extension() == ".toml" || path.extension() == ".json") continue;
    hashes.emplace(text_of(input, "sha256"), path.filename().string());
  }
  return hashes;
}

bool share_records(const Json& a, const Json& b) {
  if (share_published_numbers(a, b)) return true;
  const auto theirs = record_hashes(b);
  for (const auto& [hash, path] : record_hashes(a))
    if (theirs.contains(hash)) return true;
  return false;
}

Json compared_records(const std::vector<Compared>& results) {
  std::vector<std::map<std::string, std::string>> hashes;
  std::set<std::pair<std::string, std::string>> all;  // file and hash
  for (const Compared& compared : results) {
    hashes.push_back(record_hashes(compared.result));
    for (const auto& [hash, file] : hashes.back()) all.emplace(file, hash);
  }
  Json list = Json::array();
  std::set<std::string> listed;
  for (const auto& [file, hash] : all) {
    // The same content under another name is the same record.
    if (!listed.insert(hash).second) continue;
    Json in = Json::array();
    for (const auto& each : hashes) in.push_back(each.contains(hash));
    list.push_back({{"file", file}, {"sha256", hash}, {"in", in}});
  }
  return list;
}

}  // namespace rigcal::report
