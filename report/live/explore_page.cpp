#include "report/live/explore_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "common/quantity.hpp"
#include "report/document/assets.hpp"
#include "report/figure/decimate.hpp"
#include "report/figure/svg.hpp"
#include "report/live/live_module.hpp"
#include "report/live/live_page.hpp"
#include "report/text/escape.hpp"

namespace rigcal::report {
namespace {

constexpr std::size_t kStillPoints = 1500;

struct StillLine {
  const char* name;
  const char* style;
  model::Output output;
};

void add_line(Plot& plot, const char* name, const char* style, const std::vector<double>& time_s,
              std::vector<double> values, double si) {
  const Buckets thin = buckets(values.size(), kStillPoints);
  Trace trace = empty_trace(Trace::Kind::line, style, name);
  trace.x = thinned_times(time_s, values, thin);
  trace.y = thinned(values, thin);
  for (double& y : trace.y) y /= si;
  plot.traces.push_back(std::move(trace));
}

Plot still_plot(const LiveCase& shown, const model::Simulation& run, const std::string& title,
                const std::string& unit, double si, std::span<const StillLine> lines) {
  Plot plot{fmt::format("{}: {}", title, shown.name), "time [s]",
            fmt::format("{} [{}]", title, unit)};
  for (const StillLine& line : lines) {
    const Eigen::VectorXd column = run.outputs.col(static_cast<Eigen::Index>(line.output));
    add_line(plot, line.name, line.style, shown.task.time_s, {column.begin(), column.end()}, si);
  }
  return plot;
}

std::string still_figure(const LiveCase& shown, const std::string& title, const Plot& plot) {
  return fmt::format(
      "<figure class=\"plot still\"><figcaption>{}: {}</figcaption><div "
      "class=\"static-plot\">{}</div></figure>",
      title, escaped(shown.name), svg(plot));
}

/// Draws pictures for readers without scripts, and for print.
std::string still_pictures(const LiveCase& shown, const model::Simulation& run) {
  constexpr std::array kPosition{StillLine{"position", "model", model::Output::position}};
  constexpr std::array kFlows{StillLine{"servo", "servo", model::Output::servo_flow},
                              StillLine{"work", "model", model::Output::work_flow},
                              StillLine{"leak", "leak", model::Output::leakage_flow}};
  constexpr std::array kAngle{StillLine{"angle", "model", model::Output::angle}};
  const bool turns = shown.task.rig.plant == model::PlantKind::linkage;
  constexpr double kDegree = 0.017453292519943295;
  Plot position = turns ? still_plot(shown, run, "Angle", "deg", kDegree, kAngle)
                        : still_plot(shown, run, "Position", "mm", 1e-3, kPosition);
  if (auto reference = calib::reference_of(shown.task);
      !reference.empty() && model::controls_motion(shown.task.rig.feedback))
    add_line(position, "reference", "reference", shown.task.time_s, std::move(reference),
             turns ? kDegree : 1e-3);
  return still_figure(shown, turns ? "Angle" : "Position", position) +
         still_figure(shown, "Flows",
                      still_plot(shown, run, "Flow", "L/min", kLitrePerMinute, kFlows));
}

}  // namespace

std::string explore_page(const datasets::Campaign& campaign, const std::vector<LiveCase>& cases,
                         const std::string& command, const std::vector<InputFile>& inputs) {
  if (live_module().empty())
    throw UsageError(
        "this rigcal was built without the model for live pages: expected a build with clang, lld, "
        "wasi-libc and libc++ for WebAssembly (scripts/setup)");
  const LiveCase& shown = cases.front();
  const calib::SimulationTask& task = shown.task;
  const model::Simulation run =
      model::simulate(task.rig, task.values, {}, task.inputs, task.time_s, model::kAllOutputs,
                      calib::simulation_options(campaign));
  if (!run.ok())
    throw InputError(shown.condition.where,
                     fmt::format("{}: cannot be simulated: {} at {:.6g} s: {}", shown.name,
                                 to_string(run.status), run.failed_at_s, run.reason));
  std::string inputs_html;
  for (const InputFile& input : inputs)
    inputs_html += fmt::format(" {}: SHA-256 {}.", escaped(input.path), input.sha256);
  const std::string live =
      live_html("Without scripts the page shows a still picture: " + escaped(shown.name) + ".",
                still_pictures(shown, run));
  return filled(
      asset("explore.html"),
      {{"campaign", escaped(campaign.name)},
       {"command", escaped(command)},
       {"version", escaped(version())},
       {"revision", escaped(revision().substr(0, 12))},
       {"inputs", inputs_html},
       {"live", live},
       {"style", fmt::format("{}{}{}", asset("report.css"), asset("uPlot.css"), asset("live.css"))},
       // The licence of the plot library requires its notice in every copy, and each page contains
       // one.
       {"plot_library",
        fmt::format("/*! uPlot\n\n{}*/\n{}", asset("uPlot.LICENSE"), asset("uPlot.js"))},
       {"live_scripts", live_scripts(live_rig(campaign, cases))}});
}

}  // namespace rigcal::report
