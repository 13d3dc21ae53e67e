#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/campaign/diagnosis_settings.hpp"
#include "metrics/residual_features.hpp"

namespace rigcal::diagnosis {

/// Features of a record whose class is known.
struct LabelledFeatures {
  std::string signal;
  int repeat = 0;
  datasets::LeakClass leak_class = datasets::LeakClass::normal;
  metrics::ResidualFeatures features;
};

/// The source paper's classification, as far as it is described: one cluster per class in the space
/// of (mean, RMS, standard deviation) of the parity residual's absolute value; a record belongs to
/// the nearest one. The paper does not define the clusters. Assumed here: the centre of a cluster
/// is the mean of its records, and the distance is Euclidean in the residual's unit, without
/// scaling.
class FeatureClusters {
 public:
  explicit FeatureClusters(const std::vector<LabelledFeatures>& training);
  /// Empty where there is no cluster.
  std::optional<datasets::LeakClass> nearest(const metrics::ResidualFeatures& features) const;

 private:
  struct Cluster {
    datasets::LeakClass leak_class = datasets::LeakClass::normal;
    metrics::ResidualFeatures centre;
  };
  std::vector<Cluster> clusters_;
};

/// Class of a record by clusters of its own signal, learned from all repeats except this one.
std::optional<datasets::LeakClass> class_without_repeat(const std::vector<LabelledFeatures>& all,
                                                        const LabelledFeatures& record);

/// Class of a record by clusters learned from the other signals.
std::optional<datasets::LeakClass> class_without_signal(const std::vector<LabelledFeatures>& all,
                                                        const LabelledFeatures& record);

}  // namespace rigcal::diagnosis
