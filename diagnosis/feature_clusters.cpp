#include "diagnosis/feature_clusters.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace rigcal::diagnosis {
namespace {

double distance(const metrics::ResidualFeatures& a, const metrics::ResidualFeatures& b) {
  return std::hypot(a.mean - b.mean, a.rms - b.rms, a.std - b.std);
}

template <typename Keep>
std::vector<LabelledFeatures> selected(const std::vector<LabelledFeatures>& all, Keep keep) {
  std::vector<LabelledFeatures> result;
  std::copy_if(all.begin(), all.end(), std::back_inserter(result), keep);
  return result;
}

}  // namespace

FeatureClusters::FeatureClusters(const std::vector<LabelledFeatures>& training) {
  for (const datasets::LeakClass each : datasets::kLeakClasses) {
    Cluster cluster{each, {}};
    double count = 0.0;
    for (const LabelledFeatures& record : training) {
      if (record.leak_class != each) continue;
      count += 1.0;
      cluster.centre.mean += record.features.mean;
      cluster.centre.rms += record.features.rms;
      cluster.centre.std += record.features.std;
    }
    if (count == 0.0) continue;
    cluster.centre.mean /= count;
    cluster.centre.rms /= count;
    cluster.centre.std /= count;
    clusters_.push_back(cluster);
  }
}

std::optional<datasets::LeakClass> FeatureClusters::nearest(
    const metrics::ResidualFeatures& features) const {
  if (clusters_.empty()) return std::nullopt;
  return std::min_element(clusters_.begin(), clusters_.end(),
                          [&](const Cluster& a, const Cluster& b) {
                            return distance(a.centre, features) < distance(b.centre, features);
                          })
      ->leak_class;
}

std::optional<datasets::LeakClass> class_without_repeat(const std::vector<LabelledFeatures>& all,
                                                        const LabelledFeatures& record) {
  return FeatureClusters(selected(all,
                                  [&](const LabelledFeatures& other) {
                                    return other.signal == record.signal &&
                                           other.repeat != record.repeat;
                                  }))
      .nearest(record.features);
}

std::optional<datasets::LeakClass> class_without_signal(const std::vector<LabelledFeatures>& all,
                                                        const LabelledFeatures& record) {
  return FeatureClusters(
             selected(all,
                      [&](const LabelledFeatures& other) { return other.signal != record.signal; }))
      .nearest(record.features);
}

}  // namespace rigcal::diagnosis
