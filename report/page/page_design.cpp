#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "datasets/record.hpp"
#include "metrics/distributions.hpp"
#include "metrics/frequency_response.hpp"
#include "report/figure/decimate.hpp"
#include "report/figure/time_plots.hpp"
#include "report/page/page_parts.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

using Kind = doc::Column::Kind;

constexpr std::size_t kDesignPoints = 1200;
/// Number of bins per decade in a spectrum: narrow enough to separate the lines of a multisine.
constexpr double kBinsPerDecade = 60.0;

std::optional<double> half_width_percent(const std::optional<double>& sd, double value) {
  if (!sd || value == 0.0) return std::nullopt;
  return 100.0 * metrics::kNormal95 * *sd / std::abs(value);
}

std::string percent_of(const std::optional<double>& percent) {
  if (!percent) return "–";
  return *percent > 1000.0 ? std::string("> 1000") : fmt::format("{:.3g}", *percent);
}

std::string words_of(datasets::DriveFamily family) {
  switch (family) {
    case datasets::DriveFamily::multisine:
      return "multisine";
    case datasets::DriveFamily::chirp:
      return "chirp";
    case datasets::DriveFamily::steps:
      return "series of steps";
    case datasets::DriveFamily::prbs:
      return "pseudo-random binary sequence";
  }
  return "";
}

/// Returns a column of the response, thinned for drawing.
Trace line_of(const Table& response, const std::vector<double>& values, double si,
              const std::string& style, const std::string& name) {
  Trace trace = empty_trace(Trace::Kind::line, style, name);
  const Buckets thin = buckets(values.size(), kDesignPoints);
  trace.x = thinned_times(response.columns.front(), values, thin);
  trace.y = thinned(values, thin);
  for (double& y : trace.y) y /= si;
  return trace;
}

Plot plot_over_time(const std::string& title, const std::string& what, const ReadableUnit& unit) {
  return {title, "time [s]", fmt::format("{} [{}]", what, unit.name.empty() ? "1" : unit.name),
          720.0, 190.0};
}

doc::Table prediction_table(const StoredDesign& design) {
  doc::Table table{"Predicted intervals"};
  table.caption = {"Half width of the 95 % interval of each parameter, in % of its value"};
  table.shape = doc::Table::Shape::cards;
  table.columns = {{"Parameter"},
                   {"Value", Kind::number},
                   {"Unit", Kind::unit},
                   {"This test", Kind::number},
                   {"Own signals, same time", Kind::number},
                   {"Own over this", Kind::number}};
  for (const calib::DesignedParameter& parameter : design.parameters) {
    const ReadableUnit unit = readable_unit(parameter.value, parameter.unit);
    const auto own = half_width_percent(parameter.sd_own_signals, parameter.value);
    const auto now = half_width_percent(parameter.sd, parameter.value);
    table.rows.push_back(
        {{parameter.label(), doc::in_unit(parameter.value, unit.si, 5),
          unit.name.empty() ? std::string("1") : unit.name, percent_of(now), percent_of(own),
          own && now ? fmt::format("{:.2g}", *own / *now) : std::string("–")}});
  }
  return table;
}

doc::Table limit_table(const StoredDesign& design) {
  doc::Table table{"Limits"};
  table.caption = {"Limits, and the extremes of the predicted response"};
  table.columns = {{"Limit of"},
                   {"Limit", Kind::number},
                   {"Reached", Kind::number},
                   {"Unit", Kind::unit},
                   {"Used, %", Kind::number}};
  for (const StoredDesignLimit& limit : design.limits) {
    const ReadableUnit unit =
        readable_unit(std::max(std::abs(limit.limit), std::abs(limit.reached)), limit.unit);
    table.rows.push_back({{limit.words, doc::in_unit(limit.limit, unit.si, 4),
                           doc::in_unit(limit.reached, unit.si, 4), unit.name,
                           fmt::format("{:.1f}", limit.share_percent)}});
  }
  return table;
}

