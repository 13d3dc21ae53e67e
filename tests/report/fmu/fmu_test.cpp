#include "report/fmu/fmu.hpp"

#include <catch2/catch.hpp>

#include "report/fmu/built_in.hpp"
#include "report/fmu/zip.hpp"
#include "tests/model/rig.hpp"

using namespace rigcal;

TEST_CASE("fmu: an identifier is one of C", "[report]") {
  CHECK(report::fmu_identifier("shake table") == "shake_table");
  CHECK(report::fmu_identifier("Bench 4 (synthetic)") == "Bench_4_synthetic");
  CHECK(report::fmu_identifier("4th rig") == "rig4th_rig");
  CHECK(report::fmu_identifier("\xc3\xa4") == "rig");
}

TEST_CASE("fmu: names cannot end an element of the description", "[report]") {
  report::FmuRequest request;
  request.rig.values = model::paper_rig();
  request.name = "a \"rig\" <b> & 'c'";
  request.identifier = "rig";
  request.origin = {{"rig", request.name}};
  std::string description;
  for (const report::FmuFile& file : report::fmu_files(request)) {
    if (file.path == "modelDescription.xml") description = file.content;
    if (file.path.ends_with(".html"))
      CHECK_THAT(file.content, Catch::Contains("a &quot;rig&quot; &lt;b&gt; &amp; &#39;c&#39;"));
  }
  CHECK_THAT(description,
             Catch::Contains("modelName=\"a &quot;rig&quot; &lt;b&gt; &amp; &#39;c&#39;\""));
}

TEST_CASE("fmu: the library is one, and every source is there once", "[report]") {
  CHECK(report::fmu_library().substr(1, 3) == "ELF");
  CHECK(report::fmu_sources().count("model/plant/load_pressure.hpp") == 1);
  CHECK(report::fmu_sources().count("Eigen/Core") == 1);
}

TEST_CASE("zip: the same files give the same bytes", "[report]") {
  const std::vector<report::FmuFile> files{{"a/b.txt", std::string(10'000, 'x')}, {"c", ""}};
  const std::string archive = report::zipped(files);
  CHECK(archive.substr(0, 2) == "PK");
  CHECK(archive.size() < 1000);
  CHECK(report::zipped(files) == archive);
}
