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

/// Keeps the order in which keys are put in.
using Json = nlohmann::ordered_json;

/// Text of a JSON file: two blanks of indentation, final newline, numbers that read back to the
/// same bits. Bytes that are not UTF-8 are replaced.
std::string json_text(const Json& json);
/// The same on one line.
std::string json_line(const Json& json);

/// The parameter table of a plant.
Json parameters_json(model::PlantKind plant);

/// Data of an earlier fit for `validate`.
struct EarlierFit {
  calib::FitStatus status = calib::FitStatus::failed;
  std::optional<calib::Verdict> verdict;
  std::string message;
  std::vector<datasets::FittedValue> values;  ///< fitted parameters, without nuisance
  std::vector<datasets::FittedValue> known;   ///< the others, scope rig
  std::vector<std::pair<std::string, datasets::Use>> conditions;  ///< id and use of each scored
  std::vector<std::string> input_hashes;                          ///< SHA-256
  /// As the fit judged them; not assessed if its file says nothing.
  calib::Aspect adequacy;
  calib::Aspect parameters;
  calib::Validity validity;
  std::optional<calib::Validity> validated;     ///< ranges of the validation
  std::optional<calib::EstimateSpread> spread;  ///< for `values`; none if the fit did not converge
  std::vector<int> indices;  ///< table rows of the fitted values of scope rig that have an error
  /// Covariance of these, SI, shape (indices)^2: the larger of standard and robust error, and the
  /// correlation.
  Eigen::MatrixXd covariance;
};

/// Reads fit.json strictly.
///
/// @throws InputError  file (and line:column if it is not JSON, or the key if it is no fit.json),
///                     what was found and what was expected; a fit that failed
EarlierFit read_fit(const std::filesystem::path& file, model::PlantKind plant);

/// The same for JSON that is already parsed.
///
/// @param name  for messages
EarlierFit earlier_fit(const Json& json, const std::string& name, model::PlantKind plant);

/// Values of the truth.json that `synthesize` wrote.
///
/// @throws InputError  as read_fit()
std::vector<datasets::FittedValue> read_truth(const std::filesystem::path& file,
                                              model::PlantKind plant);

}  // namespace rigcal::report
