#include <catch2/catch.hpp>

#include "common/error.hpp"
#include "report/store/json.hpp"
#include "tests/report/stored_fixture.hpp"

using Catch::Contains;
using namespace rigcal::report;

namespace {

/// A fit of mass and damping with these correlations.
Json fit_of(const Json& matrix) {
  Json fit = rigcal::test::stored_result();
  Json damping = fit["parameters"][0];
  damping["name"] = "damping_n_s_per_m";
  damping["key"] = "damping";
  fit["parameters"].push_back(damping);
  fit["correlation"] = {{"names", {"mass_kg", "damping_n_s_per_m"}}, {"matrix", matrix}};
  return fit;
}

}  // namespace

TEST_CASE("read_fit: correlations are some that can be", "[report]") {
  const auto read = [](const Json& matrix) {
    return earlier_fit(fit_of(matrix), "fit.json", rigcal::model::PlantKind::load_pressure);
  };
  const EarlierFit whole = read({{1.0, -0.5}, {-0.5, 1.0}});
  REQUIRE(whole.covariance.rows() == 2);
  CHECK_THAT(whole.covariance(0, 1), Catch::WithinRel(-0.5 * whole.covariance(0, 0), 1e-12));
  CHECK_NOTHROW(read({{1.0, 1.0}, {1.0, 1.0}}));
  for (const Json& matrix : std::vector<Json>{{{1.0, 1.5}, {1.5, 1.0}},
                                              {{1.0, 4.57e99}, {4.57e99, 1.0}},
                                              {{1.0, 0.5}, {-0.5, 1.0}},
                                              {{2.0, 0.5}, {0.5, 1.0}},
                                              {{1.0, 0.5}},
                                              {{1.0}, {0.5}}}) {
    CAPTURE(matrix.dump());
    CHECK_THROWS_WITH(read(matrix), Contains("fit.json") && Contains("correlation.matrix"));
  }
}
