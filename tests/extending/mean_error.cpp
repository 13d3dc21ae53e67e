#include <cstdio>
#include <vector>

#include "report/document/render_html.hpp"
#include "report/page/calibration/score_columns.hpp"
#include "report/store/json.hpp"
#include "report/store/stored/stored_fit.hpp"

// Prints the scores of a simulation with a constant error of one, in the format of result files and
// of the page.

int main() {
  const std::vector<double> measured{0.0, 10.0, 20.0, 10.0};
  std::vector<double> simulated = measured;
  for (double& value : simulated) value -= 1.0;
  const rigcal::metrics::Agreement scores = rigcal::metrics::agreement(measured, simulated);
  rigcal::report::Json titles = rigcal::report::Json::array();
  for (const auto& column : rigcal::report::score_columns()) titles.push_back(column.title);
  rigcal::report::Json cells = rigcal::report::Json::array();
  for (const auto& cell : rigcal::report::score_cells(scores, nullptr, "m"))
    cells.push_back(rigcal::report::doc::html(cell.line));
  const rigcal::report::Json json{
      {"scores", rigcal::report::json_of(scores)},
      {"schema", rigcal::report::schema_of<rigcal::metrics::Agreement>()},
      {"titles", titles},
      {"cells", cells}};
  std::fputs(rigcal::report::json_text(json).c_str(), stdout);
}
