#include "report/page/calibration/page_agreement_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "datasets/campaign/waveform.hpp"
#include "datasets/record.hpp"
#include "metrics/distributions.hpp"
#include "report/figure/histogram_plot.hpp"
#include "report/figure/parity_plot.hpp"
#include "report/figure/time_plots.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

/// Fewer samples are not enough for a histogram or a spectrum.
constexpr std::size_t kLeastSamples = 64;
/// Minimum number of samples per period of a periodic drive. If the samples do not divide the
/// period exactly, the number varies by one.
constexpr double kLeastPerPeriod = 10.0;

struct Drive {
  const char* column;
  const char* name;
  const char* unit;
};
constexpr Drive kDrives[] = {{"reference_m", "reference", "m"},
                             {"command_v", "command", "V"},
                             {"force_reference_n", "force reference", "N"},
                             {"load_pressure_reference_pa", "load pressure reference", "Pa"},
                             {"acceleration_reference_m_per_s2", "acceleration reference", "m/s2"},
                             {"angle_reference_rad", "angle reference", "rad"},
                             {"torque_reference_n_m", "torque reference", "N m"}};

std::vector<double> counted(const std::vector<double>& values, const std::vector<double>* window) {
  if (window == nullptr) return values;
  std::vector<double> kept;
  for (std::size_t i = 0; i < values.size(); ++i)
    if ((*window)[i] != 0.0) kept.push_back(values[i]);
  return kept;
}

bool all_finite(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

/// Returns the sampling interval, or std::nullopt if the samples are not equidistant to within 1 %.
std::optional<double> equal_steps(std::span<const double> time_s) {
  const double step = (time_s.back() - time_s.front()) / static_cast<double>(time_s.size() - 1);
  if (!(step > 0.0)) return std::nullopt;
  for (std::size_t i = 1; i < time_s.size(); ++i)
    if (std::abs(time_s[i] - time_s[i - 1] - step) > 0.01 * step) return std::nullopt;
  return step;
}

/// The samples from the first to the last scored one.
struct Stretch {
  std::size_t begin = 0;
  std::size_t size = 0;
};
Stretch counted_stretch(std::size_t samples, const std::vector<double>* window) {
  if (window == nullptr) return {0, samples};
  const auto counts = [](double value) { return value != 0.0; };
  const auto first = std::find_if(window->begin(), window->end(), counts);
  const auto last = std::find_if(window->rbegin(), window->rend(), counts);
  if (first == window->end()) return {};
  return {static_cast<std::size_t>(first - window->begin()),
          static_cast<std::size_t>(last.base() - first)};
}

/// Sets a unit for the gain that suits its largest value: "mm/V", "MPa/mm", "1".
void set_gain_unit(ResponseCurves& curves, std::string_view output_unit,
                   std::string_view drive_unit, double output_size, double drive_size) {
  if (output_unit == drive_unit) {
    curves.unit = "1";
    return;
  }
  const ReadableUnit over = readable_unit(output_size, output_unit);
  const ReadableUnit under = readable_unit(drive_size, drive_unit);
  curves.unit = fmt::format("{}/{}", over.name, under.name);
  curves.si_per_unit = over.si / under.si;
}

std::string coverage_words(const std::vector<double>& residual, const std::vector<double>& sd) {
  std::size_t within = 0;
  std::size_t all = 0;
  for (std::size_t i = 0; i < residual.size(); ++i) {
    if (!std::isfinite(residual[i]) || !std::isfinite(sd[i])) continue;
    ++all;
    if (std::abs(residual[i]) <= metrics::kNormal95 * sd[i]) ++within;
  }
  if (all == 0) return {};
  return fmt::format("{:.1f} % of them are within the 95 % prediction band.",
                     100.0 * static_cast<double>(within) / static_cast<double>(all));
}

struct Response {
  std::optional<ResponseCurves> curves;
  std::string words;
};

Response response_of(std::optional<double> frequency_hz, const Table& series,
                     const datasets::ChannelInfo& about, const std::vector<double>& measured,
                     const std::vector<double>& simulated) {
  const auto* time_s = series.find("time_s");
  const Drive* drive = nullptr;
  const std::vector<double>* input = nullptr;
  for (const Drive& each : kDrives) {
    if (const auto* values = series.find(each.column)) {
      drive = &each;
      input = values;
      break;
    }
  }
  if (time_s == nullptr || input == nullptr) return {{}, "Gain and phase: no drive is stored."};
  const Stretch part = counted_stretch(time_s->size(), series.find("in_window"));
  const auto cut = [&](const std::vector<double>& values) {
    return std::span(values).subspan(part.begin, part.size);
  };
  if (part.size < kLeastSamples) return {{}, "Gain and phase: too few samples."};
  if (!all_finite(cut(*input)) || !all_finite(cut(measured)) || !all_finite(cut(simulated)))
    return {{}, "Gain and phase: unknown for signals with gaps."};
  ResponseCurves curves;
  curves.of = fmt::format("{} over {}", spaced(std::string(about.key)), drive->name);
  set_gain_unit(curves, about.unit, drive->unit, largest(cut(measured)), largest(cut(*input)));
  const auto step = equal_steps(cut(*time_s));
  if (!step) return {{}, "Gain and phase: the samples are not equidistant."};
  if (frequency_hz) {
    const double per_period = 1.0 / (*frequency_hz * *step);
    if (static_cast<double>(part.size) < per_period || per_period < kLeastPerPeriod)
      return {{},
              fmt::format("Gain and phase: less than a period, or fewer than {} samples in one.",
                          kLeastPerPeriod)};
    curves.record =
        metrics::periodic_response(cut(*time_s), cut(*input), cut(measured), *frequency_hz);
    curves.model =
        metrics::periodic_response(cut(*time_s), cut(*input), cut(simulated), *frequency_hz);
  } else {
    curves.record = metrics::broadband_response(*step, cut(*input), cut(measured));
    curves.model = metrics::broadband_response(*step, cut(*input), cut(simulated));
  }
  const std::size_t estimated = curves.record.size();
  curves = coherent(curves);
  if (curves.record.empty())
    return {{},
            fmt::format("Gain and phase of {}: no frequency has a coherence of {:g} or more.",
                        curves.of, metrics::kLeastCoherence)};
  const bool has_intervals =
      std::any_of(curves.record.begin(), curves.record.end(),
                  [](const auto& point) { return point.interval.has_value(); });
  const std::string where =
      frequency_hz && estimated == 1 ? "at the fundamental of the drive"
      : frequency_hz
          ? fmt::format("at {} of {} harmonics of the drive", curves.record.size(), estimated)
          : fmt::format("at {} of {} frequencies", curves.record.size(), estimated);
  std::string words =
      fmt::format("Gain and phase of {} {}, where the coherence is {:g} or more; {}.", curves.of,
                  where, metrics::kLeastCoherence,
                  has_intervals ? "bars: 95 % intervals, from the coherence"
                                : "a single period, so no interval");
  return {std::move(curves), std::move(words)};
}

}  // namespace

