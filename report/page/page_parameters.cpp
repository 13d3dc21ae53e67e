#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "report/page/page_parts.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

RowUnit unit_of(const Json& parameter) {
  return row_unit(number_of(parameter, "value").value_or(0.0), parameter);
}

/// The 95 % interval of one of the errors alone, as if it were known exactly.
Json interval_by(const Json& parameter, const char* error_key, const RowUnit& unit) {
  constexpr double kNormalQuantile = 1.96;
  const auto value = number_of(parameter, "value");
  const auto error = number_of(parameter, error_key);
  if (!value || !error) return shown_interval(nullptr, unit.si);
  return shown_interval(
      Json::array({*value - kNormalQuantile * *error, *value + kNormalQuantile * *error}), unit.si);
}

/// "± 2.1 %" of the value; empty where that says nothing.
std::string half_width_text(const Json& parameter) {
  const Json& ci = parameter.at("ci95");
  const auto value = number_of(parameter, "value");
  if (!ci.is_array() || !ci.at(0).is_number() || !ci.at(1).is_number() || !value || *value == 0.0)
    return {};
  // The end that no limit of the parameter has cut, as the grade and its reason count.
  const double half = std::max(ci.at(1).get<double>() - *value, *value - ci.at(0).get<double>());
  const double percent = 100.0 * half / std::abs(*value);
  if (percent > 1000.0) return "over 1000 %";
  return percent < 100.0 ? fmt::format("± {:.2g} %", percent) : fmt::format("± {:.0f} %", percent);
}

Json grade(const Json& parameter) {
  const std::string text = text_of(parameter, "identifiability");
  const bool bound = parameter.at("at_bound").get<bool>();
  Json view{{"word", text == "not_identifiable" ? "not identifiable" : text},
            {"mark", "✓"},
            {"class", "good"}};
  if (text == "weak" || text == "bounded" || bound) {
    view["mark"] = "!";
    view["class"] = "warn";
  }
  if (text == "not_identifiable") {
    view["mark"] = "✕";
    view["class"] = "bad";
  }
  if (text == "bounded") view["word"] = "bounded: not different from zero";
  if (bound && text != "bounded") view["word"] = view["word"].get<std::string>() + ", at a bound";
  return view;
}

Json fitted_row(const Json& p) {
  const RowUnit unit = unit_of(p);
  Json row;
  row["name"] = text_of(p, "key");
  row["symbol"] = text_of(p, "symbol");
  const std::string level = text_of(p, "level");
  row["whose"] = level.empty() ? std::string("rig") : level;
  row["nuisance"] = p.at("nuisance").get<bool>();
  row["value"] = shown_matched(p.at("value"), p.at("ci95"), unit.si, 6);
  row["unit"] = unit.name;
  row["interval"] = shown_interval(p.at("ci95"), unit.si);
  row["half_width"] = half_width_text(p);
  for (const char* key : {"standard_error", "robust_standard_error"}) {
    row[key] = shown_in(p.at(key), unit.si, 2);
    row[key]["interval"] = interval_by(p, key, unit);
  }
  row["start"] = shown_in(p.at("start"), unit.si, 5);
  row["lower"] = shown_in(p.at("lower"), unit.si, 4);
  row["upper"] = shown_in(p.at("upper"), unit.si, 4);
  row["grade"] = grade(p);
  row["reason"] = text_of(p, "reason");
  row["has_reason"] = !text_of(p, "reason").empty();
  return row;
}

Json known_row(const Json& p) {
  const RowUnit unit = unit_of(p);
  const std::string level = text_of(p, "level");
  return {{"name", text_of(p, "key")},
          {"symbol", text_of(p, "symbol")},
          {"whose", level.empty() ? std::string("rig") : level},
          {"value", shown_in(p.at("value"), unit.si, 6)},
          {"unit", unit.name},
          {"reason", text_of(p, "reason")}};
}

