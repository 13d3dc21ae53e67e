#include "report/store/draws_csv.hpp"

#include <fmt/format.h>

#include <vector>

#include "report/store/csv_fields.hpp"

namespace rigcal::report {

std::string draws_csv(const calib::Posterior& posterior) {
  std::vector<std::string> titles{"chain", "draw"};
  for (const std::string& name : posterior.names) titles.push_back(csv_text(name));
  std::string text = csv_row(titles);
  for (int chain = 0; chain < posterior.chains; ++chain) {
    for (int draw = 0; draw < posterior.draws; ++draw) {
      std::vector<std::string> fields{fmt::format("{}", chain + 1), fmt::format("{}", draw + 1)};
      const auto at = static_cast<std::size_t>(chain * posterior.draws + draw);
      for (const std::vector<double>& values : posterior.values)
        fields.push_back(csv_number(values[at]));
      text += csv_row(fields);
    }
  }
  return text;
}

}  // namespace rigcal::report