doc::Table family_table(const StoredDesign& design) {
  doc::Table table{"Families of drives"};
  table.caption = {"The best drive of each family: half width of each named parameter, in %"};
  table.columns = {{"Family"}, {"Drives tried", Kind::number}};
  for (const calib::DesignedParameter& parameter : design.parameters)
    if (parameter.named) table.columns.push_back({parameter.label(), Kind::number});
  for (const calib::FamilyTrial& trial : design.families) {
    doc::Row row{{words_of(trial.family), fmt::format("{}", trial.evaluations)}};
    for (std::size_t j = 0; j < design.parameters.size(); ++j) {
      if (!design.parameters[j].named) continue;
      row.cells.push_back(
          trial.found ? percent_of(half_width_percent(trial.sd[j], design.parameters[j].value))
                      : std::string("no drive within the limits"));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

doc::Table drive_table(const StoredDesign& design) {
  doc::Table table{"Numbers of the drive"};
  table.columns = {{"Number"}, {"Value", Kind::number}, {"Unit", Kind::unit}};
  for (const calib::DrivePart& part : design.drive)
    table.rows.push_back({{part.name, fmt::format("{:.5g}", part.value),
                           part.unit == "1" ? std::string() : typographic(part.unit)}});
  return table;
}

std::string listed_names(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 6;
  std::string text;
  for (std::size_t i = 0; i < std::min(kShown, names.size()); ++i)
    text += (i == 0 ? "" : ", ") + names[i];
  if (names.size() > kShown) text += fmt::format(" and {} more", names.size() - kShown);
  return text;
}

std::string noise_words(const StoredDesign& design) {
  std::string text;
  for (const auto& [channel, sd] : design.noise_sd) {
    std::string_view unit = "1";
    std::string key = channel;
    for (const datasets::ChannelInfo& row : datasets::channel_table()) {
      if (row.name != channel) continue;
      unit = row.unit;
      key = row.key;
    }
    text += fmt::format("{}{} of {}", text.empty() ? "" : ", ", readable(sd, unit, 3), spaced(key));
  }
  return text;
}

}  // namespace

std::vector<Figure> design_figures(const PlanFiles& files) {
  std::vector<Figure> figures;
  const Table& response = files.response;
  if (!files.result.design || response.columns.empty() || response.columns.front().size() < 2)
    return figures;
  const StoredDesign& design = *files.result.design;
  const auto channel = datasets::channel_from_key(design.channel);
  const auto* drive = channel ? response.find(datasets::info(*channel).name) : nullptr;
  const auto* position = response.find("position_m");
  if (drive == nullptr || position == nullptr) return figures;
  const ReadableUnit length = readable_unit(largest(*position), "m");
  const ReadableUnit driven = readable_unit(largest(*drive), design.unit);
  const std::string drive_name = spaced(design.channel);
  if (design.channel == "reference") {
    Plot both = plot_over_time("Drive and predicted position", "position", length);
    both.traces = {line_of(response, *drive, length.si, "measured", "drive"),
                   line_of(response, *position, length.si, "model", "predicted position")};
    figures.push_back({"design_drive", std::move(both)});
  } else {
    Plot alone = plot_over_time("Drive", drive_name, driven);
    alone.traces = {line_of(response, *drive, driven.si, "measured", "drive")};
    figures.push_back({"design_drive", std::move(alone)});
    Plot moved = plot_over_time("Predicted position", "position", length);
    moved.traces = {line_of(response, *position, length.si, "model", "predicted position")};
    figures.push_back({"design_position", std::move(moved)});
  }
  Plot spectrum{"Spectrum of drive and predicted position", "frequency [Hz]",
                "fraction of the largest", 720.0, 190.0};
  spectrum.log_x = true;
  spectrum.log_y = true;
  const auto add = [&](const std::vector<double>& values, const char* style, const char* name) {
    Trace trace = empty_trace(Trace::Kind::line, style, name);
    metrics::BandLevels levels =
        metrics::band_levels(values, design.sample_rate_hz, kBinsPerDecade);
    trace.x = std::move(levels.frequency_hz);
    trace.y = std::move(levels.rms);
    const double top = largest(trace.y);
    constexpr double kFloor = 1e-4;
    if (!(top > 0.0)) return;
    for (double& y : trace.y) y = std::max(y / top, kFloor);
    spectrum.traces.push_back(std::move(trace));
  };
  add(*drive, "measured", "drive");
  add(*position, "model", "predicted position");
  if (!spectrum.traces.empty()) figures.push_back({"design_spectrum", std::move(spectrum)});
  return figures;
}

doc::Verdict design_headline(const StoredDesign& design) {
  bool all_determined = true;
  std::string words;
  for (const calib::DesignedParameter& parameter : design.parameters) {
    if (!parameter.named) continue;
    const auto half = half_width_percent(parameter.sd, parameter.value);
    all_determined = all_determined && half.has_value();
    words += fmt::format("{}{} to {}", words.empty() ? "" : ", ", parameter.label(),
                         half ? fmt::format("± {} %", percent_of(half)) : "no interval");
    if (const auto own = half_width_percent(parameter.sd_own_signals, parameter.value))
      words += fmt::format(" (own signals: ± {} %)", percent_of(own));
  }
  doc::Verdict verdict{
      {all_determined && !design.stopped() ? doc::State::good : doc::State::warn, "DESIGN"},
      {fmt::format("A {} of {:g} s with {} repeat{} determines {}. All stated limits are met.",
                   words_of(design.family), design.duration_s, design.repeats,
                   design.repeats == 1 ? "" : "s", words)}};
  if (design.stopped())
    add_reason(verdict, "stopped by a signal: the best drive found until then", "design");
  for (const calib::DesignedParameter& parameter : design.parameters) {
    if (parameter.named && !parameter.sd)
      add_reason(verdict, fmt::format("{} is not determined by this test", parameter.label()),
                 "design");
  }
  return verdict;
}

doc::Section design_section(const PlanFiles& files) {
  const StoredDesign& design = *files.result.design;
  doc::Gallery gallery;
  gallery.wide = true;
  for (Figure& figure : design_figures(files))
    gallery.figures.push_back(figure_of(std::move(figure.plot)));
  std::vector<std::string> named;
  for (const calib::DesignedParameter& parameter : design.parameters)
    if (parameter.named) named.push_back(parameter.label());
  const std::string criterion = design.criterion == datasets::DesignCriterion::determinant
                                    ? "the smallest confidence ellipsoid (D-optimal)"
                                    : "the smallest of the widest relative intervals";
  const std::string compared =
      design.own_signals.empty()
          ? std::string("The campaign has no signals of its own to compare with.")
          : fmt::format(
                "The campaign's own signals: {}, {:.4g} s, scaled to the time and the repeats of "
                "this "
                "test, with the same noise.",
                listed_names(design.own_signals), design.own_signals_duration_s);
  doc::Blocks blocks{
      doc::reading(
          fmt::format("Designed for {}: {}, with all other unknowns estimated too. The intervals "
                      "are lower limits: white noise ({}, one repeat) and an exact model. {}",
                      listed_names(named), criterion, noise_words(design), compared)),
      list_of(design.messages),
      prediction_table(design),
      limit_table(design),
      doc::about_picture("The drive begins and ends at the rest position. The spectrum shows the "
                         "rms in narrow bands, relative to the strongest."),
      std::move(gallery),
      family_table(design),
      doc::Fold{fmt::format("Numbers of the drive ({})", design.drive.size()),
                {drive_table(design)}},
      doc::reading(fmt::format("{} is the drive for the controller, {} the predicted response, {} "
                               "the campaign for the records to be made.",
                               kDriveFile, kResponseFile, kDesignedCampaignFile))};
  return {"design", "The designed test", std::move(blocks), "Design"};
}

}  // namespace rigcal::report
