#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "tests/model/two_chamber_rig.hpp"
#include "tests/support/sanitized.hpp"

// Compares the model with records from another simulator with known parameters
// (shared/data/sim_hopsan_leaky_servo).

using namespace rigcal::model;
using Row = std::map<std::string, std::string>;

namespace {

const std::string kFolder = std::string(RIGCAL_RECORDINGS_DIR) + "/sim_hopsan_leaky_servo/";

std::vector<Row> read_csv(const std::string& path) {
  std::ifstream file(path);
  const auto cells = [](const std::string& line) {
    std::vector<std::string> result;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, ',');) result.push_back(cell);
    return result;
  };
  std::string line;
  std::getline(file, line);
  const auto names = cells(line);
  std::vector<Row> rows;
  while (std::getline(file, line)) {
    const auto values = cells(line);
    Row row;
    for (std::size_t i = 0; i < values.size(); ++i) row[names[i]] = values[i];
    rows.push_back(std::move(row));
  }
  return rows;
}

/// The rig of a case, with the parameters from the README of the records.
Experiment experiment(const Row& c) {
  const auto number = [&c](const char* key) { return std::stod(c.at(key)); };
  Experiment e;
  e.set("leakage_smoothing", 1.0);
  e.set("total_volume", 2.46888e-4 + 2.0 * number("dead_volume_each_m3"));
  e.set("leakage_coefficient", c.at("leak_law") == "turbulent" ? number("leak_size") : 0.0);
  if (c.at("leak_law") == "laminar") e.set("laminar_leakage", number("leak_size"));
  e.set("valve_frequency", number("valve_omega_rad_s")).set("valve_damping_ratio", 1.0);
  e.set("kp", number("kp_v_per_m"));
  const double amplitude = number("amplitude_m");
  const double frequency_hz = number("frequency_hz");
  e.inputs.drive = c.at("signal") == "sine" ? Signal::sine(amplitude, frequency_hz)
                                            : Signal::square(amplitude, frequency_hz);
  return e;
}

/// Fraction of the variance that is not explained, 1 - rho2.
double unexplained(const Eigen::VectorXd& simulated, const Eigen::VectorXd& measured) {
  const auto variance = [](const Eigen::VectorXd& v) {
    return (v.array() - v.mean()).square().mean();
  };
  return variance(measured - simulated) / variance(measured);
}

/// All rows of cases.csv, or every fourth if all would take too long.
std::vector<Row> cases_to_run() {
  const auto all = read_csv(kFolder + "cases.csv");
  CHECK(all.size() == 29);
  std::vector<Row> result;
  for (std::size_t i = 0; i < all.size(); i += rigcal::test::kSanitized ? 4 : 1)
    result.push_back(all[i]);
  return result;
}

struct Unexplained {
  double position, load_pressure;
};

/// Runs the experiment at the times of a record, and returns the fractions of the record's variance
/// that it does not explain.
Unexplained unexplained(Experiment& e, const std::string& file) {
  e.times_s.clear();
  const auto rows = read_csv(file);
  Eigen::VectorXd x(static_cast<Eigen::Index>(rows.size()));
  Eigen::VectorXd P_L(x.size());
  for (const Row& row : rows) {
    const auto i = static_cast<Eigen::Index>(e.times_s.size());
    e.times_s.push_back(std::stod(row.at("t_s")));
    x(i) = std::stod(row.at("x_m"));
    P_L(i) = std::stod(row.at("p1_pa")) - std::stod(row.at("p2_pa"));
  }
  const Simulation run = e();
  REQUIRE(run.ok());
  return {unexplained(run.outputs.col(0), x), unexplained(run.outputs.col(1), P_L)};
}

}  // namespace

TEST_CASE("hopsan: the position of every case follows with the true parameters", "[model]") {
  if (!std::filesystem::exists(kFolder + "cases.csv")) {
    WARN("skipped: no records in " + kFolder);
    return;
  }
  for (const Row& c : cases_to_run()) {
    CAPTURE(c.at("case"));
    Experiment e = experiment(c);
    const auto [position, pressure] = unexplained(e, kFolder + c.at("file"));
    CHECK(position < 1e-6);
    // e5 is the error of an independent integration of the same equations. If it is tiny, the
    // default tolerance of this run dominates: (3e-6)^2 for x, (2e-4)^2 for a ringing P_L.
    CHECK(position < 2.0 * std::stod(c.at("e5_x")) + 1e-11);
    CHECK(pressure < 2.0 * std::stod(c.at("e5_pl")) + 5e-8);
  }
}

TEST_CASE("hopsan: both chambers of every case follow with the true parameters", "[model]") {
  if (!std::filesystem::exists(kFolder + "cases.csv")) {
    WARN("skipped: no records in " + kFolder);
    return;
  }
  for (const Row& c : cases_to_run()) {
    CAPTURE(c.at("case"));
    Experiment e = two_chamber_rig();
    const Experiment one = experiment(c);
    e.inputs = one.inputs;
    for (const char* key : {"leakage_smoothing", "leakage_coefficient", "laminar_leakage",
                            "valve_frequency", "valve_damping_ratio", "kp"}) {
      if (one.values.is_given(key)) e.set(key, one.values[key]);
    }
    const double dead_m3 = std::stod(c.at("dead_volume_each_m3"));
    e.set("dead_volume_a", dead_m3).set("dead_volume_b", dead_m3);
    e.options.tolerance = 1e-7;
    const auto [position, pressure] = unexplained(e, kFolder + c.at("file"));
    CHECK(position < 1e-6);
    CHECK(pressure < 1e-5);
    // e6 is the error of an independent integration of the same equations. The tolerance of this
    // run adds (3e-6)^2 for x and (4e-4)^2 for P_L.
    CHECK(position < 2.0 * std::stod(c.at("e6_x")) + 1e-11);
    CHECK(pressure < 2.0 * std::stod(c.at("e6_pl")) + 2e-7);
  }
}
