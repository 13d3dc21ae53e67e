#include "calib/design/evolution.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace rigcal::calib {
namespace {

constexpr auto kNeverStopped = [] { return false; };

}  // namespace

TEST_CASE("evolution: finds the top of a narrow ridge, within its evaluations", "[calib]") {
  // A quadratic whose axes differ by a factor of 30 and are oblique to the coordinates.
  const Eigen::Vector3d top(0.3, 0.65, 0.9);
  int made = 0;
  const auto scores = [&](const std::vector<Eigen::VectorXd>& points) {
    std::vector<double> found;
    for (const Eigen::VectorXd& x : points) {
      ++made;
      const Eigen::Vector3d d = x - top;
      found.push_back(-(d(0) + d(1)) * (d(0) + d(1)) - 900.0 * (d(0) - d(1)) * (d(0) - d(1)) -
                      d(2) * d(2));
    }
    return found;
  };
  auto stream = datasets::random_stream(1, {"evolution"});
  const Evolved found = maximise_in_box(3, 600, stream, scores, kNeverStopped);
  CHECK(found.evaluations == 600);
  CHECK(made == 600);
  CHECK((found.point - top).norm() < 5e-3);
}

TEST_CASE("evolution: never leaves the box, and needs no score everywhere", "[calib]") {
  const auto scores = [&](const std::vector<Eigen::VectorXd>& points) {
    std::vector<double> found;
    for (const Eigen::VectorXd& x : points) {
      REQUIRE(x.minCoeff() >= 0.0);
      REQUIRE(x.maxCoeff() <= 1.0);
      found.push_back(x(0) > 0.5 ? x.sum() : -std::numeric_limits<double>::infinity());
    }
    return found;
  };
  auto stream = datasets::random_stream(1, {"evolution"});
  const Evolved found = maximise_in_box(4, 400, stream, scores, kNeverStopped);
  CHECK(found.score > 3.95);
  CHECK(found.score == found.point.sum());
}

TEST_CASE("evolution: without any score there is no point, and a flag ends it", "[calib]") {
  const auto none = [](const std::vector<Eigen::VectorXd>& points) {
    return std::vector<double>(points.size(), -std::numeric_limits<double>::infinity());
  };
  auto stream = datasets::random_stream(1, {"evolution"});
  const Evolved found = maximise_in_box(2, 50, stream, none, kNeverStopped);
  CHECK(found.point.size() == 0);
  CHECK(found.evaluations == 50);
  int asked = 0;
  const Evolved ended = maximise_in_box(2, 500, stream, none, [&] { return ++asked > 3; });
  CHECK(ended.evaluations < 100);
}

}  // namespace rigcal::calib
