#include "report/figure/response_plot.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace rigcal::report {
namespace {

/// Adds whole turns to `phase` until it is as close as possible to `neighbour`.
double near(double phase, double neighbour) {
  return neighbour + std::remainder(phase - neighbour, 360.0);
}

Plot empty_plot(const std::string& condition, const ResponseCurves& curves, const char* what) {
  Plot plot;
  plot.title = fmt::format("{} of {}, {}, record and model", what, curves.of, condition);
  plot.x_label = "frequency [Hz]";
  plot.width = 300.0;
  plot.height = 170.0;
  plot.log_x = true;
  return plot;
}

struct Curve {
  std::vector<double> frequency_hz, middle, low, high;
};

void draw(Plot& plot, Curve record, Curve model) {
  Trace line = empty_trace(Trace::Kind::line, "model", "model");
  line.x = model.frequency_hz;
  line.y = model.middle;
  Trace nodes = empty_trace(Trace::Kind::points, "model");
  nodes.x = std::move(model.frequency_hz);
  nodes.y = std::move(model.middle);
  Trace spans = empty_trace(Trace::Kind::intervals, "measured");
  spans.x = record.frequency_hz;
  spans.y = std::move(record.low);
  spans.upper = std::move(record.high);
  Trace points = empty_trace(Trace::Kind::points, "measured", "record");
  points.x = std::move(record.frequency_hz);
  points.y = std::move(record.middle);
  plot.traces = {std::move(line), std::move(nodes), std::move(spans), std::move(points)};
}

}  // namespace

ResponseCurves coherent(const ResponseCurves& all) {
  ResponseCurves kept = all;
  kept.record.clear();
  kept.model.clear();
  std::size_t at = 0;
  for (const metrics::ResponsePoint& measured : all.record) {
    // Both responses belong to the same drive, so equal frequencies are bitwise equal.
    while (at < all.model.size() && all.model[at].frequency_hz < measured.frequency_hz) ++at;
    if (at == all.model.size()) break;
    const metrics::ResponsePoint& simulated = all.model[at];
    if (simulated.frequency_hz != measured.frequency_hz ||
        measured.coherence < metrics::kLeastCoherence ||
        simulated.coherence < metrics::kLeastCoherence)
      continue;
    kept.record.push_back(measured);
    kept.model.push_back(simulated);
  }
  return kept;
}

Plot gain_plot(const std::string& condition, const ResponseCurves& curves) {
  Plot plot = empty_plot(condition, curves, "gain");
  plot.y_label = fmt::format("gain [{}]", curves.unit);
  plot.log_y = true;
  const auto curve_of = [&](const std::vector<metrics::ResponsePoint>& points) {
    Curve curve;
    for (const metrics::ResponsePoint& point : points) {
      curve.frequency_hz.push_back(point.frequency_hz);
      curve.middle.push_back(point.gain / curves.si_per_unit);
      const bool known = point.interval.has_value() && point.interval->gain_low > 0.0;
      curve.low.push_back(known ? point.interval->gain_low / curves.si_per_unit : std::nan(""));
      curve.high.push_back(known ? point.interval->gain_high / curves.si_per_unit : std::nan(""));
    }
    return curve;
  };
  draw(plot, curve_of(curves.record), curve_of(curves.model));
  return plot;
}

Plot phase_plot(const std::string& condition, const ResponseCurves& curves) {
  Plot plot = empty_plot(condition, curves, "phase");
  plot.y_label = "phase [°]";
  Curve record;
  Curve model;
  double before = 0.0;
  for (std::size_t i = 0; i < curves.record.size(); ++i) {
    const metrics::ResponsePoint& point = curves.record[i];
    const double phase = near(point.phase_deg, before);
    before = phase;
    record.frequency_hz.push_back(point.frequency_hz);
    record.middle.push_back(phase);
    const bool known = point.interval.has_value() && point.interval->phase_half_deg < 180.0;
    record.low.push_back(known ? phase - point.interval->phase_half_deg : std::nan(""));
    record.high.push_back(known ? phase + point.interval->phase_half_deg : std::nan(""));
    model.frequency_hz.push_back(curves.model[i].frequency_hz);
    model.middle.push_back(near(curves.model[i].phase_deg, phase));
  }
  draw(plot, std::move(record), std::move(model));
  return plot;
}

}  // namespace rigcal::report
