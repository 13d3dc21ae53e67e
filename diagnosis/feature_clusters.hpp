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

/// The classification in the source paper, as far as the paper describes it. Each class has one
/// cluster in the space of the mean, RMS and standard deviation of the parity residual's absolute
/// value, and a record belongs to the nearest cluster. The paper does not define the clusters. It
/// is assumed here that the centre of a cluster is the mean of its records, and that distances are
/// Euclidean, in the unit of the residual and without scaling.
class FeatureClusters {
 public:
  explicit FeatureClusters(const std::vector<LabelledFeatures>& training);
  /// Returns the class of the nearest cluster, or std::nullopt if there are no clusters.
  std::optional<datasets::LeakClass> nearest(const metrics::ResidualFeatures& features) const;

 private:
  struct Cluster {
    datasets::LeakClass leak_class = datasets::LeakClass::normal;
    metrics::ResidualFeatures centre;
  };
  std::vector<Cluster> clusters_;
};

/// Classifies a record using clusters for its own signal, learned from all repeats except this one.
std::optional<datasets::LeakClass> class_without_repeat(const std::vector<LabelledFeatures>& all,
                                                        const LabelledFeatures& record);

/// Classifies a record using clusters learned from the other signals.
std::optional<datasets::LeakClass> class_without_signal(const std::vector<LabelledFeatures>& all,
                                                        const LabelledFeatures& record);

}  // namespace rigcal::diagnosis