Json correlation_rows(const Json& correlation) {
  const Json& names = correlation.at("names");
  const Json& matrix = correlation.at("matrix");
  Json rows = Json::array();
  for (std::size_t i = 0; i < names.size(); ++i) {
    Json cells = Json::array();
    for (std::size_t j = 0; j < names.size(); ++j) {
      const Json& value = matrix.at(i).at(j);
      const double r = value.is_number() ? value.get<double>() : 0.0;
      Json cell{{"r", shown_in(value, 1.0, 3)},
                {"strength", fmt::format("{:.2f}", std::min(1.0, std::abs(r)))},
                {"sign", i == j    ? "self"
                         : r < 0.0 ? "minus"
                                   : "plus"}};
      if (value.is_number()) cell["r"]["text"] = fmt::format("{:.2f}", r);
      cells.push_back(std::move(cell));
    }
    rows.push_back({{"number", fmt::format("{}", i + 1)},
                    {"name", names.at(i).get<std::string>()},
                    {"cells", std::move(cells)}});
  }
  return rows;
}

/// Pairs that can hardly be told apart, in words.
std::string correlation_reading(const Json& correlation) {
  const Json& names = correlation.at("names");
  const Json& matrix = correlation.at("matrix");
  double strongest = 0.0;
  std::string pair;
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Json& value = matrix.at(i).at(j);
      if (!value.is_number() || std::abs(value.get<double>()) <= std::abs(strongest)) continue;
      strongest = value.get<double>();
      pair = names.at(j).get<std::string>() + " and " + names.at(i).get<std::string>();
    }
  }
  if (pair.empty()) return {};
  const char* meaning =
      std::abs(strongest) > 0.99  ? "these records tell a combination of the two far better "
                                    "than each alone"
      : std::abs(strongest) > 0.9 ? "an error of one is mostly made up by the other"
                                  : "all can be told apart";
  return fmt::format("Strongest: {:.3f} between {}; {}.", strongest, pair, meaning);
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

std::vector<std::string> not_identifiable(const Json& result) {
  std::vector<std::string> names;
  for (const Json& p : result.at("parameters")) {
    if (p.at("fitted").get<bool>() && text_of(p, "identifiability") == "not_identifiable")
      names.push_back(parameter_label(p));
  }
  return names;
}

}  // namespace

Json parameters_view(const Json& result) {
  Json fitted = Json::array();
  Json known = Json::array();
  for (const Json& p : result.at("parameters")) {
    if (p.at("fitted").get<bool>()) {
      fitted.push_back(fitted_row(p));
    } else {
      known.push_back(known_row(p));
    }
  }
  const Json& correlation = result.at("correlation");
  Json view;
  const std::string common = lift_common_reasons(fitted);
  view["common"] = common;
  view["has_common"] = !common.empty();
  view["has_fitted"] = !fitted.empty();
  view["fitted"] = std::move(fitted);
  view["has_known"] = !known.empty();
  view["known_count"] = fmt::format("{}", known.size());
  view["known"] = std::move(known);
  view["has_correlation"] = correlation.at("names").size() > 1;
  view["correlation"] = correlation_rows(correlation);
  view["correlation_reading"] = correlation_reading(correlation);
  return view;
}

Json identifiability_view(const Json& result) {
  std::vector<double> values;
  for (const Json& value : result.at("singular_values"))
    if (value.is_number()) values.push_back(value.get<double>());
  Json view;
  view["known"] = !values.empty();
  if (values.empty()) return view;
  const long rank = count_at(result, "rank");
  const auto all = static_cast<long>(values.size());
  if (rank < all) {
    view["reading"] = fmt::format(
        "The Jacobian has rank {} of {}: {} combination{} of the parameters can be changed without "
        "any effect on the records.",
        rank, all, all - rank, all - rank == 1 ? "" : "s");
  } else {
    const std::vector<std::string> open = not_identifiable(result);
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
