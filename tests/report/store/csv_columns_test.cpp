#include "report/store/csv_columns.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "calib/result/condition_score.hpp"
#include "common/range.hpp"

using namespace rigcal::report;
using rigcal::Range;

namespace {

struct BenchRow {
  std::string name;
  bool driven = false;
  long samples = 0;
  std::optional<rigcal::calib::Verdict> verdict;
  std::optional<Range> ci95;
  std::vector<double> offsets_s;
  std::vector<std::string> warnings;
  const Range* window = nullptr;
  RIGCAL_DESCRIBE(name, driven, samples, verdict, offsets_s, warnings)
};

std::string high_end(const BenchRow& rig) { return csv_field(rig, &BenchRow::ci95, &Range::high); }

}  // namespace

TEST_CASE("csv_field: each kind of value has its text", "[report]") {
  CHECK(csv_field(true) == "1");
  CHECK(csv_field(false) == "0");
  CHECK(csv_field(3L) == "3");
  CHECK(csv_field(0.1) == "0.1");
  CHECK(csv_field(std::numeric_limits<double>::quiet_NaN()).empty());
  CHECK(csv_field(rigcal::calib::Verdict::warn) == "WARN");
  CHECK(csv_field("a,b") == "\"a,b\"");
  CHECK(csv_field(std::string("=A1")) == "'=A1");
  CHECK(csv_field(std::vector<double>{-0.5, 2.0}) == "-0.5 2");
  CHECK(csv_field(rigcal::Later<std::vector<double>>{2.0}) == "2");
  CHECK(csv_field(std::vector<std::string>{"one", "two, three"}) == "\"one; two, three\"");
}

TEST_CASE("csv_field: an absent value, or one behind an absent one, is an empty field",
          "[report]") {
  CHECK(csv_field(std::optional<double>()).empty());
  CHECK(csv_field(std::optional(2.5)) == "2.5");
  BenchRow rig;
  CHECK(high_end(rig).empty());
  rig.ci95 = Range{1.0, 4.0};
  CHECK(high_end(rig) == "4");
  CHECK(csv_field(rig, &BenchRow::window, &Range::low).empty());
  rig.name = "abc";
  CHECK(csv_field(rig, &BenchRow::name, &std::string::size) == "3");
  rig.window = &*rig.ci95;
  CHECK(csv_field(rig, &BenchRow::window, &Range::low) == "1");
}

TEST_CASE("csv columns: members by their keys, others by their headings", "[report]") {
  CsvColumns<BenchRow> columns;
  columns.members(&BenchRow::samples, &BenchRow::name)
      .add("ci95_low", &BenchRow::ci95, &Range::low)
      .members(&BenchRow::driven, &BenchRow::verdict)
      .add("mass[a, b]", [](const BenchRow& rig) { return rig.warnings.size(); });
  CHECK(columns.table({}) == "samples,name,ci95_low,driven,verdict,\"mass[a, b]\"\n");
  BenchRow rig;
  rig.name = "-x";
  rig.samples = 7;
  rig.warnings = {"one"};
  BenchRow other = rig;
  other.ci95 = Range{0.25, 1.0};
  other.driven = true;
  other.verdict = rigcal::calib::Verdict::pass;
  CHECK(columns.table({rig, other}).ends_with("\n7,'-x,,0,,1\n7,'-x,0.25,1,PASS,1\n"));
}