std::vector<ChannelAgreement> channel_agreements(const std::string& condition,
                                                 std::optional<double> frequency_hz,
                                                 const Table& series) {
  std::vector<ChannelAgreement> channels;
  const auto* window = series.find("in_window");
  for (const datasets::ChannelInfo& about : datasets::channel_table()) {
    const auto* measured = series.find(fmt::format("measured_{}", about.name));
    const auto* simulated = series.find(fmt::format("simulated_{}", about.name));
    if (measured == nullptr || simulated == nullptr) continue;
    const std::vector<double> y = counted(*measured, window);
    const std::vector<double> s = counted(*simulated, window);
    std::vector<double> e;
    for (std::size_t i = 0; i < y.size(); ++i) e.push_back(y[i] - s[i]);
    const ResidualMoments moments = residual_moments(y, s);
    if (moments.samples < kLeastSamples || !(moments.sd > 0.0)) continue;
    ChannelAgreement found;
    found.channel = std::string(about.key);
    const std::string words = spaced(found.channel);
    const ReadableUnit both = readable_unit(std::max(largest(y), largest(s)), about.unit);
    const ReadableUnit rest = readable_unit(moments.sd, about.unit);
    const auto name_of = [](const ReadableUnit& unit) {
      return std::string(unit.name.empty() ? "1" : unit.name);
    };
    found.figures.push_back(
        {found.channel + "_parity",
         parity_plot(fmt::format("{} of {}, model against measured", words, condition), y, s,
                     name_of(both), both.si)});
    found.figures.push_back(
        {found.channel + "_histogram",
         histogram_plot(
             fmt::format("residual of {} of {}, histogram and normal density", words, condition), e,
             name_of(rest), rest.si)});
    const auto* sd = series.find(fmt::format("prediction_sd_{}", about.name));
    found.residual = fmt::format(
        "Residual of {} over {} samples: mean {}, standard deviation {}; dashed on both sides of "
        "the line of equality: 95 % limits of agreement.",
        words, moments.samples, readable(moments.mean, about.unit, 3),
        readable(moments.sd, about.unit, 3));
    if (sd != nullptr) found.residual += " " + coverage_words(e, counted(*sd, window));
    Response response = response_of(frequency_hz, series, about, *measured, *simulated);
    if (response.curves) {
      found.figures.push_back({found.channel + "_gain", gain_plot(condition, *response.curves)});
      found.figures.push_back({found.channel + "_phase", phase_plot(condition, *response.curves)});
    }
    found.response = std::move(response.words);
    channels.push_back(std::move(found));
  }
  return channels;
}

std::optional<ResponseCurves> channel_response(const std::string& channel,
                                               std::optional<double> frequency_hz,
                                               const Table& series) {
  const auto known = datasets::channel_from_key(channel);
  if (!known) return std::nullopt;
  const datasets::ChannelInfo& about = datasets::info(*known);
  const auto* measured = series.find(fmt::format("measured_{}", about.name));
  const auto* simulated = series.find(fmt::format("simulated_{}", about.name));
  if (measured == nullptr || simulated == nullptr) return std::nullopt;
  return response_of(frequency_hz, series, about, *measured, *simulated).curves;
}

doc::Blocks agreement_blocks(const std::string& condition, std::optional<double> frequency_hz,
                             const Table& series) {
  doc::Blocks blocks;
  for (ChannelAgreement& channel : channel_agreements(condition, frequency_hz, series)) {
    blocks.emplace_back(doc::Heading{{spaced(channel.channel)}, 4});
    doc::Gallery gallery;
    for (Figure& figure : channel.figures)
      gallery.figures.push_back(figure_of(std::move(figure.plot)));
    blocks.emplace_back(std::move(gallery));
    blocks.emplace_back(doc::reading(channel.residual + " " + channel.response));
  }
  return blocks;
}

}  // namespace rigcal::report
