#include "diagnosis/feature_clusters.hpp"

#include <catch2/catch.hpp>

using namespace rigcal::diagnosis;
namespace metrics = rigcal::metrics;
using rigcal::datasets::LeakClass;

namespace {

std::vector<LabelledFeatures> two_signals() {
  return {{"slow", 1, LeakClass::normal, {0.1, 0.1, 0.0}},
          {"slow", 2, LeakClass::normal, {0.2, 0.2, 0.0}},
          {"slow", 1, LeakClass::slight, {1.0, 1.1, 0.4}},
          {"slow", 2, LeakClass::slight, {1.1, 1.2, 0.4}},
          {"fast", 1, LeakClass::normal, {0.9, 1.0, 0.4}},
          {"fast", 2, LeakClass::slight, {9.0, 10.0, 4.0}}};
}

}  // namespace

TEST_CASE("FeatureClusters: the nearest mean", "[diagnosis]") {
  const FeatureClusters clusters(two_signals());
  CHECK(clusters.nearest({0.0, 0.0, 0.0}) == LeakClass::normal);
  CHECK(clusters.nearest({20.0, 20.0, 9.0}) == LeakClass::slight);
  CHECK_FALSE(FeatureClusters({}).nearest({0.0, 0.0, 0.0}));
}

TEST_CASE("FeatureClusters: each of the three features tells", "[diagnosis]") {
  const metrics::ResidualFeatures origin{1.0, 1.0, 1.0};
  for (double metrics::ResidualFeatures::*feature :
       {&metrics::ResidualFeatures::mean, &metrics::ResidualFeatures::rms,
        &metrics::ResidualFeatures::std}) {
    metrics::ResidualFeatures away = origin;
    away.*feature = 3.0;
    const FeatureClusters clusters(
        {{"s", 1, LeakClass::normal, origin}, {"s", 1, LeakClass::critical, away}});
    metrics::ResidualFeatures near = origin;
    near.*feature = 2.1;
    CHECK(clusters.nearest(near) == LeakClass::critical);
    near.*feature = 1.9;
    CHECK(clusters.nearest(near) == LeakClass::normal);
  }
}

TEST_CASE("class_without_repeat: own signal, other repeats", "[diagnosis]") {
  const auto all = two_signals();
  CHECK(class_without_repeat(all, all[0]) == LeakClass::normal);
  CHECK(class_without_repeat(all, all[3]) == LeakClass::slight);
  // Only the slight repeat of this signal is left.
  CHECK(class_without_repeat(all, all[4]) == LeakClass::slight);
}

TEST_CASE("class_without_signal: features of another signal mislead", "[diagnosis]") {
  const auto all = two_signals();
  CHECK(class_without_signal(all, all[4]) == LeakClass::slight);
  CHECK(class_without_signal(all, all[2]) == LeakClass::normal);
}
