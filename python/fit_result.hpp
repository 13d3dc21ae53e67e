#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "calib/fit.hpp"
#include "datasets/record.hpp"
#include "python/campaign.hpp"
#include "report/job/job.hpp"
#include "report/store/provenance.hpp"
#include "report/store/result.hpp"

namespace rigcal::python {

/// A fit or validation, with its campaign as the Python object.
struct FitResult : report::FitRun {
  CampaignPtr source;
};
using FitResultPtr = std::shared_ptr<FitResult>;

/// The fit that a call is based on: a fit in memory, or the path of a fit.json.
using FitArgument = std::variant<FitResultPtr, std::filesystem::path>;

/// @throws pybind11::value_error  if the path is empty
report::FitSource fit_source(const std::optional<FitArgument>& fit, model::PlantKind plant);

/// Formats the argument as text, for the call recorded in a result.
std::string written_fit(const FitArgument& fit);

/// A scored condition, which keeps its result alive.
struct ScoredCondition {
  std::shared_ptr<const calib::ConditionScore> score;
};

}  // namespace rigcal::python
