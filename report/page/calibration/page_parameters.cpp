#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "calib/trust/collinearity.hpp"
#include "common/significant.hpp"
#include "report/page/page_parts.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

Range bounds_of(const StoredParameter& p) {
  return {p.lower.value_or(kAnywhere.low), p.upper.value_or(kAnywhere.high)};
}

/// The 95 % interval of one of the errors alone, as if it were known exactly.
Json interval_by(const StoredParameter& p, const std::optional<double>& error,
                 const RowUnit& unit) {
  constexpr double kNormalQuantile = 1.96;
  std::optional<Range> range;
  if (p.value && error)
    range = {*p.value - kNormalQuantile * *error, *p.value + kNormalQuantile * *error};
  return shown_estimate(p.value, range, unit.si, bounds_of(p)).at("interval");
}

/// @param judged  whether the search came to its end
Json grade(const StoredParameter& p, bool judged) {
  using calib::Identifiability;
  if (!judged) return {{"word", "not judged"}, {"mark", "○"}, {"class", "none"}};
  if (!p.identifiability) return {{"word", ""}, {"mark", "✓"}, {"class", "good"}};
  std::string word;
  switch (*p.identifiability) {
    case Identifiability::not_identifiable:
      word = "not identifiable";
      break;
    case Identifiability::bounded:
      return {{"word", "bounded: not different from zero"}, {"mark", "!"}, {"class", "warn"}};
    case Identifiability::weak:
    case Identifiability::identified:
      word = to_string(*p.identifiability);
  }
  if (p.at_bound) word += ", at a bound";
  if (p.identifiability == Identifiability::not_identifiable)
    return {{"word", word}, {"mark", "✕"}, {"class", "bad"}};
  const bool doubtful = p.at_bound || p.identifiability == Identifiability::weak;
  return {{"word", word}, {"mark", doubtful ? "!" : "✓"}, {"class", doubtful ? "warn" : "good"}};
}

Json shown_error(const StoredParameter& p, const std::optional<double>& error,
                 const RowUnit& unit) {
  Json view = shown_in(error, unit.si, kErrorDigits);
  view["interval"] = interval_by(p, error, unit);
  return view;
}

Json fitted_row(const StoredParameter& p, bool judged) {
  const RowUnit unit = unit_of(p);
  const Json estimate = shown_estimate(p.value, p.ci95, unit.si, bounds_of(p));
  Json row;
  row["name"] = p.key;
  row["symbol"] = p.symbol;
  row["whose"] = p.level.value_or("rig");
  row["nuisance"] = p.nuisance;
  row["value"] = estimate.at("value");
  row["unit"] = unit.name;
  row["interval"] = estimate.at("interval");
  const double half_width = relative_half_width(p);
  row["half_width"] = std::isinf(half_width) ? std::string() : half_width_text(half_width);
  row["standard_error"] = shown_error(p, p.standard_error, unit);
  row["robust_standard_error"] = shown_error(p, p.robust_standard_error, unit);
  row["start"] = shown_in(p.start, unit.si, 5);
  row["lower"] = shown_in(p.lower, unit.si, 4);
  row["upper"] = shown_in(p.upper, unit.si, 4);
  row["grade"] = grade(p, judged);
  row["reason"] = p.reason;
  row["has_reason"] = !p.reason.empty();
  return row;
}

Json known_row(const StoredParameter& p) {
  const RowUnit unit = unit_of(p);
  return {{"name", p.key},
          {"symbol", p.symbol},
          {"whose", p.level.value_or("rig")},
          {"value", shown_in(p.value, unit.si, 6)},
          {"unit", unit.name},
          {"reason", p.reason}};
}

/// Correlation of two estimates; NaN where it is not known.
double at(const StoredCorrelation& correlation, std::size_t i, std::size_t j) {
  const auto& matrix = correlation.matrix;
  return i < matrix.size() && j < matrix[i].size() ? matrix[i][j] : std::nan("");
}

Json correlation_rows(const StoredCorrelation& correlation) {
  const std::vector<std::string>& names = correlation.names;
  Json rows = Json::array();
  for (std::size_t i = 0; i < names.size(); ++i) {
    Json cells = Json::array();
    for (std::size_t j = 0; j < names.size(); ++j) {
      const double value = at(correlation, i, j);
      const double r = std::isnan(value) ? 0.0 : value;
      Json cell{{"r", shown_in(value, 1.0, 3)},
                {"strength", fmt::format("{:.2f}", std::min(1.0, std::abs(r)))},
                {"sign", i == j    ? "self"
                         : r < 0.0 ? "minus"
                                   : "plus"}};
      if (!std::isnan(value)) cell["r"]["text"] = fixed(r, 2);
      cells.push_back(std::move(cell));
    }
    rows.push_back(
        {{"number", fmt::format("{}", i + 1)}, {"name", names[i]}, {"cells", std::move(cells)}});
  }
  return rows;
}

