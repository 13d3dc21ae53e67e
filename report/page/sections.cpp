#include <algorithm>

#include "report/json/read_json.hpp"
#include "report/page/calibration/page_calibration.hpp"
#include "report/page/page_overlay.hpp"
#include "report/page/section.hpp"
#include "report/store/result_files.hpp"

namespace rigcal::report {
namespace {

StoredBatch load_batch(const ReadFile& read, const std::string& where) {
  return load<StoredBatch>(read, where, "batch.json");
}

}  // namespace

std::optional<LiveSection> live_of(const StoredProvenance& provenance, const ResultFolder& folder,
                                   const std::string& file) {
  if (!provenance.files) return std::nullopt;
  const auto named =
      std::find_if(provenance.files->begin(), provenance.files->end(),
                   [](const InputFile& each) { return each.path.ends_with(kLiveFile); });
  if (named == provenance.files->end()) return std::nullopt;
  const auto rig = files_of_run(folder.read, provenance, folder.where, file)(named->path);
  if (!rig) return std::nullopt;
  if (const auto json = made<Json>(rig)) return live_section(*json);
  return live_section(parse_json(rig->content, folder.where + "/" + named->path));
}

const std::vector<Section>& sections() {
  static const std::vector<Section> rows{
      {"calibration", {"fit.json", "validation.json"}, calibration_part, calibration_figures},
      section({"leak_table.json", "leak_table", "leak-table", "Leak table"}, load_leak_table,
              leak_table_headline, leak_table_sections, leak_table_figures),
      section({"diagnosis.json", "diagnosis", "diagnosis", "Diagnosis"}, load_diagnosis,
              diagnosis_headline, diagnosis_sections, diagnosis_figures),
      section({"parity.json", "parity", "parity", "Parity residual"}, load_parity, parity_headline,
              parity_sections, parity_figures),
      section({"comparison.json", "comparison", "results", "Comparison"}, load_comparison_files,
              comparison_headline, comparison_sections, comparison_figures, add_comparison),
      section({"batch.json", "batch", "rigs", "Batch"}, load_batch, batch_headline, batch_sections,
              batch_figures, add_batch),
      section({"average.json", "average", "repeatability", "Repeatability"}, load_average,
              average_headline, average_sections, average_figures),
      section({"plan.json", "plan", "plan", "Plan"}, load_plan, plan_headline, plan_sections,
              plan_figures),
  };
  return rows;
}

}  // namespace rigcal::report
