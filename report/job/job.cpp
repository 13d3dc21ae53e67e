#include "report/job/job.hpp"

namespace rigcal::report {

EarlierFit FitSource::read(model::PlantKind plant) const {
  return made ? *made : read_fit(file, plant);
}

std::string FitSource::name() const { return made ? "fit" : file.string(); }

std::vector<std::filesystem::path> FitSource::inputs() const {
  if (file.empty()) return {};
  return {file};
}

}  // namespace rigcal::report
