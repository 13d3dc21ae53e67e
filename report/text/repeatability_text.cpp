#include "report/text/repeatability_text.hpp"

#include <fmt/format.h>

#include <cmath>

#include "datasets/prepare/repeatability.hpp"
#include "report/text/gathered_warnings.hpp"
#include "report/text/readable.hpp"
#include "report/text/text_table.hpp"

namespace rigcal::report {
namespace {

using Align = TextTable::Align;

std::string offset_text(double offset_s) {
  constexpr double kRounding_s = 1e-9;  // records that were made without an offset
  return offset_s < kRounding_s ? "0 ms" : fmt::format("{:.2g} ms", 1e3 * offset_s);
}

void add_rows(const datasets::Record& record, TextTable& table) {
  const double offset_s = datasets::offset_range_s(record);
  for (const datasets::Repeatability& each : datasets::repeatability(record)) {
    const auto& about = info(each.channel);
    if (!about.is_output) continue;  // a command has no measurement error
    const auto& floor = each.noise_floor;
    table.add({record.condition, std::string(about.key), fmt::format("{}", record.time_s.size()),
               fmt::format("{}", each.repeats),
               std::isfinite(each.pooled_sd) ? readable(each.pooled_sd, about.unit, 3) : "unknown",
               floor ? agreement_text(floor->rho2) : "-",
               floor ? fmt::format("{:.3f}", floor->absolute_error_percent) : "-",
               record.repeats > 1 ? offset_text(offset_s) : "-",
               fmt::format("{}", datasets::outliers(record).size())});
  }
}

}  // namespace

std::string repeatability_text(const datasets::Campaign& campaign,
                               const std::vector<datasets::Record>& records, const Style& style) {
  TextTable table({{"condition"},
                   {"channel"},
                   {"samples", Align::right, 1},
                   {"repeats", Align::right},
                   {"sd of one", Align::right},
                   {"floor rho2", Align::right, 2},
                   {"floor error %", Align::right},
                   {"offsets", Align::right},
                   {"outliers", Align::right, 3}});
  std::vector<std::pair<std::string, std::string>> told;
  for (const datasets::Record& record : records) {
    add_rows(record, table);
    for (const std::string& note : record.notes) told.emplace_back(record.condition, note);
    for (const std::string& warning : record.warnings)
      told.emplace_back(record.condition, "warning: " + warning);
  }
  std::string text =
      "How the repeats agree; floor: what the noise of their mean leaves to any model\n" +
      table.text(style.columns);
  for (const std::string& line : gathered_by_text(told)) text += "  " + line + "\n";
  if (campaign.synthetic) text += "note: the records of this campaign are synthetic\n";
  return text;
}

}  // namespace rigcal::report
