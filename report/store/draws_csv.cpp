#include "report/store/draws_csv.hpp"

#include "report/store/csv_fields.hpp"
#include "report/store/table.hpp"

namespace rigcal::report {

std::string draws_csv(const calib::Posterior& posterior) {
  const auto draws = static_cast<std::size_t>(posterior.draws);
  const std::size_t rows = static_cast<std::size_t>(posterior.chains) * draws;
  Table table;
  table.add("chain", rows, [&](std::size_t i) { return i / draws + 1; });
  table.add("draw", rows, [&](std::size_t i) { return i % draws + 1; });
  for (std::size_t k = 0; k < posterior.names.size(); ++k)
    table.add(csv_text(posterior.names[k]), posterior.values[k]);
  return csv_of(table);
}

}  // namespace rigcal::report
