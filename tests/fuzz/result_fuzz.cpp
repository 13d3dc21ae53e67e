#include <optional>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "report/comparison/comparison.hpp"
#include "report/document/render_terminal.hpp"
#include "report/json/read_json.hpp"
#include "report/leak/read_leak_table.hpp"
#include "report/page/page.hpp"
#include "report/page/page_parts.hpp"
#include "report/page/section.hpp"
#include "report/store/json.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tests/report/stored_fixture.hpp"
#ifdef RIGCAL_LIBFUZZER
#include "tests/fuzz/json_mutator.hpp"
#endif

using namespace rigcal;
using namespace rigcal::report;

namespace {

/// Runs `attempt`, which may succeed or reject its input.
template <typename Attempt>
void read_or_refuse(Attempt attempt) {
  try {
    attempt();
  } catch (const InputError&) {
  }
}

/// A fit with residual tests, so that the page draws their curves.
std::string tested_fit() {
  auto fit = test::stored_result();
  fit["conditions"][0]["residual_tests"]["position"] = json_of(metrics::ResidualTests());
  return fit.dump();
}

}  // namespace

/// Passes the input as fit.json, as another JSON result and as a table to every reader. Each either
/// reads or rejects it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(fuzz::text_of_bytes(data, size));
  const auto file = fuzz::scratch_file("fit.json", text);
  for (const model::PlantKind plant :
       {model::PlantKind::load_pressure, model::PlantKind::two_chamber}) {
    read_or_refuse([&] { read_fit(file, plant); });
    read_or_refuse([&] { read_truth(file, plant); });
    read_or_refuse([&] { read_leak_table(file, plant); });
  }
  std::vector<std::string> kinds{"residual_tests.json"};
  for (const Section& section : sections())
    kinds.insert(kinds.end(), section.files.begin(), section.files.end());
  kinds.emplace_back("residuals/sine.csv");
  for (const std::string& kind : kinds) {
    const auto read = [&](const std::filesystem::path& path) -> std::optional<std::string> {
      if (path == kind) return text;
      // The other files of the result are undamaged.
      const bool of_fit = kind == "residual_tests.json" || kind == "residuals/sine.csv";
      if (path == "fit.json" && of_fit) return tested_fit();
      if (path == "residual_tests.json" &&
          (kind == "fit.json" || kind == "validation.json" || of_fit))
        return test::kNoCurves;
      if (path.extension() == ".csv") return "time_s,position_residual_m\n0,1\n";
      return std::nullopt;
    };
    read_or_refuse([&] { result_page(test::reading(read), "folder", 1); });
  }
  read_or_refuse([&] {
    const auto results = load_compared({fuzz::scratch_folder(), fuzz::scratch_folder()});
    const StoredComparison comparison = compared(results, {});
    doc::render_terminal({comparison_headline(comparison), {}, comparison_sections(comparison)},
                         {});
  });
  return 0;
}

#ifdef RIGCAL_LIBFUZZER
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most_bytes, unsigned seed) {
  return fuzz::mutate_json_text(data, size, most_bytes, seed);
}
#endif