/// How well estimates are told apart, in words; those without a number are left out.
std::string correlation_reading(const StoredCorrelation& correlation) {
  std::vector<std::string> names;
  std::vector<std::size_t> known;
  for (std::size_t i = 0; i < correlation.names.size(); ++i) {
    if (std::isnan(at(correlation, i, i))) continue;
    known.push_back(i);
    names.push_back(correlation.names[i]);
  }
  const auto n = static_cast<Eigen::Index>(known.size());
  Eigen::MatrixXd matrix(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j)
      matrix(i, j) =
          at(correlation, known[static_cast<std::size_t>(i)], known[static_cast<std::size_t>(j)]);
  }
  return calib::collinearity_words(names, matrix);
}

std::vector<std::string> parts_of_reason(const std::string& reason) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin < reason.size();) {
    const std::size_t end = std::min(reason.find("; ", begin), reason.size());
    parts.push_back(reason.substr(begin, end - begin));
    begin = end + 2;
  }
  return parts;
}

std::string joined_reason(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : "; ") + part;
  return text;
}

/// Takes what holds for every one of several rows out of their reasons, to be told once.
std::string lift_common_reasons(Json& rows) {
  if (rows.size() < 2) return {};
  std::vector<std::string> common;
  for (const std::string& part : parts_of_reason(text_of(rows.at(0), "reason"))) {
    const bool everywhere = std::all_of(rows.begin(), rows.end(), [&](const Json& row) {
      const auto parts = parts_of_reason(text_of(row, "reason"));
      return std::find(parts.begin(), parts.end(), part) != parts.end();
    });
    if (everywhere) common.push_back(part);
  }
  for (Json& row : rows) {
    auto parts = parts_of_reason(text_of(row, "reason"));
    std::erase_if(parts, [&](const std::string& part) {
      return std::find(common.begin(), common.end(), part) != common.end();
    });
    row["reason"] = joined_reason(parts);
    row["has_reason"] = !parts.empty();
  }
  return joined_reason(common);
}

std::vector<std::string> not_identifiable(const StoredFit& fit) {
  std::vector<std::string> names;
  for (const StoredParameter& p : fit.parameters) {
    if (p.fitted && p.identifiability == calib::Identifiability::not_identifiable)
      names.push_back(parameter_label(p));
  }
  return names;
}

}  // namespace

double relative_half_width(const StoredParameter& parameter) {
  const auto ends = Interval(parameter.ci95).ends;
  const double value = parameter.value.value_or(0.0);
  if (!ends || value == 0.0) return HUGE_VAL;
  return std::max(ends->high - value, value - ends->low) / std::abs(value);
}

std::string half_width_text(double relative) {
  constexpr double kMeaningless = 10.0;
  if (!(relative <= kMeaningless)) return "not determined";
  return fmt::format("± {} %", significant(100.0 * relative, kErrorDigits));
}

Json parameters_view(const std::vector<StoredParameter>& parameters,
                     const StoredCorrelation& correlation, bool judged) {
  Json fitted = Json::array();
  Json known = Json::array();
  for (const StoredParameter& p : parameters) {
    if (p.fitted) {
      fitted.push_back(fitted_row(p, judged));
    } else {
      known.push_back(known_row(p));
    }
  }
  Json view;
  const std::string common = lift_common_reasons(fitted);
  view["common"] = common;
  view["has_common"] = !common.empty();
  view["has_fitted"] = !fitted.empty();
  view["fitted"] = std::move(fitted);
  view["has_known"] = !known.empty();
  view["known_count"] = fmt::format("{}", known.size());
  view["known"] = std::move(known);
  view["has_correlation"] = correlation.names.size() > 1;
  view["correlation"] = correlation_rows(correlation);
  view["correlation_reading"] = correlation_reading(correlation);
  return view;
}

Json identifiability_view(const StoredFit& fit) {
  std::vector<double> values = fit.singular_values;
  std::erase_if(values, [](double value) { return std::isnan(value); });
  Json view;
  view["known"] = !values.empty();
  if (values.empty()) return view;
  const int rank = fit.rank;
  const auto all = static_cast<int>(values.size());
  if (rank < all) {
    view["reading"] = fmt::format(
        "The Jacobian has rank {} of {}: {} combination{} of the parameters can be changed without "
        "any effect on the records.",
        rank, all, all - rank, all - rank == 1 ? "" : "s");
  } else {
    const std::vector<std::string> open = not_identifiable(fit);
    view["reading"] = fmt::format(
        "The Jacobian has full rank ({} of {}): every combination of the parameters has an effect "
        "on "
        "the records, the strongest {:.3g} times that of the weakest. {}",
        rank, all, values.back() > 0.0 ? values.front() / values.back() : 0.0,
        open.empty()
            ? "No parameter is graded not identifiable."
            : fmt::format("For these it is too small against the noise to identify them: {}.",
                          fmt::join(open, ", ")));
  }
  Plot plot = ranked_points("Singular values of the scaled Jacobian", "singular value", values);
  plot.x_label = "direction";
  view["plot_html"] = svg(plot);
  view["values"] = Json::array();
  for (const double value : values) view["values"].push_back({{"value", shown(value, "1", 4)}});
  return view;
}

}  // namespace rigcal::report
