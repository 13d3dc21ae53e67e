#include "report/store/csv.hpp"
#include "report/store/csv_columns.hpp"

namespace rigcal::report {

std::string parameters_csv(calib::FitStatus status, const std::string& message,
                           const std::vector<calib::FittedParameter>& parameters) {
  using P = calib::FittedParameter;
  using calib::Budget95;
  const auto contribution = [](const char* kind) {
    return [kind](const Budget95& budget) { return budget.contribution(kind); };
  };
  const auto beside = [](const char* kind) {
    return [kind](const Budget95& budget) { return budget.beside_of(kind); };
  };
  CsvColumns<P> columns;
  columns
      .members(&P::name, &P::key, &P::symbol, &P::unit, &P::scope, &P::level, &P::fitted,
               &P::nuisance, &P::start, &P::lower, &P::upper, &P::value, &P::standard_error,
               &P::robust_standard_error)
      .add("ci95_low", &P::ci95, &Range::low)
      .add("ci95_high", &P::ci95, &Range::high)
      .members(&P::at_bound, &P::identifiability, &P::reason)
      .add("ci95_if_exact_low", &P::ci95_if_exact, &Range::low)
      .add("ci95_if_exact_high", &P::ci95_if_exact, &Range::high)
      .add("u_records", &P::budget, contribution("records"))
      .add("u_known_values", &P::budget, contribution("known_value"))
      .add("u_effects", &P::budget, contribution("effect"))
      .add("u_combined", &P::budget, &Budget95::combined)
      .add("u_degrees_of_freedom", &P::budget, &Budget95::degrees_of_freedom)
      .add("coverage_factor", &P::budget, &Budget95::coverage_factor)
      .add("shift", &P::budget, &Budget95::shift)
      .add("u_days", &P::budget, beside("days"))
      .add("u_numerics", &P::budget, beside("numerics"));
  std::string text;
  if (status != calib::FitStatus::converged) text = csv_status(to_string(status), {message});
  return text + columns.table(parameters);
}

}  // namespace rigcal::report
