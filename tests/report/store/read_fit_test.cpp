#include <catch2/catch.hpp>
#include <utility>

#include "common/error.hpp"
#include "report/store/json.hpp"
#include "tests/report/stored_fixture.hpp"

using Catch::Contains;
using namespace rigcal::report;

namespace {

/// Returns a fit of mass and damping, and also of the valve gain if the matrix has three rows.
Json fit_of(const Json& matrix) {
  Json fit = rigcal::test::stored_result();
  Json names = Json::array({"mass_kg"});
  for (const auto& [name, key] :
       {std::pair{"damping_n_s_per_m", "damping"}, std::pair{"valve_gain_m_per_v", "valve_gain"}}) {
    if (names.size() == 2 && matrix.size() < 3) break;
    Json more = fit["parameters"][0];
    more["name"] = name;
    more["key"] = key;
    fit["parameters"].push_back(more);
    names.push_back(name);
  }
  fit["correlation"] = {{"names", names}, {"matrix", matrix}};
  return fit;
}

}  // namespace

TEST_CASE("read_fit: correlations are some that can be", "[report]") {
  const auto read = [](const Json& matrix) {
    return earlier_fit(as<StoredFit>(fit_of(matrix), "", "fit.json"), "fit.json",
                       rigcal::model::PlantKind::load_pressure);
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
                                              {{1.0, -0.5, 0.9}, {-0.5, 1.0, 0.9}, {0.9, 0.9, 1.0}},
                                              {{1.0}, {0.5}}}) {
    CAPTURE(matrix.dump());
    CHECK_THROWS_WITH(read(matrix), Contains("fit.json") && Contains("correlation.matrix"));
  }
}

TEST_CASE("read_fit: own values of conditions without correlations have their errors", "[report]") {
  Json fit = fit_of({{1.0, -0.5}, {-0.5, 1.0}});
  for (const char* condition : {"first", "second"}) {
    Json own = fit["parameters"][0];
    own["name"] = "valve_gain_m_per_v";
    own["key"] = "valve_gain";
    own["scope"] = "condition";
    own["level"] = condition;
    own["ci95"] = nullptr;
    own["standard_error"] = std::string(condition) == "first" ? 0.5 : 0.25;
    fit["parameters"].push_back(own);
  }
  const auto spread = earlier_fit(as<StoredFit>(fit, "", "fit.json"), "fit.json",
                                  rigcal::model::PlantKind::load_pressure)
                          .joint.value();
  CHECK(spread.estimates.size() == 2);
  const Eigen::MatrixXd shared = spread.root * spread.root.transpose();
  REQUIRE(spread.own.size() == 2);
  CHECK(spread.own[0].estimates.at(0).level == "first");
  CHECK(spread.own[1].estimates.at(0).level == "second");
  const double widened = shared(0, 0) / (0.026 * 0.026);  // widened to the interval of the mass
  for (std::size_t i = 0; i < 2; ++i) {
    const Eigen::MatrixXd all = spread.own[i].root * spread.own[i].root.transpose();
    REQUIRE(all.rows() == 3);
    const double error = i == 0 ? 0.5 : 0.25;
    CHECK_THAT(all(0, 0), Catch::WithinRel(widened * error * error, 1e-12));
    CHECK(all(0, 1) == 0.0);
    CHECK((all.bottomRightCorner(2, 2) - shared).norm() < 1e-15);
  }
}

TEST_CASE("earlier_fit: the larger error of a value counts, and without one its range",
          "[report]") {
  Json fit = fit_of({{1.0, 0.5}, {0.5, 1.0}});
  fit["parameters"][0]["standard_error"] = 2.0;
  fit["parameters"][0]["robust_standard_error"] = 3.0;
  const auto damping = fit["parameters"].size() - 1;
  fit["parameters"][damping]["standard_error"] = 5.0;
  fit["parameters"][damping]["robust_standard_error"] = 4.0;
  const auto covariance = [&] {
    return earlier_fit(as<StoredFit>(fit, "", "fit.json"), "fit.json",
                       rigcal::model::PlantKind::load_pressure)
        .covariance;
  };
  const Eigen::MatrixXd found = covariance();
  REQUIRE(found.rows() == 2);
  CHECK_THAT(found(0, 0), Catch::WithinRel(9.0, 1e-12));
  CHECK_THAT(found(1, 1), Catch::WithinRel(25.0, 1e-12));
  CHECK_THAT(found(0, 1), Catch::WithinRel(0.5 * 3.0 * 5.0, 1e-12));
  for (const char* error : {"standard_error", "robust_standard_error"})
    fit["parameters"][damping][error] = nullptr;
  fit["parameters"][damping]["ci95"] = nullptr;
  fit["parameters"][damping]["lower"] = 10.0;
  fit["parameters"][damping]["upper"] = 16.0;
  // A uniform distribution of width w has a variance of w^2 / 12.
  CHECK_THAT(covariance()(1, 1), Catch::WithinRel(3.0, 1e-12));
}
