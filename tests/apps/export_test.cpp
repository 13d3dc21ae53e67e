#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <numbers>
#include <set>
#include <sstream>

#include "tests/apps/cli_fixture.hpp"
#include "tests/apps/two_chamber_fixture.hpp"
#include "tests/support/fmu.hpp"

namespace rigcal::test {
namespace {

using Catch::Contains;
using Columns = std::map<std::string, std::vector<double>>;
using Drive = std::function<double(double)>;

/// Both simulations are this exact at each step; what is compared is a hundred times coarser.
constexpr double kTolerance = 1e-9;

const Edits kNoRecords{
    {"repeats = [\"records/sine_*.csv\"]", "duration = \"0.6 s\"\nsample_rate = \"200 Hz\""},
    {"repeats = [\"records/square_*.csv\"]", "duration = \"0.6 s\"\nsample_rate = \"200 Hz\""},
    {"[acceptance]", "[simulation]\ntolerance = 1e-9\n[acceptance]"}};

const Edits kTwoChamberRuns{
    {"repeats = [\"records/square_*.csv\"]",
     "duration = \"0.6 s\"\nsample_rate = \"200 Hz\"\n[[condition]]\nid = \"sine\"\nwaveform = "
     "\"sine\"\nfrequency = \"2 Hz\"\namplitude = \"1 V\"\nuse = \"fit\"\nduration = \"0.6 "
     "s\"\nsample_rate = \"200 Hz\""},
    {"[recording.channels]", "[simulation]\ntolerance = 1e-9\n[recording.channels]"}};

/// The condition "square" of either campaign: 1 Hz, so that its edges are at half seconds.
Drive square(double amplitude) {
  return [amplitude](double t) { return std::fmod(t + 1e-9, 1.0) < 0.5 ? amplitude : -amplitude; };
}
Drive sine(double amplitude) {
  return [amplitude](double t) { return amplitude * std::sin(4.0 * std::numbers::pi * t); };
}

Columns simulated(const CommandFolder& folder, const std::string& condition) {
  const Outcome outcome =
      folder.run({"simulate", "campaign.toml", "--condition", condition, "--out", "simulated"});
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  Columns columns;
  std::istringstream csv(folder.read("simulated/" + condition + ".csv"));
  std::string line;
  std::getline(csv, line);
  std::vector<std::string> names;
  std::istringstream head(line);
  for (std::string name; std::getline(head, name, ',');) names.push_back(name);
  while (std::getline(csv, line)) {
    std::istringstream cells(line);
    std::string cell;
    for (const std::string& name : names) {
      std::getline(cells, cell, ',');
      columns[name].push_back(std::strtod(cell.c_str(), nullptr));
    }
  }
  return columns;
}

/// Exports the campaign of a folder and unpacks it.
Fmu exported(const CommandFolder& folder, CommandFolder::Arguments more = {}) {
  CommandFolder::Arguments arguments{"export", "fmu", "campaign.toml", "--out", "fmu"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Outcome outcome = folder.run(arguments);
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  for (const auto& entry : std::filesystem::directory_iterator(folder.work() / "fmu")) {
    const auto to = folder.work() / "unpacked" / entry.path().stem();
    unzip(entry.path(), to);
    return Fmu(to);
  }
  throw std::runtime_error("nothing was exported");
}

/// Names of the outputs by those of the columns that `simulate` writes.
std::map<std::string, std::string> outputs_of(const Fmu& fmu, const Columns& columns) {
  std::map<std::string, std::string> outputs;
  for (const auto& [name, variable] : fmu.variables) {
    if (variable.causality != "output") continue;
    for (const auto& [column, values] : columns) {
      if (column.rfind(name + "_", 0) == 0 && column.size() - name.size() < 12)
        outputs[name] = column;
    }
  }
  return outputs;
}

double peak_of(const std::vector<double>& values) {
  double peak = 0.0;
  for (const double value : values) peak = std::max(peak, std::abs(value));
  return peak;
}

/// Every output at every sample, over the peak of its column.
void require_same(FmuRun& run, const std::map<std::string, std::string>& outputs,
                  const Columns& columns, std::size_t sample, double tolerance) {
  for (const auto& [name, column] : outputs) {
    const std::vector<double>& values = columns.at(column);
    INFO(name << " at sample " << sample);
    REQUIRE(run.get(name) == Approx(values[sample]).margin(tolerance * peak_of(values)).epsilon(0));
  }
}

/// Co-simulation with inputs that go straight from one communication point to the next: many enough
/// that a sine of 2 Hz is off by (2 pi f h)^2 / 8 = 2e-7 of its amplitude.
void require_co_simulation(const Fmu& fmu, const FmuLibrary& library, const std::string& input,
                           const Drive& drive, bool jumps, const Columns& columns) {
  FmuRun run(fmu, library, fmi2CoSimulation);
  REQUIRE(run.component != nullptr);
  run.initialize(0.0, kTolerance, {{input, drive(0.0)}});
  const auto outputs = outputs_of(fmu, columns);
  REQUIRE(outputs.size() >= 10);
  const auto& times = columns.at("time_s");
  REQUIRE(times.size() == 121);
  for (std::size_t i = 0; i < times.size(); ++i) {
    run.require(run.set(input, drive(times[i])));
    require_same(run, outputs, columns, i, 1e-6);
    if (i + 1 == times.size()) break;
    const int parts = jumps ? 1 : 50;
    const double h = (times[i + 1] - times[i]) / parts;
    for (int k = 0; k < parts; ++k) {
      const double t = times[i] + k * h;
      run.require(run.set(input, drive(t)));
      if (!jumps) run.require(run.set_slope(input, (drive(t + h) - drive(t)) / h));
      run.require(run.step(t, h));
    }
  }
  CHECK(run.messages().empty());
}

void require_model_exchange(const Fmu& fmu, const FmuLibrary& library, const std::string& input,
                            const Drive& drive, bool jumps, const Columns& columns) {
  FmuRun run(fmu, library, fmi2ModelExchange);
  REQUIRE(run.component != nullptr);
  run.initialize(0.0, kTolerance, {{input, drive(0.0)}});
  ExchangeRun exchange(run);
  const auto outputs = outputs_of(fmu, columns);
  const auto& times = columns.at("time_s");
  for (std::size_t i = 0; i < times.size(); ++i) {
    run.require(run.set(input, drive(times[i])));
    require_same(run, outputs, columns, i, 1e-6);
    if (i + 1 == times.size()) break;
    const double held = drive(times[i]);
    exchange.advance(times[i], times[i + 1], 400,
                     [&](double t) { run.require(run.set(input, jumps ? held : drive(t))); });
  }
  std::vector<double> indicators(fmu.indicators());
  run.require(RIGCAL_FMI2(library, fmi2GetEventIndicators)(run.component, indicators.data(),
                                                           indicators.size()));
  CHECK(run.messages().empty());
}

}  // namespace

TEST_CASE("export: a closed loop with a leak runs as simulate has it", "[apps]") {
  const CommandFolder folder;
  folder.write("campaign.toml", edited(kCampaign, kNoRecords));
  const Fmu fmu = exported(folder);
  const FmuLibrary library(fmu.library());
  for (const auto& [condition, drive] :
       std::map<std::string, Drive>{{"sine", sine(0.005)}, {"square", square(0.004)}}) {
    CAPTURE(condition);
    const Columns columns = simulated(folder, condition);
    const bool jumps = condition == "square";
    require_co_simulation(fmu, library, "reference", drive, jumps, columns);
    require_model_exchange(fmu, library, "reference", drive, jumps, columns);
  }
}

TEST_CASE("export: two chambers in open loop run as simulate has them", "[apps]") {
  const CommandFolder folder;
  folder.write("campaign.toml", edited(kTwoChamber, kTwoChamberRuns));
  const Fmu fmu = exported(folder);
  const FmuLibrary library(fmu.library());
  for (const auto& [condition, drive] :
       std::map<std::string, Drive>{{"sine", sine(1.0)}, {"square", square(1.0)}}) {
    CAPTURE(condition);
    const Columns columns = simulated(folder, condition);
    const bool jumps = condition == "square";
    require_co_simulation(fmu, library, "command", drive, jumps, columns);
    require_model_exchange(fmu, library, "command", drive, jumps, columns);
  }
}

}  // namespace rigcal::test
