#include "diagnosis/class_limits.hpp"

#include <catch2/catch.hpp>

using namespace rigcal;
using namespace rigcal::diagnosis;
using Catch::Contains;
using datasets::LeakClass;

namespace {

std::array<double, 4> limits_by(const std::vector<double>& targets_percent) {
  datasets::DiagnosisSettings settings;
  take_limits(settings, targets_percent, "leak_table.json");
  return settings.limits;
}

}  // namespace

TEST_CASE("take_limits: rows are the upper limits of slight, medium and critical", "[diagnosis]") {
  CHECK(limits_by({8.0, 18.0, 28.0}) == std::array{0.01, 0.08, 0.18, 0.28});
  CHECK(limits_by({10.0, 20.0, 30.0, 50.0}) == std::array{0.01, 0.10, 0.20, 0.30});
  CHECK(limits_by({2.0, 8.0, 18.0, 28.0, 50.0}) == std::array{0.02, 0.08, 0.18, 0.28});
  CHECK_THROWS_WITH(limits_by({10.0, 20.0}), Contains("2 rows"));
  CHECK_THROWS_WITH(limits_by({1.0, 2.0, 3.0, 4.0, 5.0, 6.0}), Contains("6 rows"));
  // If the first of four rows were the limit of normal, all classes would shift by one.
  CHECK_THROWS_WITH(limits_by({1.0, 10.0, 20.0, 30.0}), Contains("normal ends at 1 %"));
}

TEST_CASE("class_limits: the rows of a leak table by signal, with the class that they end",
          "[diagnosis]") {
  datasets::Campaign campaign;
  take_limits(campaign.diagnosis, {7.0, 20.0, 29.0, 50.0}, "leak_table.json");
  std::vector<diagnosis::LeakEntry> entries;
  for (const double target_percent : {7.0, 29.0, 50.0}) {
    diagnosis::LeakEntry& entry = entries.emplace_back();
    entry.drive = diagnosis::LeakDrive{datasets::Waveform::sine, 0.1, 0.05, {}};
    entry.target_percent = target_percent;
    entry.coefficients = {0.1, 0.2};
    entry.coefficients_ci95 = {std::nullopt, Range{0.19, 0.21}};
  }
  const std::vector<ClassLimit> limits = class_limits(campaign, entries);
  REQUIRE(limits.size() == 3);
  CHECK(limits[0].signal == "sine 0.1 Hz, 50 mm");
  CHECK(limits[0].share_percent == 7.0);
  CHECK(limits[0].class_ == LeakClass::slight);
  CHECK(limits[0].coefficients == std::vector{0.1, 0.2});
  CHECK(limits[0].coefficients_ci95[1] == Range{0.19, 0.21});
  CHECK(limits[1].class_ == LeakClass::critical);
  CHECK_FALSE(limits[2].class_.has_value());
}

TEST_CASE("stated: settings in percent, the law only if it is laminar", "[diagnosis]") {
  datasets::DiagnosisSettings settings;
  CHECK_FALSE(stated(settings).leak_law);
  CHECK_FALSE(stated(settings).is_laminar());
  REQUIRE(stated(settings).limits_percent.size() == 4);
  CHECK(stated(settings).limits_percent[1] == std::pair(std::string("slight"), 10.0));
  settings.leak_law = datasets::LeakLaw::laminar;
  CHECK(stated(settings).is_laminar());
}
