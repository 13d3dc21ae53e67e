#include "report/figure/response_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace rigcal::report {
namespace {

/// Adds whole turns to `phase` until it is as close as possible to `neighbour`.
double near(double phase, double neighbour) {
  return neighbour + std::remainder(phase - neighbour, 360.0);
}

Plot empty_plot(const std::string& condition, const ResponseCurves& curves, const char* what) {
  Plot plot{fmt::format("{} of {}, {}, record and model", what, curves.of, condition),
            "frequency [Hz]",
            {},
            300.0,
            170.0};
  plot.log_x = true;
  return plot;
}

struct Curve {
  std::vector<double> frequency_hz, middle, low, high;
};

void add(Curve& curve, double frequency_hz, double middle, double low, double high) {
  curve.frequency_hz.push_back(frequency_hz);
  curve.middle.push_back(middle);
  curve.low.push_back(low);
  curve.high.push_back(high);
}

/// Adds a gap, so that no line joins the points before and after it.
void lift(Curve& curve) { add(curve, std::nan(""), std::nan(""), std::nan(""), std::nan("")); }

/// Returns the phases of the records without jumps from frequency to frequency, by condition.
std::vector<std::vector<double>> unwrapped(const std::vector<ResponseCurves>& all) {
  struct Place {
    double frequency_hz;
    std::size_t condition, point;
  };
  std::vector<Place> order;
  std::vector<std::vector<double>> phases(all.size());
  for (std::size_t c = 0; c < all.size(); ++c) {
    phases[c].resize(all[c].record.size());
    for (std::size_t i = 0; i < phases[c].size(); ++i)
      order.push_back({all[c].record[i].frequency_hz, c, i});
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const Place& a, const Place& b) { return a.frequency_hz < b.frequency_hz; });
  double before = 0.0;
  for (const Place& place : order) {
    before = near(all[place.condition].record[place.point].phase_deg, before);
    phases[place.condition][place.point] = before;
  }
  return phases;
}

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

Plot gain_plot(const std::string& name, const std::vector<ResponseCurves>& all) {
  const ResponseCurves& first = all.front();
  Plot plot = empty_plot(name, first, "gain");
  plot.y_label = fmt::format("gain [{}]", first.unit);
  plot.log_y = true;
  const auto add_points = [&](const std::vector<metrics::ResponsePoint>& points, Curve& curve) {
    if (!curve.frequency_hz.empty()) lift(curve);
    for (const metrics::ResponsePoint& point : points) {
      const bool known = point.interval.has_value() && point.interval->gain_low > 0.0;
      add(curve, point.frequency_hz, point.gain / first.si_per_unit,
          known ? point.interval->gain_low / first.si_per_unit : std::nan(""),
          known ? point.interval->gain_high / first.si_per_unit : std::nan(""));
    }
  };
  Curve record;
  Curve model;
  for (const ResponseCurves& curves : all) {
    add_points(curves.record, record);
    add_points(curves.model, model);
  }
  draw(plot, std::move(record), std::move(model));
  return plot;
}

Plot phase_plot(const std::string& name, const std::vector<ResponseCurves>& all) {
  Plot plot = empty_plot(name, all.front(), "phase");
  plot.y_label = "phase [°]";
  const std::vector<std::vector<double>> phases = unwrapped(all);
  Curve record;
  Curve model;
  for (std::size_t c = 0; c < all.size(); ++c) {
    if (c > 0) {
      lift(record);
      lift(model);
    }
    for (std::size_t i = 0; i < all[c].record.size(); ++i) {
      const metrics::ResponsePoint& point = all[c].record[i];
      const double phase = phases[c][i];
      const bool known = point.interval.has_value() && point.interval->phase_half_deg < 180.0;
      add(record, point.frequency_hz, phase,
          known ? phase - point.interval->phase_half_deg : std::nan(""),
          known ? phase + point.interval->phase_half_deg : std::nan(""));
      const metrics::ResponsePoint& simulated = all[c].model[i];
      add(model, simulated.frequency_hz, near(simulated.phase_deg, phase), std::nan(""),
          std::nan(""));
    }
  }
  draw(plot, std::move(record), std::move(model));
  return plot;
}

Plot gain_plot(const std::string& condition, const ResponseCurves& curves) {
  return gain_plot(condition, std::vector{curves});
}

Plot phase_plot(const std::string& condition, const ResponseCurves& curves) {
  return phase_plot(condition, std::vector{curves});
}

}  // namespace rigcal::report
