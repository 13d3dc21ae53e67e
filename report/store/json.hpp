#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"
#include "report/store/result.hpp"
#include "report/store/validity.hpp"

namespace rigcal::report {

/// Keeps keys in the order of insertion.
using Json = nlohmann::ordered_json;

/// Writes the text of a JSON file, indented by two spaces, with a final newline. Numbers round-trip
/// exactly. Bytes that are not valid UTF-8 are replaced.
std::string json_text(const Json& json);
std::string json_line(const Json& json);

/// Returns the parameter table of a plant as JSON.
Json parameters_json(model::PlantKind plant);

struct StoredFit;

/// Data from an earlier fit, for `validate`.
struct EarlierFit {
  calib::FitStatus status = calib::FitStatus::failed;
  std::optional<calib::Verdict> verdict;
  std::string message;
  std::vector<datasets::FittedValue> values;  ///< fitted parameters, nuisance parameters excluded
  std::vector<datasets::FittedValue> known;   ///< known parameters with scope rig
  std::vector<std::pair<std::string, datasets::Use>> conditions;  ///< id and use
  std::vector<std::string> input_hashes;                          ///< SHA-256
  /// Judgements by the fit; each is `not_assessed` if its file contains none.
  calib::Aspect adequacy;
  calib::Aspect parameters;
  calib::Validity validity;
  std::optional<calib::Validity> validated;  ///< ranges of the validation
  std::optional<calib::EstimateCovariance>
      joint;                 ///< covariance of `values`; absent without convergence
  std::vector<int> indices;  ///< table rows of the fitted values with scope rig
  /// Covariance of the values in `indices`, SI, shape (indices)^2; from the larger of standard and
  /// robust error, and the correlations.
  Eigen::MatrixXd covariance;
};

/// Reads a fit.json strictly.
///
/// @throws InputError  if the file is not JSON, is not a fit.json, or contains a fit that failed;
///                     names the file, the line and column or the key, and the expected content
EarlierFit read_fit(const std::filesystem::path& file, model::PlantKind plant);

/// Takes what `validate` needs from a fit, as it is read from its file (as_read_back()).
///
/// @param name  file name for messages
/// @throws InputError  if it is a validation or a fit that failed, or its parameters or their
///                     correlations are impossible
EarlierFit earlier_fit(const StoredFit& fit, const std::string& name, model::PlantKind plant);

/// Reads the parameter values from a truth.json, which `synthesize` writes.
///
/// @throws InputError  if the file is not JSON or not a truth.json
std::vector<datasets::FittedValue> read_truth(const std::filesystem::path& file,
                                              model::PlantKind plant);

}  // namespace rigcal::report
