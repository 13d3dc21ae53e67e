#include "report/comparison/comparison_curves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>

#include "common/error.hpp"
#include "datasets/campaign/condition_id.hpp"
#include "datasets/record.hpp"
#include "report/comparison/comparison_parts.hpp"
#include "report/figure/decimate.hpp"
#include "report/store/stored.hpp"

namespace rigcal::report {
namespace {

constexpr std::size_t kCurvePoints = 800;
constexpr double kShownPeriods = 2.0;

std::vector<double> read_between(const std::vector<double>& time_s,
                                 const std::vector<double>& values,
                                 const std::vector<double>& at_s) {
  if (time_s == at_s) return values;
  std::vector<double> result;
  for (const double t : at_s) {
    const auto after = std::lower_bound(time_s.begin(), time_s.end(), t);
    const auto i = static_cast<std::size_t>(after - time_s.begin());
    if (after == time_s.end() || (i == 0 && *after != t)) {
      result.push_back(std::numeric_limits<double>::quiet_NaN());
    } else if (*after == t) {
      result.push_back(values[i]);
    } else {
      const double share = (t - time_s[i - 1]) / (time_s[i] - time_s[i - 1]);
      result.push_back(values[i - 1] + share * (values[i] - values[i - 1]));
    }
  }
  return result;
}

std::size_t first_shown_sample(const std::vector<double>& time_s, double frequency_hz) {
  if (!(frequency_hz > 0.0)) return 0;
  const double from = time_s.back() - kShownPeriods / frequency_hz;
  return static_cast<std::size_t>(std::lower_bound(time_s.begin(), time_s.end(), from) -
                                  time_s.begin());
}

/// Returns the indices of the minimum and maximum in each bucket, in time order.
std::vector<std::size_t> extreme_samples(std::span<const double> values, std::size_t begin) {
  const std::span<const double> part = values.subspan(begin);
  const Buckets thin = buckets(part.size(), kCurvePoints);
  std::vector<std::size_t> samples;
  for (std::size_t from = 0; from < part.size(); from += thin.size) {
    const auto bucket = part.subspan(from, std::min(thin.size, part.size() - from));
    const auto [least, largest] = std::minmax_element(bucket.begin(), bucket.end());
    const auto a = static_cast<std::size_t>(least - bucket.begin());
    const auto b = static_cast<std::size_t>(largest - bucket.begin());
    samples.push_back(begin + from + std::min(a, b));
    if (a != b) samples.push_back(begin + from + std::max(a, b));
  }
  return samples;
}

std::string curve_column(const char* what, std::string_view name) {
  return fmt::format("{}_{}", what, name);
}

}  // namespace

Table overlaid(const std::vector<ConditionSeries>& results, double frequency_hz) {
  Table table;
  if (results.empty()) return table;
  const Table& first = results.front().series;
  const auto* time_s = first.find("time_s");
  if (time_s == nullptr || time_s->empty()) return table;
  std::vector<std::size_t> samples;
  const auto add = [&](std::string name, const std::vector<double>& values) {
    table.add(std::move(name), samples.size(), [&](std::size_t i) { return values[samples[i]]; });
  };
  for (const datasets::ChannelInfo& about : datasets::channel_table()) {
    const auto* measured = first.find(curve_column("measured", about.name));
    if (measured == nullptr) continue;
    if (samples.empty()) {  // The times of the first channel are used for all channels.
      samples = extreme_samples(*measured, first_shown_sample(*time_s, frequency_hz));
      add("time_s", *time_s);
    }
    add(curve_column("measured", about.name), *measured);
    for (const ConditionSeries& result : results) {
      const auto* times = result.series.find("time_s");
      const auto* simulated = result.series.find(curve_column("simulated", about.name));
      if (times == nullptr || simulated == nullptr || times->empty()) continue;
      add(fmt::format("simulated_{}_{}", about.name, result.result + 1),
          read_between(*times, *simulated, *time_s));
    }
  }
  return table;
}

namespace {

std::vector<std::string> checked_ids(const std::vector<Compared>& results) {
  std::vector<std::string> ids;
  for (const Compared& compared : results) {
    for (const calib::ConditionResult& condition : compared.result.conditions) {
      const std::string& id = condition.id;
      if (!datasets::is_condition_id(id))
        throw InputError({compared.file.string()},
                         fmt::format("key 'id' of a condition: found \"{}\", expected {}",
                                     id.substr(0, 40), datasets::condition_id_rule()));
      if (std::find(ids.begin(), ids.end(), id) == ids.end()) ids.push_back(id);
    }
  }
  return ids;
}

}  // namespace

std::vector<ResultFile> comparison_curves(const std::vector<Compared>& results) {
  std::vector<ResultFile> files;
  for (const std::string& id : checked_ids(results)) {
    std::vector<ConditionSeries> found;
    double frequency_hz = 0.0;
    for (std::size_t k = 0; k < results.size(); ++k) {
      const calib::ConditionResult* condition = results[k].result.find(id);
      if (condition == nullptr || condition->failure) continue;
      const std::filesystem::path folder = results[k].file.parent_path();
      const auto series = table_in(files_in(folder), folder.string(), "residuals/" + id + ".csv");
      if (!series) continue;
      found.push_back({k, *series});
      frequency_hz = periodic_frequency(*condition).value_or(0.0);
    }
    if (found.size() < 2) continue;
    Table table = overlaid(found, frequency_hz);
    if (!table.names.empty())
      files.push_back(table_file("overlay/" + id + ".csv", std::move(table)));
  }
  return files;
}

}  // namespace rigcal::report
